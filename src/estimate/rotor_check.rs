//! Detection of one rotor with less thrust than commanded, by the direction of the constant torque that it causes.
//!
//! Such a rotor also biases the mass, because the stated thrust sets the scale. If the remaining torque points, on all
//! three axes, to one rotor, the other rotors set the scale.

use super::weak::WeakEstimate;
use crate::signals::Signals;
use crate::vehicle::Vehicle;
use nalgebra::Vector3;
use std::sync::Arc;

/// A rotor that gives the share `factor` of its commanded thrust and torque.
#[derive(Debug, Clone, PartialEq)]
pub struct WeakRotor {
    /// index in the vehicle's order
    pub index: usize,
    /// name in the vehicle file
    pub name: String,
    /// share of its thrust (-)
    pub factor: f64,
    /// standard error of the factor (-)
    pub std: f64,
}

/// Range of a rotor's missing thrust, as a share of that rotor's thrust. Chosen; not measured.
const SHARE: std::ops::RangeInclusive<f64> = 0.04..=0.6;
/// Relative tolerance between the torque about x and y and the rotor's arm. Chosen; not measured.
const ARM_TOLERANCE: f64 = 0.1;
/// Relative tolerance of the yaw torque, which is larger because torque per thrust is known less well. Chosen; not
/// measured.
const YAW_TOLERANCE: f64 = 0.35;
/// Least distance of the missing thrust from zero, standard errors. Chosen; not measured.
const LEAST_SIGMA: f64 = 6.0;

/// The rotor to which the remaining torque points, if there is one. A displaced centre of mass causes no yaw torque and
/// is not confused with it.
#[must_use]
pub fn weak_rotor(estimate: &WeakEstimate, flights: &[Signals], vehicle: &Vehicle) -> Option<WeakRotor> {
    let mixer = vehicle.mixer().matrix;
    let trim = Vector3::from(estimate.trim_torque_nm);
    let trim_std = Vector3::from(estimate.trim_std_nm);
    let thrusts = mean_thrusts(flights, vehicle.rotors.len())?;
    (0..vehicle.rotors.len()).find_map(|index| {
        // per newton of this rotor's thrust: torque about x, y, z
        let arm = Vector3::new(mixer[(1, index)], mixer[(2, index)], mixer[(3, index)]);
        let level = arm.xy();
        let missing_n = trim.xy().dot(&level) / level.norm_squared();
        let std_n = trim_std.xy().norm() / level.norm();
        let share = missing_n / thrusts[index];
        let off = trim - arm * missing_n;
        let arms_agree = off.xy().norm() <= ARM_TOLERANCE * missing_n.abs() * level.norm();
        let yaw_agrees = off.z.abs() <= YAW_TOLERANCE * missing_n.abs() * arm.z.abs() + 3.0 * trim_std.z
            && trim.z.abs() > 3.0 * trim_std.z;
        let found = SHARE.contains(&share)
            && arms_agree
            && yaw_agrees
            && missing_n > LEAST_SIGMA * std_n
            && level.norm() > 0.0;
        found.then(|| WeakRotor {
            index,
            name: vehicle.rotors[index].name.clone(),
            factor: 1.0 - share,
            std: std_n / thrusts[index],
        })
    })
}

/// Mean commanded thrust of each rotor over the usable instants, N; `None` if the log contains the wrench itself.
fn mean_thrusts(flights: &[Signals], rotors: usize) -> Option<Vec<f64>> {
    let mut sums = vec![0.0; rotors];
    let mut count = 0.0;
    for signals in flights {
        if signals.rotor_thrust_n.is_empty() {
            return None;
        }
        for (thrusts, _) in
            signals.rotor_thrust_n.chunks_exact(rotors).zip(&signals.usable).filter(|(_, used)| **used)
        {
            sums.iter_mut().zip(thrusts).for_each(|(sum, thrust)| *sum += thrust);
            count += 1.0;
        }
    }
    Some(sums.into_iter().map(|sum| sum / count).collect())
}

/// The flights with this rotor's thrust multiplied by its factor.
#[must_use]
pub fn with_weak_rotor(flights: &[Signals], vehicle: &Vehicle, weak: &WeakRotor) -> Vec<Signals> {
    let column = vehicle.mixer().matrix.column(weak.index).into_owned();
    let mut out = flights.to_vec();
    for signals in &mut out {
        let thrusts = signals.rotor_thrust_n.chunks_exact(vehicle.rotors.len());
        for (wrench, thrusts) in Arc::make_mut(&mut signals.wrench).iter_mut().zip(thrusts) {
            *wrench -= column * ((1.0 - weak.factor) * thrusts[weak.index]);
        }
    }
    out
}
