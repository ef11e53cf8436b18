//! What each rotor gives for its command along flights, by their balance in still air.

use super::balance::{Balance, FlightBalance};
use super::legs::mean_arm_m;
use crate::vehicle::Vehicle;
use nalgebra::{Matrix3, Vector3};

/// Thrust of a rotor for its command along the flights, over that of the mean of all rotors: value and standard error; one entry a flight.
pub type RotorTrack = Vec<(f64, f64)>;

/// A weak rotor gives less torque as well, in proportion to its thrust or not: a shorter blade gives less still, a
/// motor that turns slower less of both. Standard deviation of torque's share over thrust's. A smaller one would not
/// recognise a cut blade, a larger one not tell two rotors apart.
pub const TORQUE_SPREAD: f64 = 0.35;

/// Of each rotor of a vehicle, in the order of its description. The balance has three components: of more than four rotors, it is the
/// smallest difference between them that makes it. The centre of mass is taken where the description has it. Empty where the rotors' places
/// do not tell.
#[must_use]
pub fn rotor_tracks(balance: &Balance, vehicle: &Vehicle) -> Vec<RotorTrack> {
    let arm_m = mean_arm_m(vehicle);
    let pulls: Vec<Vector3<f64>> = vehicle
        .rotors
        .iter()
        .map(|rotor| {
            let at = (rotor.position_m - vehicle.body.center_of_mass_m) / arm_m;
            Vector3::new(at.x, at.y, rotor.spin.yaw_sign())
        })
        .collect();
    let count = pulls.len() as f64;
    let mean = pulls.iter().sum::<Vector3<f64>>() / count;
    let spread: Matrix3<f64> = pulls.iter().map(|pull| (pull - mean) * (pull - mean).transpose()).sum();
    let Some(inverse) = spread.try_inverse() else { return Vec::new() };
    let of = |pull: &Vector3<f64>| -> RotorTrack {
        // share of the rotor = 1/n + row . (balance - its mean)
        let row = inverse * (pull - mean);
        let one = |(place, flight): (usize, &FlightBalance)| {
            let lean = Vector3::from(flight.lean) - mean;
            let mut std = Vector3::from_fn(|axis, _| balance.lean(place, axis).1);
            std.z = std.z.hypot(TORQUE_SPREAD * flight.lean[2]);
            let share = 1.0 / count + row.dot(&lean);
            // a rotor that gives less for its command is commanded more
            (1.0 / (count * share), row.component_mul(&std).norm() / (count * share * share))
        };
        balance.flights.iter().enumerate().map(one).collect()
    };
    pulls.iter().map(of).collect()
}
