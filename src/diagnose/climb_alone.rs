//! A thrust that falls in climb alone, held against what is found of descents.
//!
//! ArduCopter's simulator takes `rho A v_z^2 / 2` from the thrust of a rotor that climbs, and nothing from one that descends. Symmetric
//! laws of the air (drag along z, inflow) leave the even part of it, and in descents that looks like a loss of thrust.

use super::channels::{Channels, append, channels, nothing};
use super::evidence::weighted;
use super::fit::Fitted;
use super::signature::EffectTerm;
use super::trace::Trace;
use crate::physics::State;
use nalgebra::Vector3;

/// Share of its size that an effect of descents keeps beside the loss in climb. Set by judgement.
const KEPT: f64 = 0.5;
/// Standard errors from which on it is shown beside the loss in climb. The usual three.
const SHOWN: f64 = 3.0;

/// Whether a loss of thrust in climb alone may be what an effect of descents explains: with both in the model, little of the effect is left.
/// `false` of effects that do not act in descents alone. The effect's first column in the model has the index `first`.
pub(super) fn is_of_climb(traces: &[Trace], fitted: &Fitted, term: &EffectTerm, first: usize) -> bool {
    let amount = term.free.iter().position(|slot| term.is_amount(*slot));
    let Some(place) = amount.filter(|_| term.signature.role.in_descent) else { return false };
    let size = term.from_nothing(term.free[place]);
    let column = lost_in_climb(traces, fitted);
    let Some(evidence) = fitted.weighted.test(std::slice::from_ref(&column)) else { return false };
    let (lost, lost_std) = (evidence.theta[0], evidence.std(0));
    if lost <= 0.0 {
        return false;
    }
    let index = first + place;
    // where the further column is in the fit, the coefficient loses its share in that column
    let stands_for = fitted.weighted.part_in(&weighted(&column, &fitted.weighted.sigma))[index];
    let beside = size - stands_for * lost;
    let std = fitted.covariance[(index, index)].max(0.0).sqrt().hypot(stands_for * lost_std);
    tracing::debug!(effect = term.id(), size, beside, std, lost, lost_std, "held against a loss in climb");
    beside < (KEPT * size).max(SHOWN * std)
}

/// Column of `F_z = -k max(0, v_z)^2` with k of 1 N/(m/s)^2 and the airspeed along body z.
fn lost_in_climb(traces: &[Trace], fitted: &Fitted) -> Channels {
    let wind_m_s = fitted.base.wind_m_s();
    let mut out = Channels::default();
    for trace in traces {
        let lost = |state: &State| {
            let air = state.attitude.inverse_transform_vector(&(state.velocity_m_s - wind_m_s));
            Vector3::new(0.0, 0.0, -air.z.max(0.0).powi(2))
        };
        let series: Vec<Vector3<f64>> = trace.states.iter().map(lost).collect();
        append(&mut out, &channels(trace, trace.weak_vector(0, &series), nothing(trace)));
    }
    out
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test ends where it fails")]
    use crate::diagnose::made_flights::flown;
    use crate::diagnose::{ExplainSettings, explain};
    use crate::physics::effects::by_id;
    use crate::physics::{ActiveEffect, Wrench};
    use crate::simulate::{Disturbance, RandomTrajectory, Truth};
    use nalgebra::Vector3;

    /// Names of a flight that climbs and descends fast.
    fn named(seed: u64, conceal: impl Fn(&mut Truth, f64)) -> Vec<&'static str> {
        let random = RandomTrajectory {
            height_m: (2.0, 24.0),
            harmonics: 3,
            speed_max_m_s: 7.0,
            acceleration_max_m_s2: 5.0,
            ..RandomTrajectory::default()
        };
        let (signals, vehicle) = flown(seed, &random, conceal);
        let found = explain(&[signals], &vehicle, &ExplainSettings::default()).unwrap();
        found.named.iter().chain(&found.closest).map(|named| named.id).collect()
    }

    #[test]
    fn a_loss_in_climb_alone_is_no_vortex_ring_and_one_in_descent_is() {
        for seed in [6101, 6102] {
            let of_climb = named(seed, |truth, weight_n| {
                truth.disturbance = Some(Disturbance::new(move |_, state| {
                    let climb = state.attitude.inverse_transform_vector(&state.velocity_m_s).z.max(0.0);
                    let force_n = Vector3::z() * (-0.004 * weight_n * climb.powi(2));
                    Wrench { force_n, torque_nm: Vector3::zeros() }
                }));
            });
            assert!(!of_climb.contains(&"vortex_ring"), "{of_climb:?}");
            let of_descent = named(seed, |truth, _| {
                truth.effects.push(ActiveEffect::new(by_id("vortex_ring").unwrap(), &[3.0]).unwrap());
            });
            assert_eq!(of_descent, ["vortex_ring"]);
        }
    }
}
