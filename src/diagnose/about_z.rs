//! Izz where the motion about z tells only the ratio of izz and of the rotors' torque per thrust.
//!
//! Where the torque goes with another power of the thrust than stated, no torque per thrust is right, and izz by the stated one is far from
//! that of a body. Izz then stays as stated, and the torque per thrust follows: the vehicle turns as before.

use super::base::turns_about_z;
use super::channels::Nuisance;
use super::explanation::{Explanation, Verdict};
use super::fit::Fitted;
use super::named::Named;
use super::physical::turn_with;
use super::torque_law::ABOUT_Z;
use crate::estimate::{Theta, is_physical, theta_of};
use crate::vehicle::Vehicle;

impl Explanation {
    /// The same with izz as the vehicle file states it, where the flights tell only its ratio to the torque per thrust; that torque, and
    /// all that the motion tells as ratios to it, follow. No body has an izz above the sum of ixx and iyy: where the stated one is beyond
    /// that, it is the nearest one that is not. The last step before a model is told: the rows of the fits stay those of the stated torque.
    #[must_use]
    pub fn keeping_about_z(mut self, stated: &Vehicle) -> Self {
        if self.torque_law.is_none() {
            return self;
        }
        let stated = theta_of(&stated.body)[ABOUT_Z];
        let [before, after] = [&self.search.before, &self.search.after].map(|fit| factor_of(fit, stated));
        turn(&mut self.search.before, before);
        turn(&mut self.search.after, after);
        let serving = if self.verdict == Verdict::Unexplained { before } else { after };
        let slight = self.slight.iter_mut().map(|slight| &mut slight.effect);
        self.named.iter_mut().chain(slight).for_each(|named| turn_named(named, serving));
        self.closest.iter_mut().for_each(|named| turn_named(named, after));
        for limit in self.limits.iter_mut().filter(|limit| turns_about_z(limit.parameter, limit.unit)) {
            (limit.limit, limit.certain) = (limit.limit * serving, limit.certain * serving);
        }
        self
    }
}

/// What takes izz of a fit to the stated one, or near it.
fn factor_of(fit: &Fitted, stated: f64) -> f64 {
    let theta = theta_of(&fit.base.vehicle.body);
    let factor = nearest_about_z(&theta, stated) / theta[ABOUT_Z];
    if factor.is_finite() && factor > 0.0 { factor } else { 1.0 }
}

fn turn_named(named: &mut Named, factor: f64) {
    for parameter in named.parameters.iter_mut().filter(|of| turns_about_z(of.name, of.unit)) {
        (parameter.value, parameter.std) = (parameter.value * factor, parameter.std * factor);
    }
}

/// A fit with izz, torque per thrust and all ratios to it times a factor. Its rows stay: their torques are those of the stated ratio.
fn turn(fitted: &mut Fitted, factor: f64) {
    fitted.base.vehicle.body.inertia_kg_m2[(2, 2)] *= factor;
    turn_with(&mut fitted.base, factor);
    let nuisances = &fitted.rows.nuisances;
    let is_izz = |place: &usize| matches!(nuisances[*place].nuisance, Nuisance::Inertia(entry) if entry + 1 == ABOUT_Z);
    let mut columns: Vec<usize> = (0..nuisances.len()).filter(is_izz).collect();
    let free = fitted.base.effects.iter();
    let free = free.flat_map(|term| term.free.iter().map(|&slot| term.parameter(slot)));
    let about_z = free.enumerate().filter(|(_, of)| of.is_some_and(|of| turns_about_z(of.name, of.unit)));
    columns.extend(about_z.map(|(place, _)| nuisances.len() + place));
    let rows = fitted.covariance.nrows();
    for place in columns.into_iter().filter(|place| *place < rows) {
        fitted.covariance.row_mut(place).scale_mut(factor);
        fitted.covariance.column_mut(place).scale_mut(factor);
    }
}

/// The value of izz nearest to `wanted` with which mass and inertia are those of a body; that of `theta`, where there is none between.
fn nearest_about_z(theta: &Theta, wanted: f64) -> f64 {
    let is_possible = |about_z: f64| {
        let mut moved = *theta;
        [1.0, NOT_FLAT].into_iter().all(|factor| {
            moved[ABOUT_Z] = factor * about_z;
            is_physical(&moved)
        })
    };
    if is_possible(wanted) {
        return wanted;
    }
    if !is_possible(theta[ABOUT_Z]) {
        return theta[ABOUT_Z];
    }
    let (mut possible, mut beyond) = (theta[ABOUT_Z], wanted);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (possible + beyond);
        if is_possible(middle) {
            possible = middle;
        } else {
            beyond = middle;
        }
    }
    possible
}

/// No body is quite flat: izz is so much below the sum of ixx and iyy. Set by judgement; rounded digits of the moments keep within it.
const NOT_FLAT: f64 = 1.01;
/// Halvings of the distance to the nearest possible izz: to a millionth of it.
const HALVINGS: usize = 20;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn izz_is_the_stated_one_or_the_nearest_to_it_that_a_body_can_have() {
        let theta = Theta::from([2.0, 0.02, 0.0, 0.0, 0.021, 0.0, 0.018]);
        assert!((nearest_about_z(&theta, 0.03) - 0.03).abs() < 1e-12);
        // no more than ixx and iyy together, no less than their difference
        assert!((nearest_about_z(&theta, 0.06) - 0.041 / NOT_FLAT).abs() < 1e-6);
        assert!((nearest_about_z(&theta, 0.0001) - 0.001).abs() < 1e-6);
        let none = Theta::from([2.0, 0.02, 0.0, 0.0, 0.021, 0.0, 0.08]);
        assert!((nearest_about_z(&none, 0.06) - 0.08).abs() < 1e-12);
        assert!((nearest_about_z(&none, 0.03) - 0.03).abs() < 1e-12);
    }
}
