//! What a rotor leaves of a move of the balance, where something else than the balance tells how much that rotor lost.

use super::balance_change::{BalanceChange, mean_share, middle};
use super::explanation::{amount, pull};
use super::groups::Groups;
use crate::trim::{AXES, Balance, TORQUE_SPREAD};
use crate::vehicle::Vehicle;
use nalgebra::{Matrix3, Vector3};

/// Sum of squares, in standard deviations, of what is left of a move of the balance between these groups beside a rotor (by its place in the
/// vehicle's file) whose thrust for a command is now `factor` of that before, with its standard error. To hover it is commanded more by the
/// inverse of the factor. The errors are those of the balance with a load or a battery that may sit elsewhere, that of the factor, and that of the
/// rotor's torque, which may fall by more or less than its thrust. Infinite where there is no such rotor.
#[must_use]
pub fn left_beside_rotor(
    (balance, change): (&Balance, &BalanceChange),
    groups: &Groups,
    vehicle: &Vehicle,
    (rotor, factor): (usize, (f64, f64)),
) -> f64 {
    let Some(of) = vehicle.rotors.get(rotor) else { return f64::INFINITY };
    let moved: [_; AXES] = std::array::from_fn(|axis| change.beside_a_load(axis));
    let pull = pull(vehicle, of, &middle(&moved));
    let (amount, std) = amount(factor, mean_share(balance, groups, rotor));
    let left = Vector3::from(moved.map(|moved| moved.by.0)) - amount * pull;
    let mut covariance = Matrix3::from_diagonal(&Vector3::from(moved.map(|moved| moved.by.1.powi(2))));
    covariance += std * std * pull * pull.transpose();
    covariance[(2, 2)] += (TORQUE_SPREAD * amount * pull.z).powi(2);
    covariance.cholesky().map_or(f64::INFINITY, |covariance| left.dot(&covariance.solve(&left)))
}

#[cfg(test)]
mod tests {
    use super::super::balance_change::{NAMED, judge_balance};
    use super::*;
    use crate::config::load_vehicle;
    use crate::trim::{FlightBalance, mean_arm_m};
    use nalgebra::DMatrix;
    use std::path::Path;

    /// A flight whose balance is known to 0.001, by the shares of its rotors' commands.
    fn flight(vehicle: &Vehicle, shares: [f64; 4]) -> FlightBalance {
        let arm_m = mean_arm_m(vehicle);
        let of = |(rotor, share): (&crate::vehicle::Rotor, &f64)| {
            let at = (rotor.position_m - vehicle.body.center_of_mass_m) / arm_m;
            *share * Vector3::new(at.x, at.y, rotor.spin.yaw_sign())
        };
        let lean: Vector3<f64> = vehicle.rotors.iter().zip(&shares).map(of).sum();
        FlightBalance {
            lean: lean.into(),
            wander: [0.0; 3],
            scatter: [0.002; 3],
            legs: 20,
            felt: [0.0; 2],
            shares: shares.to_vec(),
            lift: None,
            voltage_v: None,
        }
    }

    #[test]
    fn a_rotor_that_is_commanded_more_by_the_inverse_of_its_factor_leaves_nothing() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("configs/x500.toml");
        let vehicle = load_vehicle(&path).unwrap();
        // what hovers gives the same thrusts: those of before are not equal, by a centre of mass that is off
        let thrusts = [0.24, 0.26, 0.25, 0.25];
        let weak = |factor: f64| {
            let commands = [thrusts[0], thrusts[1] / factor, thrusts[2], thrusts[3]];
            commands.map(|command| command / commands.iter().sum::<f64>())
        };
        let left = |after: FlightBalance, rotor: usize| {
            let covariance = DMatrix::identity(2, 2) * 1e-6;
            let balance = Balance {
                flights: vec![flight(&vehicle, thrusts), after],
                covariance: std::array::from_fn(|_| covariance.clone()),
                air_lever: [(0.0, 1.0); 2],
            };
            let groups = Groups::split(2, 1);
            let change = judge_balance(&balance, &groups, &vehicle);
            left_beside_rotor((&balance, &change), &groups, &vehicle, (rotor, (0.8, 0.005)))
        };
        assert!(left(flight(&vehicle, weak(0.8)), 1) < 1e-12);
        // by the error of the factor, within a load, and beyond it
        assert!(left(flight(&vehicle, weak(0.79)), 1) < 4.0);
        let beside = |x: f64| {
            let mut of = flight(&vehicle, weak(0.8));
            of.lean[0] += x;
            of
        };
        assert!(left(beside(0.02), 1) < NAMED && left(beside(0.12), 1) > NAMED);
        // what did not move, and another rotor
        assert!(left(flight(&vehicle, thrusts), 1) > 4.0 && left(flight(&vehicle, weak(0.8)), 2) > NAMED);
        assert!(left(flight(&vehicle, weak(0.8)), 4).is_infinite());
    }
}
