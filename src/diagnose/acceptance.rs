//! Decides whether a candidate, and the model with it, is accepted.

use super::base::lift_load;
use super::fit::{Fitted, Newton, fit};
use super::gates::NAME_Z;
use super::grid_refinement::refined;
use super::latency::with_latency;
use super::latency_parts::is_delay;
use super::locate::{mass_step_beside, mass_step_std_kg};
use super::signature::EffectTerm;
use super::tested::Tested;
use super::trace::Trace;
use crate::physics::PhysicsError;
use crate::vehicle::VehicleSize;
use std::ops::Range;

/// A candidate with its sharpest values and the model with it; `None` where it is refused.
pub(super) fn accepted(
    flights: &[Trace],
    after: &Fitted,
    best: Tested,
) -> Result<Option<(Tested, Fitted)>, PhysicsError> {
    let mut taken = refined(flights, after, best.clone());
    let mut fitted = with_taken(flights, after, &taken)?;
    if at_bound(&fitted, &taken) {
        // what is sharpest by its slope can lie too far off for the effect itself
        taken = best;
        // three of a long flight at a time take much memory
        drop(fitted);
        fitted = with_taken(flights, after, &taken)?;
    }
    let is_refused = wanders(flights, &fitted, &taken) || at_bound(&fitted, &taken);
    Ok((!is_refused).then_some((taken, fitted)))
}

/// Fits again with the accepted candidate.
fn with_taken(flights: &[Trace], after: &Fitted, taken: &Tested) -> Result<Fitted, PhysicsError> {
    let mut base = after.base.clone();
    base.effects.extend(started(taken, &base.size).into_iter().map(released));
    if let Some(load) = base.effects.last_mut().filter(|term| term.signature.role.hangs_below) {
        base.vehicle.body.mass_kg = lift_load(load, base.vehicle.body.mass_kg);
    }
    // a latency that the rotors' inertia had shortened is found again beside it
    let shortened = taken.candidate.signature().is_some_and(|signature| signature.role.spin_up.is_some());
    let newton = match shortened {
        true if is_delay(base.latency, &base.vehicle) => Newton::Delay,
        true => Newton::Free,
        false => Newton::Held,
    };
    match newton {
        Newton::Held => fit(flights, base, newton),
        free => Ok(with_latency(flights, base, free)?.0),
    }
}

/// The candidate's effects with the estimates of the evidence as start values.
pub(super) fn started(tested: &Tested, size: &VehicleSize) -> Vec<EffectTerm> {
    let mut theta = tested.evidence.theta.iter();
    let mut parts = tested.candidate.parts.clone();
    for part in &mut parts {
        for &free in &part.free {
            if let Some(by) = theta.next() {
                part.values[free] = part.possible(free, part.moved_to(free, *by), size);
            }
        }
    }
    if let [drag, wind] = parts.as_mut_slice()
        && tested.candidate.through.is_some()
    {
        // the columns were those of one unit of drag
        let strength = 0.5 * (drag.values[0] + drag.values[1]).max(1e-3);
        for &free in &wind.free {
            wind.values[free] = wind.possible(free, wind.values[free] / strength, size);
        }
    }
    parts
}

/// Whether the fit moves a parameter of the candidate to its bound: the cause is then another one.
fn at_bound(fitted: &Fitted, taken: &Tested) -> bool {
    let just_taken = &fitted.base.effects[fitted.base.effects.len() - taken.candidate.parts.len()..];
    just_taken.iter().any(|present| {
        let mut common = 0..present.effect().parameters().len();
        common.any(|slot| present.free.contains(&slot) && present.ends_at_bound(slot, &fitted.base.size))
    })
}

/// Share of a mass change that the seconds before and after it may show: a slow drift shows little of itself there, and what comes and
/// goes shows more. Set by judgement; measured only together with all conditions of a name (see `Gates`).
const SHOWN_BESIDE: Range<f64> = 0.4..2.0;

/// Whether a step of the mass could be a force that drifts by itself: its own seconds hardly show it, or other seconds show as much.
fn wanders(flights: &[Trace], fitted: &Fitted, taken: &Tested) -> bool {
    let just_taken = &fitted.base.effects[fitted.base.effects.len() - taken.candidate.parts.len()..];
    let steps = just_taken.iter().filter_map(|part| {
        let slot = part.free.iter().find(|slot| part.is_amount(**slot))?;
        Some((part.values[part.signature.role.moment?], part.values[*slot]))
    });
    steps.into_iter().any(|(moment_s, delta_kg)| {
        let beside = mass_step_beside(flights, fitted, (moment_s, delta_kg));
        tracing::debug!(moment_s, delta_kg, ?beside, "a change of mass is judged");
        let stands_out = beside.is_some_and(|beside| {
            let share = beside.delta_kg / delta_kg;
            SHOWN_BESIDE.contains(&share) && beside.delta_kg.abs() > NAME_Z * beside.elsewhere_kg
        });
        !stands_out || delta_kg.abs() < NAME_Z * mass_step_std_kg(flights, fitted, moment_s)
    })
}

/// The effect with those parameters freed that can be estimated only after it was accepted.
fn released(mut term: EffectTerm) -> EffectTerm {
    let freed = (term.signature.refinement.freed)(&term);
    term.free.extend(freed);
    term
}
