//! What can move the balance of a vehicle, and the direction in which it does.

use crate::trim::{AXES, FlightBalance, TORQUE_SPREAD, mean_arm_m};
use crate::vehicle::{Rotor, Vehicle};
use nalgebra::Vector3;

/// What changed of a vehicle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum What {
    /// a rotor gives another thrust for its command, by its place in the vehicle's file
    Rotor(usize),
    /// the centre of mass is elsewhere: the vehicle's, or that of its load
    CentreOfMass,
    /// a torque about the vertical that no single rotor makes
    YawTorque,
}

/// Times that the spread, which follows the amount, settles in.
const PASSES: usize = 4;

/// One explanation of a move of the balance.
#[derive(Debug, Clone)]
pub(super) struct Explanation {
    pub(super) what: What,
    /// how the balance moves with each of its amounts
    directions: Vec<Vector3<f64>>,
}

/// How well an explanation accounts for a move.
#[derive(Debug, Clone)]
pub(super) struct Account {
    pub(super) what: What,
    /// with standard errors
    pub(super) amounts: Vec<(f64, f64)>,
    /// sum of squares that is left, in standard deviations
    pub(super) left: f64,
    /// twice the negative logarithm of the likelihood beyond that of no change's covariance
    pub(super) cost: f64,
}

/// All explanations for a vehicle. `middle` is the mean of the balance before and after, from which a changed rotor pulls it.
pub(super) fn explanations(vehicle: &Vehicle, middle: &Vector3<f64>) -> Vec<Explanation> {
    let rotors = vehicle.rotors.iter().enumerate().map(|(place, rotor)| Explanation {
        what: What::Rotor(place),
        directions: vec![pull(vehicle, rotor, middle)],
    });
    let others = [
        Explanation { what: What::CentreOfMass, directions: vec![Vector3::x(), Vector3::y()] },
        Explanation { what: What::YawTorque, directions: vec![Vector3::z()] },
    ];
    rotors.chain(others).collect()
}

/// Where a rotor that is commanded more pulls the balance to, from `middle`: the mean of where it was and where it is, which is the same for the
/// way back.
pub(super) fn pull(vehicle: &Vehicle, rotor: &Rotor, middle: &Vector3<f64>) -> Vector3<f64> {
    let at = (rotor.position_m - vehicle.body.center_of_mass_m) / mean_arm_m(vehicle);
    Vector3::new(at.x, at.y, rotor.spin.yaw_sign()) - middle
}

impl Explanation {
    /// Accounts for a move with these variances.
    pub(super) fn accounts(&self, moved: &Vector3<f64>, variances: &Vector3<f64>) -> Account {
        let mut widened = *variances;
        let mut found = self.fitted(moved, &widened);
        if let (What::Rotor(_), [pull]) = (self.what, self.directions.as_slice()) {
            for _ in 0..PASSES {
                widened.z = variances.z + (TORQUE_SPREAD * found.amounts[0].0 * pull.z).powi(2);
                found = self.fitted(moved, &widened);
            }
        }
        found.cost = found.left + (widened.z / variances.z).ln();
        found
    }

    fn fitted(&self, moved: &Vector3<f64>, variances: &Vector3<f64>) -> Account {
        let mut left = *moved;
        let mut amounts = Vec::new();
        // directions of one explanation are at right angles
        for direction in &self.directions {
            let (amount, std) = along(direction, moved, variances);
            left -= amount * direction;
            amounts.push((amount, std));
        }
        let left = left.component_mul(&left).component_div(variances).sum();
        Account { what: self.what, amounts, left, cost: left }
    }

    /// The least first amount whose square is `squares` times that of its standard error, with the spread that follows the amount. By
    /// `a^2 (n + p^2 / (v + s a^2)) = squares` this is the root of a quadratic equation in `a^2`: `n` is the information along x and y, `p` the
    /// pull about z, `v` the variance there, and `s a^2` the spread's.
    pub(super) fn least(&self, variances: &Vector3<f64>, squares: f64) -> f64 {
        let direction = self.directions[0];
        let level = direction.x.powi(2) / variances.x + direction.y.powi(2) / variances.y;
        let pull = direction.z.powi(2);
        let spread = if matches!(self.what, What::Rotor(_)) { TORQUE_SPREAD.powi(2) * pull } else { 0.0 };
        let linear = level * variances.z + pull - squares * spread;
        let root = (linear * linear + 4.0 * level * spread * squares * variances.z).sqrt();
        (2.0 * squares * variances.z / (linear + root)).sqrt()
    }
}

impl Account {
    /// Square of the first amount in its standard errors.
    pub(super) fn certainty(&self) -> f64 {
        self.amounts.first().map_or(0.0, |(amount, std)| (amount / std).powi(2))
    }
}

/// How often a direction fits into a move with these variances, with its standard error.
pub(super) fn along(direction: &Vector3<f64>, moved: &Vector3<f64>, variances: &Vector3<f64>) -> (f64, f64) {
    let weighted = direction.component_div(variances);
    let information = weighted.dot(direction);
    (weighted.dot(moved) / information, information.recip().sqrt())
}

/// Least cost of another rotor than `named` together with a load that sits elsewhere, as [`Account::cost`]: the rotor takes what is about the
/// vertical, the load the rest along x and y, where its square is less than `most` arms^2. `None`: no load does.
pub(super) fn other_rotor_and_load(
    known: &[Explanation],
    named: What,
    (moved, variances): (&Vector3<f64>, &Vector3<f64>),
    most: f64,
) -> Option<f64> {
    let is_enough = |other: &&Explanation| {
        let (What::Rotor(_), [pull]) = (other.what, other.directions.as_slice()) else { return false };
        let load = moved - moved.z / pull.z * pull;
        other.what != named && load.norm_squared() < most
    };
    let widened = 1.0 + (TORQUE_SPREAD * moved.z).powi(2) / variances.z;
    known.iter().any(|other| is_enough(&other)).then(|| widened.ln())
}

/// The factor of a rotor's thrust that an amount means, with its standard error: the rotor takes a larger share of the commands, and the other
/// rotors keep theirs among each other. `share` is the mean of the rotor's shares before and after. With `h`, half the amount, and `o`, the
/// share of the others, its share was `s - o h` and is `s + o h`; those of the others went by `(1 - h) / (1 + h)`. The factor is the ratio of
/// both. The way back has the opposite amount and the inverse factor, as many standard errors from 1.
pub(super) fn factor((amount, std): (f64, f64), share: f64) -> (f64, f64) {
    let half = 0.5 * amount;
    let now = (share + (1.0 - share) * half) * (1.0 + half);
    (1.0 - amount / now, std / now.abs())
}

/// The amount that a factor on a rotor's thrust means, with its standard error: the inverse of [`factor`], and the error of the factor's
/// logarithm, which is that of the inverse factor as well. By `g = (1 - f) / (1 + f)`, [`factor`] is `h - o g h^2 = s g`.
pub(super) fn amount((factor, std): (f64, f64), share: f64) -> (f64, f64) {
    let (others, lost) = (1.0 - share, (1.0 - factor) / (1.0 + factor));
    let root = (1.0 - 4.0 * others * share * lost * lost).max(f64::MIN_POSITIVE).sqrt();
    let half = 2.0 * share * lost / (1.0 + root);
    let slope = (1.0 - lost * lost) * (share + others * half * half) / root;
    (2.0 * half, slope * std / factor.abs())
}

/// A balance as a vector.
pub(super) fn lean(of: &FlightBalance) -> Vector3<f64> {
    let lean: [f64; AXES] = of.lean;
    Vector3::from(lean)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_way_back_has_the_opposite_amount_and_the_inverse_factor() {
        // a rotor that gives 0.8 hovers with 1 / 0.8 of its command: its share, and that of the commands which it took from the others
        let before = 0.26;
        let after = before / 0.8 / (1.0 - before + before / 0.8);
        let taken: f64 = (after - before) / (1.0 - before);
        let (amount_of, share) = (taken / (1.0 - 0.5 * taken), 0.5 * (before + after));
        let [there, back] = [amount_of, -amount_of].map(|amount| factor((amount, 0.01), share));
        assert!((there.0 - 0.8).abs() < 1e-12 && (back.0 - 1.25).abs() < 1e-12, "{there:?} {back:?}");
        // as many standard errors from 1
        assert!(((1.0 - there.0) / there.1 - (back.0 - 1.0) / back.1).abs() < 1e-9, "{there:?} {back:?}");
        let [of_there, of_back] = [(0.8, 0.008), (1.25, 0.0125)].map(|factor| amount(factor, share));
        assert!((of_there.0 - amount_of).abs() < 1e-12 && (of_back.0 + amount_of).abs() < 1e-12);
        assert!((of_there.1 - of_back.1).abs() < 1e-12 && of_there.1 > 0.0);
        // by the difference of two factors near it
        let slope = (amount((0.8008, 0.0), share).0 - amount((0.7992, 0.0), share).0) / 0.0016;
        assert!((of_there.1 - 0.008 * slope.abs()).abs() < 1e-7, "{of_there:?} {slope}");
    }

    #[test]
    fn the_least_amount_is_as_many_standard_errors_as_are_asked_with_the_spread_that_follows_it() {
        let rotor = Explanation { what: What::Rotor(0), directions: vec![Vector3::new(0.6, 0.8, 1.0)] };
        let variances = Vector3::new(1e-6, 1e-6, 4e-6);
        let least = rotor.least(&variances, 16.0);
        let account = rotor.accounts(&(least * Vector3::new(0.6, 0.8, 1.0)), &variances);
        assert!((account.amounts[0].0 - least).abs() < 1e-12 && (account.certainty() - 16.0).abs() < 1e-6);
        // what does not turn the vehicle has no such spread: 4 standard errors of 0.001
        let level = Explanation { what: What::Rotor(0), directions: vec![Vector3::new(0.6, 0.8, 0.0)] };
        assert!((level.least(&variances, 16.0) - 0.004).abs() < 1e-12);
        // and what is told about the vertical alone, 4 of 0.002
        let torque = Explanation { what: What::YawTorque, directions: vec![Vector3::z()] };
        assert!((torque.least(&variances, 16.0) - 0.008).abs() < 1e-12);
    }
}
