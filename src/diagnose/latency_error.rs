//! Error that the latency brings into what else the torques tell.
//!
//! The column of the latency contains the torque that turns the body, `I w''`. But all torques of the rotors come late, also those that overcome a
//! damping b. So a latency of the model that is wrong by e moves the inertia by `-b e` (consider covariance): 8 % of it with a damping
//! of 4 1/s and an error of 20 ms.

use super::channels::{Channels, append, channels, nothing};
use super::evidence::weighted;
use super::fit::Fitted;
use super::left_over::of_torques;
use super::trace::Trace;
use crate::physics::{Airframe, PhysicsError};
use crate::signals::central_difference;
use nalgebra::{DMatrix, DVector};

/// What the column of the latency lacks, per s of a larger latency: the torques of the effects, late.
pub(super) fn late_effects(flights: &[Trace], fitted: &Fitted) -> Result<Channels, PhysicsError> {
    let airframe = Airframe::new(&fitted.base.vehicle)?;
    let mut out = Channels::default();
    for (trace, along) in flights.iter().zip(&fitted.rows.flights) {
        let mut torque = nothing(trace);
        if trace.torques {
            let torque_nm = along.torque_of_effects_nm(&airframe);
            torque = [0, 1, 2].map(|axis| {
                let about: Vec<f64> = torque_nm.iter().map(|torque| torque[axis]).collect();
                trace.weak(0, &central_difference(&about, trace.grid.step_s))
            });
        }
        append(&mut out, &channels(trace, nothing(trace), torque));
    }
    Ok(out)
}

/// Covariance that an error of the model's latency of this standard deviation, s, brings into what only torques tell. It is zero for what
/// `by_instruments` has told, because that has this error already, and for an infinite error, because then no latency is determined.
///
/// # Errors
/// [`PhysicsError`] where the vehicle is not physical.
pub(super) fn by_latency(
    flights: &[Trace],
    fitted: &Fitted,
    (latency_std_s, by_instruments): (f64, &[usize]),
) -> Result<DMatrix<f64>, PhysicsError> {
    let count = fitted.covariance.nrows();
    let mut brings = DVector::zeros(count);
    if latency_std_s.is_finite() {
        let column = weighted(&late_effects(flights, fitted)?, &fitted.weighted.sigma);
        let all = fitted.weighted.part_in(&column);
        let told = of_torques(fitted).into_iter().filter(|place| !by_instruments.contains(place));
        told.for_each(|place| brings[place] = all[place] * latency_std_s);
    }
    Ok(&brings * brings.transpose())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test ends where it fails")]
    use super::*;
    use crate::diagnose::ExplainSettings;
    use crate::diagnose::base::Base;
    use crate::diagnose::channels::Nuisance;
    use crate::diagnose::fit::{Newton, fit};
    use crate::diagnose::made_flights::flown;
    use crate::diagnose::signatures::signature_of;
    use crate::physics::{ActiveEffect, effects::AngularDamping};
    use crate::simulate::RandomTrajectory;

    /// What a latency of this standard error, s, brings into Ixx and the damping about x, relative to the moment and to the damping.
    fn errors(damping_1_s: f64, latency_std_s: f64, by_instruments: bool) -> [f64; 2] {
        let (signals, vehicle) = flown(4711, &RandomTrajectory::default(), |truth, _| {
            truth.vehicle.propulsion.time_constant_s = Some(0.08);
            let damping = damping_1_s * truth.vehicle.body.inertia_kg_m2[(0, 0)];
            truth.effects.push(ActiveEffect::new(&AngularDamping, &[damping; 3]).unwrap());
        });
        let traces = [Trace::new(&signals, &vehicle, ExplainSettings::default().half_width_s).unwrap()];
        let mut base = Base::rigid(&vehicle);
        base.latency.lag_s = 0.08;
        base.effects.push(signature_of("angular_damping").unwrap().whole());
        let fitted = fit(&traces, base, Newton::Free).unwrap();
        let moment =
            fitted.rows.nuisances.iter().position(|column| column.nuisance == Nuisance::Inertia(0)).unwrap();
        let damping = fitted.rows.nuisances.len();
        let told = if by_instruments { vec![moment, damping] } else { Vec::new() };
        let brought = by_latency(&traces, &fitted, (latency_std_s, &told)).unwrap();
        let of = |place: usize, size: f64| brought[(place, place)].sqrt() / size;
        let moment_kg_m2 = fitted.base.vehicle.body.inertia_kg_m2[(0, 0)];
        [of(moment, moment_kg_m2), of(damping, fitted.base.effects[0].values[0])]
    }

    #[test]
    fn beside_a_strong_damping_the_error_of_the_latency_is_one_of_the_inertia() {
        // a damping of 3 1/s and an error of 20 ms: 6 % of the moment, and next to nothing of the damping
        let [moment, damping] = errors(3.0, 0.02, false);
        assert!((moment - 0.06).abs() < 0.015 && damping < 0.02, "{moment} {damping}");
        let [weak, _] = errors(0.3, 0.02, false);
        assert!((weak - 0.006).abs() < 0.0015, "{weak}");
        assert_eq!(errors(3.0, 0.02, true), [0.0; 2], "what instruments tell has it already");
        assert_eq!(errors(3.0, f64::INFINITY, false), [0.0; 2], "a latency that is not told is held");
    }
}
