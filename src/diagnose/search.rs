//! The forward search: fit, test every candidate, take the one that explains most, fit again.

use super::base::{Base, Present, lift_load, moved_to};
use super::candidates::candidates;
use super::fit::{Fitted, Newton, fit};
use super::forms::other_form;
use super::gates::{Gates, passes};
use super::hubs::one_place;
use super::latency::{LatencyFinding, finding_of, fit_latency, is_delay};
use super::locate::mass_step_std_kg;
use super::mounting::{Turn, mountings};
use super::settle::{SETTLED_S, settle};
use super::sharpen::{between_grid, sharpened};
use super::tested::{Search, Step, Tested};
use super::trace::Trace;
use super::trial::test_all;
use crate::physics::effects::RotorInertia;
use crate::physics::{Effect, PhysicsError};
use crate::vehicle::Vehicle;

/// Searches.
///
/// # Errors
/// [`PhysicsError`] where the vehicle is not physical.
pub fn search(flights: &[Trace], vehicle: &Vehicle, gates: &Gates) -> Result<Search, PhysicsError> {
    let (before, latency) = fit_latency(flights, Base::rigid(vehicle))?;
    let mut after = before.clone();
    let mut steps: Vec<Step> = Vec::new();
    let mut last;
    let mut settled = 0;
    let mut refused: Vec<&'static str> = Vec::new();
    loop {
        let candidates = candidates(&after.base.vehicle, flights);
        last = test_all(flights, &after, &candidates);
        last.extend(between_grid(flights, &after, &last));
        last.extend(mountings(flights, &after, Turn::First));
        let count = last.len() as f64;
        let price = COLUMN_PRICE * after.weighted.long_run_deviation().powi(2);
        let ranked = |tested: &[Tested]| {
            let open = tested.iter().filter(|tested| !refused.contains(&tested.candidate.id));
            let passed = open.filter(|tested| passes(tested, &after, gates, count));
            by_worth(passed.cloned().collect(), price)
        };
        let mut passed = ranked(&last);
        if passed.is_empty() {
            let mounted = mountings(flights, &after, Turn::Last);
            passed = ranked(&mounted);
            last.extend(mounted);
        }
        match passed.first().cloned() {
            Some(taken) if steps.len() < gates.steps => {
                let sharper = sharpened(flights, &after, taken.clone());
                let mut fitted = with_taken(flights, &after, &sharper)?;
                let mut taken = sharper;
                if at_bound(&fitted, &taken) {
                    // what is sharpest by its slope can lie too far off for the effect itself
                    taken = passed[0].clone();
                    fitted = with_taken(flights, &after, &taken)?;
                }
                if wanders(flights, &fitted, &taken) || at_bound(&fitted, &taken) {
                    refused.push(taken.candidate.id);
                    continue;
                }
                after = fitted;
                steps.push(Step { taken, rivals: passed.split_off(1) });
            }
            _ if settled == SETTLINGS || steps.is_empty() => break,
            _ => {
                settled += 1;
                let before = after.base.present.clone();
                let (dropped, moved) = settle(flights, &mut after)?;
                let placed = one_place(flights, &mut after, price)? | other_form(flights, &mut after, price)?;
                let gone = before.iter().map(|present| present.effect.id());
                let kept = |id: &&'static str| after.base.present.iter().any(|p| p.effect.id() == *id);
                refused.extend(gone.filter(|id| !kept(id)));
                if !dropped && !placed && moved < SETTLED_S {
                    break;
                }
            }
        }
    }
    let after = with_heights(flights, after)?;
    let found = finding_of(&after);
    let latency = LatencyFinding {
        against_lag: latency.against_lag,
        against_delay: latency.against_delay,
        uneven_std: latency.uneven_std,
        // what could be taken for a latency makes it uncertain, whether it is in the model or not
        std_s: found.std_s.max(latency.std_s),
        ..found
    };
    Ok(Search { before, after, latency, steps, last })
}

/// What explains most for its columns first, each at `price`, sigma squared.
fn by_worth(mut tested: Vec<Tested>, price: f64) -> Vec<Tested> {
    let worth = |tested: &Tested| tested.evidence.energy - price * tested.evidence.theta.len() as f64;
    tested.sort_by(|a, b| worth(b).total_cmp(&worth(a)));
    tested
}

/// Fitted again with what was taken.
fn with_taken(flights: &[Trace], after: &Fitted, taken: &Tested) -> Result<Fitted, PhysicsError> {
    let mut base = after.base.clone();
    base.present.extend(started(taken).into_iter().map(released));
    if let Some(load) = base.present.last_mut().filter(|present| present.effect.id() == "slung_load") {
        base.vehicle.body.mass_kg = lift_load(load, base.vehicle.body.mass_kg);
    }
    // a latency that the rotors' inertia had shortened is found again beside it
    let newton = match taken.candidate.id == RotorInertia.id() {
        true if is_delay(base.latency, &base.vehicle) => Newton::Delay,
        true => Newton::Free,
        false => Newton::Held,
    };
    fit(flights, base, newton)
}

/// The ceilings of a fit with their height estimated, too: from one between those that were tried on, unless it runs away.
/// While effects are weighed against each other it stays where it was tried, or the height would take the others' part.
fn with_heights(flights: &[Trace], fitted: Fitted) -> Result<Fitted, PhysicsError> {
    let is_ceiling = |present: &Present| present.effect.id() == "ceiling_effect";
    if !fitted.base.present.iter().any(is_ceiling) {
        return Ok(fitted);
    }
    let mut base = fitted.base.clone();
    base.present.iter_mut().filter(|of| is_ceiling(of)).for_each(|of| of.free = vec![0, 2]);
    let placed = fit(flights, base, Newton::Held)?;
    let bounded = placed.base.present.iter().filter(|of| is_ceiling(of)).any(|of| {
        of.free.iter().any(|&slot| {
            of.parameter(slot).is_some_and(|p| of.values[slot] <= p.min || of.values[slot] >= p.max)
        })
    });
    Ok(if placed.misfit() < fitted.misfit() && !bounded { placed } else { fitted })
}

/// How often the search may go on after that.
const SETTLINGS: usize = 2;
/// What a column must explain to be worth having, in independent squared sigmas.
const COLUMN_PRICE: f64 = 12.0;
/// The candidate's effects at the values that the evidence has.
fn started(tested: &Tested) -> Vec<Present> {
    let mut theta = tested.evidence.theta.iter();
    let mut parts = tested.candidate.parts.clone();
    for part in &mut parts {
        for &free in &part.free {
            if let Some(by) = theta.next() {
                part.values[free] = part.possible(free, moved_to(part, free, *by));
            }
        }
    }
    if let [drag, wind] = parts.as_mut_slice()
        && tested.candidate.through.is_some()
    {
        // the columns were those of one unit of drag
        let strength = 0.5 * (drag.values[0] + drag.values[1]).max(1e-3);
        for &free in &wind.free {
            wind.values[free] = wind.possible(free, wind.values[free] / strength);
        }
    }
    parts
}

/// The fit takes a parameter of it as far as physics allows: whatever it is, it is not that.
fn at_bound(fitted: &Fitted, taken: &Tested) -> bool {
    let just_taken = &fitted.base.present[fitted.base.present.len() - taken.candidate.parts.len()..];
    just_taken.iter().any(|present| {
        let common = present.effect.parameters().iter().enumerate();
        let mut free = common.filter(|(slot, _)| present.free.contains(slot));
        free.any(|(slot, parameter)| {
            let value = present.values[slot];
            let bound = value <= parameter.min || value >= parameter.max;
            bound && value != present.nothing_at(slot)
        })
    })
}

/// A step of the mass that a wandering force could be.
fn wanders(flights: &[Trace], fitted: &Fitted, taken: &Tested) -> bool {
    let changes = taken.candidate.parts.iter().filter(|part| part.effect.id() == "mass_change");
    changes.into_iter().any(|part| {
        let delta_kg = taken.evidence.theta[0].abs();
        delta_kg < WANDERED * mass_step_std_kg(flights, fitted, part.values[0])
    })
}

/// A step counts beyond this many of a wandering force's standard errors.
const WANDERED: f64 = 4.0;

/// Parameters that only show once the effect is there are estimated from then on.
fn released(mut present: Present) -> Present {
    let finer = present.effect.parameters().len();
    if present.effect.id() == "slung_load" {
        present.free.push(1);
    }
    if present.effect.id() == "ground_effect" && present.free == [1] {
        present.free.push(2);
    }
    let shaped = !["motor_lag", "frame_misalignment"].contains(&present.effect.id());
    if present.values.len() > finer && shaped {
        present.free.push(finer);
    }
    present
}
