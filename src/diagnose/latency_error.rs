//! Error that the latency brings into what else the torques tell.
//!
//! A torque that damps the rotation and a latency together look like another inertia: of `I w' + b w` behind a lag T, slow motion tells
//! b, the sum `I + b T` and, less well, the product `I T`. Where noise is fed back, a latency is wrong by more than the statistics
//! of its fit say. The rest of its error moves the inertia and the damping along what the fit does not tell apart (consider covariance).

use super::channels::Nuisance;
use super::fit::Fitted;
use super::left_over::of_torques;

/// Adds it to the covariance of a fit, whose latency has this standard error in all, s: to what only torques tell, except where
/// `by_instruments` has told it. Theirs have it already.
pub(super) fn add_latency_error(fitted: &mut Fitted, latency_std_s: f64, by_instruments: &[usize]) {
    let is_latency = |nuisance: Nuisance| nuisance == Nuisance::Latency;
    let Some(latency) = fitted.rows.nuisances.iter().position(|column| is_latency(column.nuisance)) else {
        return;
    };
    let own = fitted.covariance[(latency, latency)];
    let further = latency_std_s.powi(2) - own;
    if !(own > 0.0 && further > 0.0 && further.is_finite()) {
        return;
    }
    let places: Vec<usize> =
        of_torques(fitted).into_iter().filter(|place| !by_instruments.contains(place)).collect();
    let moved: Vec<f64> = places.iter().map(|&place| fitted.covariance[(place, latency)] / own).collect();
    for (&place, by) in places.iter().zip(&moved) {
        for (&other, by_other) in places.iter().zip(&moved) {
            fitted.covariance[(place, other)] += by * by_other * further;
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test ends where it fails")]
    use super::*;
    use crate::diagnose::base::Base;
    use crate::diagnose::fit::{Newton, fit};
    use crate::diagnose::made_flights::flown;
    use crate::diagnose::signatures::signature_of;
    use crate::diagnose::{ExplainSettings, Trace};
    use crate::physics::{ActiveEffect, effects::AngularDamping};
    use crate::simulate::RandomTrajectory;

    /// Standard errors of Ixx and of the damping about x with a latency of this standard error, s, relative to the moment and to the damping.
    fn errors(damping_1_s: f64, latency_std_s: f64, by_instruments: bool) -> [f64; 2] {
        let (signals, vehicle) = flown(4711, &RandomTrajectory::default(), |truth, _| {
            truth.vehicle.propulsion.time_constant_s = Some(0.08);
            let damping = damping_1_s * truth.vehicle.body.inertia_kg_m2[(0, 0)];
            truth.effects.push(ActiveEffect::new(&AngularDamping, &[damping; 3]).unwrap());
        });
        let trace = Trace::new(&signals, &vehicle, ExplainSettings::default().half_width_s).unwrap();
        let mut base = Base::rigid(&vehicle);
        base.latency.lag_s = 0.08;
        base.effects.push(signature_of("angular_damping").unwrap().whole());
        let mut fitted = fit(&[trace], base, Newton::Free).unwrap();
        let moment =
            fitted.rows.nuisances.iter().position(|column| column.nuisance == Nuisance::Inertia(0)).unwrap();
        let damping = fitted.rows.nuisances.len();
        let told = if by_instruments { vec![moment, damping] } else { Vec::new() };
        add_latency_error(&mut fitted, latency_std_s, &told);
        let of = |place: usize, size: f64| fitted.covariance[(place, place)].sqrt() / size;
        let moment_kg_m2 = fitted.base.vehicle.body.inertia_kg_m2[(0, 0)];
        [of(moment, moment_kg_m2), of(damping, fitted.base.effects[0].values[0])]
    }

    #[test]
    fn beside_a_strong_damping_the_error_of_the_latency_is_one_of_the_inertia() {
        let plain = errors(3.0, 0.0, false);
        let unsure = errors(3.0, 0.02, false);
        // I + b T is told: an error of T is b T over I of the moment, at least
        assert!(unsure[0] > 0.05 && unsure[0] < 0.4, "{unsure:?}, {plain:?}");
        assert!(plain[0] < 0.02 && unsure[1] < 0.1, "{unsure:?}, {plain:?}");
        let weak = errors(0.2, 0.02, false);
        assert!(weak[0] < 0.3 * unsure[0], "{weak:?}");
        assert_eq!(errors(3.0, 0.02, true), plain, "what instruments tell has it already");
        assert_eq!(errors(3.0, f64::INFINITY, false), plain, "a latency that is not told is held");
    }
}
