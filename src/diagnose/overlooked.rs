//! An effect that makes the channels which show it look noisy, so that no test shows it any more.
//!
//! A test weighs each channel by the residual that the model leaves there. A centre of mass that is off turns the vehicle by far more than
//! all else does, and leaves it in the torques. Once a drag has taken its force out, the forces weigh a hundred times as much as these
//! torques, and what is left of the forces decides on the centre of mass.

use super::acceptance::accepted;
use super::base::Base;
use super::channels::{CHANNELS, Channels};
use super::fit::Fitted;
use super::gates::{Gates, NAME_Z};
use super::price::Price;
use super::refinement::fitted_strength;
use super::score::{columns_of, is_present};
use super::signatures::signature_of;
use super::tested::{Step, Tested};
use super::trace::Trace;
use crate::physics::PhysicsError;
use nalgebra::{DMatrix, DVector};

/// Share of a channel's residual that an effect leaves at most where the channel looks noisy by it. Set by judgement: with half of the residual
/// the channel weighs four times as much.
const LEFT: f64 = 0.5;

/// Takes the effect into the model that would have passed where another one was taken, and that leaves at most half of some channel's residual,
/// where the model then costs less. Returns the step.
///
/// # Errors
/// [`PhysicsError`] where the estimate leaves what is physical.
pub(super) fn overlooked(
    flights: &[Trace],
    after: &mut Fitted,
    (steps, price): (&[Step], Price),
    (gates, refused): (&Gates, &[&'static str]),
) -> Result<Option<Step>, PhysicsError> {
    if after.base.effects.len() >= gates.steps {
        return Ok(None);
    }
    let mut best: Option<(Tested, Fitted)> = None;
    for rival in rivals(steps, &after.base, refused) {
        let Some(columns) = columns_of(flights, after, &rival.candidate) else { continue };
        if least_left(after, &columns) > LEFT {
            continue;
        }
        let Some((taken, with)) = accepted(flights, after, rival.clone())? else { continue };
        let id = taken.candidate.id;
        let is_certain = with
            .with_first_columns()
            .filter(|(term, _)| term.id() == id)
            .all(|(term, first)| fitted_strength(&with, term, first).z > NAME_Z);
        let least = best.as_ref().map_or_else(|| price.cost(after), |(_, best)| price.cost(best));
        if is_certain && price.cost(&with) < least {
            best = Some((taken, with));
        }
    }
    Ok(best.map(|(taken, with)| {
        *after = with;
        Step { taken, rivals: Vec::new() }
    }))
}

/// What would have passed where something else was taken, and is not in the model: of each effect the one that was worth most there. A latency
/// is estimated with everything else.
fn rivals<'a>(steps: &'a [Step], base: &Base, refused: &[&'static str]) -> Vec<&'a Tested> {
    let mut rivals: Vec<&Tested> = Vec::new();
    for rival in steps.iter().flat_map(|step| &step.rivals) {
        let candidate = &rival.candidate;
        let is_open = candidate.parts.iter().all(|part| {
            let is_latency = signature_of(part.id()).is_none_or(|of| of.role.latency.is_some());
            !is_latency && !refused.contains(&part.id())
        });
        if is_open
            && !is_present(base, candidate)
            && !rivals.iter().any(|known| known.candidate.id == candidate.id)
        {
            rivals.push(rival);
        }
    }
    rivals
}

/// The least share of a channel's residual that columns leave which are fitted to this channel alone.
fn least_left(fitted: &Fitted, columns: &[Channels]) -> f64 {
    let left = |channel: usize| {
        let residual = DVector::from_column_slice(&fitted.rows.residual[channel]);
        let own =
            DMatrix::from_fn(residual.len(), columns.len(), |row, column| columns[column][channel][row]);
        let normal = own.tr_mul(&own);
        let scale = normal.trace();
        if fitted.weighted.sigma[channel] <= 0.0 || scale <= 0.0 {
            return 1.0;
        }
        // what acts about another axis has no column here
        let least = f64::EPSILON * scale;
        let Some(inverse) = (normal + DMatrix::identity(columns.len(), columns.len()) * least).cholesky()
        else {
            return 1.0;
        };
        let theta = inverse.solve(&own.tr_mul(&residual));
        (&residual - own * theta).norm() / residual.norm()
    };
    (0..CHANNELS).map(left).filter(|left| left.is_finite()).fold(1.0, f64::min)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test ends where it fails")]
    use super::*;
    use crate::diagnose::ExplainSettings;
    use crate::diagnose::candidates::candidates;
    use crate::diagnose::latency::fit_latency;
    use crate::diagnose::made_flights::{conceal, flown};
    use crate::diagnose::score::test_all;
    use crate::simulate::RandomTrajectory;

    #[test]
    fn a_centre_of_mass_that_makes_the_torques_look_noisy_is_taken_beside_a_drag() {
        for (com_m, found) in [(0.02, true), (0.0, false)] {
            let (signals, vehicle) = flown(41, &RandomTrajectory::default(), |truth, weight_n| {
                let drag = 0.04 * weight_n;
                conceal(truth, [("linear_drag", &[drag, drag] as &[f64]), ("com_offset", &[com_m])]);
            });
            let flights = [Trace::new(&signals, &vehicle, ExplainSettings::default().half_width_s).unwrap()];
            let (before, _) = fit_latency(&flights, Base::anchored(&vehicle)).unwrap();
            let signatures = ["linear_drag", "com_offset"].map(|id| signature_of(id).unwrap());
            let tested =
                test_all(&flights, &before, &candidates(&vehicle, &flights, &signatures), &signatures);
            let most = |id: &str| {
                let of = tested.iter().filter(|of| of.candidate.id == id);
                of.max_by(|a, b| a.evidence.energy.total_cmp(&b.evidence.energy)).unwrap().clone()
            };
            let (taken, mut after) = accepted(&flights, &before, most("linear_drag")).unwrap().unwrap();
            let price = Price::of(&after);
            let cost = price.cost(&after);
            let steps = [Step { taken, rivals: vec![most("com_offset")] }];
            assert!(
                overlooked(&flights, &mut after, (&steps, price), (&Gates::default(), &["com_offset"]))
                    .unwrap()
                    .is_none()
            );
            let step = overlooked(&flights, &mut after, (&steps, price), (&Gates::default(), &[])).unwrap();
            assert_eq!(step.map(|of| of.taken.candidate.id), found.then_some("com_offset"));
            let place = after.base.effects.iter().find(|term| term.id() == "com_offset");
            assert!(place.is_none_or(|term| (term.values[0] - com_m).abs() < 0.001), "{place:?}");
            assert_eq!(price.cost(&after) < cost, found);
        }
    }
}
