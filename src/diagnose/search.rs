//! The forward search: fit, test every candidate, take the one that explains most, fit again.

use super::base::{Base, Present, lift_load, moved_to};
use super::candidates::{Candidate, candidates};
use super::evidence::{Evidence, Weighted};
use super::forms::other_form;
use super::gates::{Gates, passes};
use super::hubs::one_place;
use super::latency::{LatencyFinding, finding_of, fit_latency, is_delay};
use super::locate::mass_step_std_kg;
use super::mounting::{Turn, mountings};
use super::rows::{AXES, CHANNELS, Nuisance, NuisanceColumn, Rows};
use super::settle::{SETTLED_S, settle};
use super::sharpen::{between_grid, sharpened};
use super::trace::Trace;
use super::trial::test_all;
use crate::physics::effects::RotorInertia;
use crate::physics::{Effect, PhysicsError};
use crate::vehicle::Vehicle;
use nalgebra::{DMatrix, DVector};

/// A base fitted to the flights.
#[derive(Debug, Clone)]
pub struct Fitted {
    /// the model
    pub base: Base,
    /// linearised about it
    pub rows: Rows,
    /// weighted, partialled
    pub weighted: Weighted,
    /// coefficients left over (about zero after convergence), nuisances first
    pub coefficients: DVector<f64>,
    /// their covariance
    pub covariance: DMatrix<f64>,
}

impl Fitted {
    /// Sum over the rows of the logarithm of each channel's standard deviation, forces as the accelerations that
    /// were measured: minus the logarithm of the likelihood, up to a constant.
    #[must_use]
    pub fn misfit(&self) -> f64 {
        let rows = self.rows.len() as f64;
        let mass_kg = self.base.vehicle.body.mass_kg;
        let measured = |channel: usize| {
            let of_torque = (3..AXES).contains(&channel);
            self.weighted.sigma[channel] / if of_torque { 1.0 } else { mass_kg }
        };
        let used: Vec<f64> = (0..CHANNELS).map(measured).filter(|sigma| *sigma != 0.0).collect();
        // a form that cannot be carried along the flight is no candidate
        if used.iter().all(|sigma| *sigma > 0.0) {
            used.iter().map(|sigma| rows * sigma.ln()).sum()
        } else {
            f64::INFINITY
        }
    }

    /// Minus the logarithm of how likely the nuisances' coefficients are by what is known of them beforehand, up to a
    /// constant.
    #[must_use]
    pub fn against_priors(&self) -> f64 {
        let of = |(column, value): (&NuisanceColumn, &f64)| {
            column.prior_std.map_or(0.0, |std| 0.5 * (value / std).powi(2))
        };
        self.rows.nuisances.iter().zip(self.coefficients.iter()).map(of).sum()
    }
}

/// Most Gauss-Newton passes.
const PASSES: usize = 8;
/// A coefficient that moves by less than this many standard errors has converged.
const CONVERGED: f64 = 0.05;

/// Whether the latency is estimated, or stays as it is and only its column is in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Newton {
    /// estimated
    Free,
    /// its delay is estimated, whatever its lag
    Delay,
    /// as given
    Held,
}

/// Fits rigid body, latency and the base's effects.
///
/// # Errors
/// [`PhysicsError`] where the estimate leaves what is physical.
pub fn fit(flights: &[Trace], mut base: Base, newton: Newton) -> Result<Fitted, PhysicsError> {
    let mut fitted = evaluate(flights, base.clone())?;
    for _ in 0..PASSES {
        let moved = step(&mut base, &fitted, newton);
        fitted = evaluate(flights, base.clone())?;
        if moved < CONVERGED {
            break;
        }
    }
    Ok(fitted)
}

/// Rows, weights and coefficients about a base, without a step.
pub(super) fn evaluate(flights: &[Trace], base: Base) -> Result<Fitted, PhysicsError> {
    let rows = Rows::new(flights, &base)?;
    let weighted = Weighted::new(&rows);
    let (coefficients, covariance) = weighted.coefficients(&rows);
    Ok(Fitted { base, rows, weighted, coefficients, covariance })
}

/// Moves the base by the coefficients; returns the largest move in standard errors.
fn step(base: &mut Base, fitted: &Fitted, newton: Newton) -> f64 {
    let mut most = 0.0_f64;
    let body = &mut base.vehicle.body;
    for (index, column) in fitted.rows.nuisances.iter().enumerate() {
        let by = fitted.coefficients[index];
        let std = fitted.covariance[(index, index)].max(0.0).sqrt();
        match column.nuisance {
            Nuisance::Mass => {
                body.mass_kg = (body.mass_kg + by).clamp(0.3 * body.mass_kg, 3.0 * body.mass_kg)
            }
            Nuisance::Inertia(entry) => {
                const PLACES: [(usize, usize); 6] = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)];
                let (row, column) = PLACES[entry];
                let scale = (body.inertia_kg_m2[(row, row)] * body.inertia_kg_m2[(column, column)]).sqrt();
                // a diagonal entry neither vanishes nor triples in one pass
                let by = if row == column {
                    by.clamp(-0.7 * scale, 2.0 * scale)
                } else {
                    by.clamp(-0.5 * scale, 0.5 * scale)
                };
                body.inertia_kg_m2[(row, column)] += by;
                if row != column {
                    body.inertia_kg_m2[(column, row)] += by;
                }
            }
            Nuisance::Latency if newton != Newton::Held => {
                let by = by.clamp(-0.05, 0.05);
                if base.latency.lag_s > 0.0 && newton == Newton::Free {
                    base.latency.lag_s = (base.latency.lag_s + by).max(1e-4);
                } else {
                    base.latency.delay_s = (base.latency.delay_s + by).clamp(-0.03, 0.3);
                }
            }
            _ => continue,
        }
        most = most.max(by.abs() / std.max(f64::MIN_POSITIVE));
    }
    let mut index = fitted.rows.nuisances.len();
    for present in &mut base.present {
        for &free in &present.free {
            let by = fitted.coefficients[index];
            let std = fitted.covariance[(index, index)].max(0.0).sqrt();
            let before = present.values[free];
            present.values[free] = present.possible(free, before + by);
            most = most.max((present.values[free] - before).abs() / std.max(f64::MIN_POSITIVE));
            index += 1;
        }
    }
    most
}

/// A candidate with its evidence.
#[derive(Debug, Clone)]
pub struct Tested {
    /// which
    pub candidate: Candidate,
    /// its coefficients in order of the parts' free parameters
    pub evidence: Evidence,
}

/// One accepted step.
#[derive(Debug, Clone)]
pub struct Step {
    /// what was taken
    pub taken: Tested,
    /// others that would have passed, with their evidence
    pub rivals: Vec<Tested>,
}

/// Where the search ended.
#[derive(Debug, Clone)]
pub struct Search {
    /// rigid body alone, with its latency
    pub before: Fitted,
    /// with all that was accepted
    pub after: Fitted,
    /// between command and rotor
    pub latency: LatencyFinding,
    /// in the order in which they were taken
    pub steps: Vec<Step>,
    /// every candidate about the final base
    pub last: Vec<Tested>,
}

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
