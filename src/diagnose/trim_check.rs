//! Hover as a check: a name that moves the balance of the vehicle has to move it to where the vehicle hovers.
//!
//! In still air a vehicle hovers with commands whose torque is nought. A weak rotor or a centre of mass that is off is found from all of
//! the motion, where other causes can look like it. Means over seconds of hover and slow flight know less, and of nothing else.

use super::base::Base;
use crate::physics::{
    Airframe, Condition, Effect, Input, MAX_ROTORS, PhysicsError, Rotors, State, effects_wrench,
};
use crate::signals::Signals;
use crate::trim::{AXES, Balance, balance, legs, mean_arm_m};
use crate::vehicle::Vehicle;
use nalgebra::Vector3;

/// Standard errors by which the balance has to miss a name's size. That of a comparison of two flights (`change::NAMED`).
const MISSED: f64 = 4.5;
/// Share of the name's size below which the balance does not show it.
const SHOWN: f64 = 0.5;
/// A name that moves the balance by less than this does not act on it, arms.
const MOVED: f64 = 1e-6;
/// Height above ground at which the model hovers, m: no effect of ground or ceiling acts there.
const HEIGHT_M: f64 = 100.0;

/// How flights hover.
pub(super) struct Trim {
    each: Vec<Balance>,
}

impl Trim {
    /// Of flights; those that show no balance, and those in which torques cannot be told, say nothing.
    pub(super) fn of(flights: &[Signals], vehicle: &Vehicle) -> Self {
        let shown = flights.iter().filter_map(|signals| legs(signals, vehicle).ok());
        Self { each: shown.map(|legs| balance(&[legs])).collect() }
    }

    /// The effect of the model, by its place, that the balance of hover excludes most clearly.
    ///
    /// # Errors
    /// [`PhysicsError`] where the vehicle is not physical.
    pub(super) fn refuted(&self, base: &Base) -> Result<Option<usize>, PhysicsError> {
        let airframe = Airframe::new(&base.vehicle)?;
        let acts = |place: &usize| base.effects[*place].effect().state_count(&airframe) == 0;
        let places: Vec<usize> = (0..base.effects.len()).filter(acts).collect();
        let mut worst: Option<(f64, usize)> = None;
        for of in &self.each {
            let hover = Hover { airframe: &airframe, arm_m: mean_arm_m(&base.vehicle), of };
            let with = hover.balance(base, &places);
            for &place in &places {
                let others: Vec<usize> = places.iter().copied().filter(|other| *other != place).collect();
                let missed = hover.missed(&with, &(hover.balance(base, &others) - with));
                if missed > worst.map_or(MISSED, |(most, _)| most) {
                    worst = Some((missed, place));
                }
            }
        }
        Ok(worst.map(|(_, place)| place))
    }
}

/// One flight's hover under a model.
struct Hover<'a> {
    airframe: &'a Airframe,
    arm_m: f64,
    of: &'a Balance,
}

impl Hover<'_> {
    /// What is left of the balance under a model with these effects: arms along body x and y, and a share about z.
    fn balance(&self, base: &Base, places: &[usize]) -> Vector3<f64> {
        let shares = &self.of.flights[0].shares;
        let weight_n = base.vehicle.body.mass_kg * self.airframe.gravity_m_s2;
        let mut speed = [0.0; MAX_ROTORS];
        for (speed, share) in speed.iter_mut().zip(shares) {
            *speed = self.airframe.relative_speed_of_thrust(share * weight_n);
        }
        let rotors = Rotors::as_commanded(self.airframe, &speed);
        let input = Input { speed_command: speed, ..Input::from_commands(self.airframe, 0.0, &[]) };
        let state = State::at_rest(Vector3::z() * HEIGHT_M, 0.0);
        let at = Condition::new(self.airframe, &state, &input, Vector3::zeros());
        let effects = places.iter().map(|&place| {
            let term = &base.effects[place];
            (term.effect() as &dyn Effect, term.values.as_slice())
        });
        let wrench = effects_wrench(effects, &at, &rotors);
        let (force_n, torque) = (wrench.force_n.z, wrench.torque_nm);
        let about_z = base.vehicle.propulsion.torque_per_thrust_m;
        Vector3::new(-torque.y / self.arm_m, torque.x / self.arm_m, torque.z / about_z) / force_n
    }

    /// Standard errors by which hover misses what an effect does to the balance; 0 where it shows half of that. `left` is the balance
    /// with the effect, and `by` what the balance is more without it.
    fn missed(&self, left: &Vector3<f64>, by: &Vector3<f64>) -> f64 {
        if by.norm() < MOVED {
            return 0.0;
        }
        let wander = &self.of.flights[0].wander;
        let mut weights = Vector3::<f64>::zeros();
        // what turns a vehicle about the vertical has other causes too
        for axis in 0..AXES - 1 {
            weights[axis] = (self.of.std(0, axis).powi(2) + wander[axis].powi(2)).recip();
        }
        let information = by.component_mul(&weights).dot(by);
        if information.is_nan() || information <= 0.0 {
            return 0.0;
        }
        // the size that would bring the balance to nought, over the named one
        let shown = 1.0 + by.component_mul(&weights).dot(left) / information;
        if shown < SHOWN { (1.0 - shown) * information.sqrt() } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test ends where it fails")]
    use super::*;
    use crate::diagnose::signatures::signature_of;
    use crate::trim::{LEAST_LEGS, Leg};

    /// A vehicle that hovers with these shares of its rotors.
    fn hovering(vehicle: &Vehicle, shares: [f64; 4]) -> Trim {
        let arm_m = mean_arm_m(vehicle);
        let mut lean = [0.0; AXES];
        for (rotor, share) in vehicle.rotors.iter().zip(shares) {
            lean[0] += share * rotor.position_m.x / arm_m;
            lean[1] += share * rotor.position_m.y / arm_m;
            lean[2] += share * rotor.spin.yaw_sign();
        }
        let leg = |number: usize| Leg {
            time_s: 2.0 * number as f64,
            lean: lean.map(|lean| lean + if number % 2 == 0 { 1e-3 } else { -1e-3 }),
            felt: [0.0; 2],
            turning: [0.0; AXES],
            rate: [0.0; AXES],
            shares: shares.to_vec(),
            lift: None,
            voltage_v: None,
        };
        Trim { each: vec![balance(&[(0..2 * LEAST_LEGS).map(leg).collect()])] }
    }

    #[test]
    fn a_weak_rotor_has_to_show_in_hover() {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/p01_vehicle.toml");
        let vehicle = crate::config::load_vehicle(&path).unwrap();
        let mut base = Base::anchored(&vehicle);
        let weak = signature_of("weak_rotor").unwrap();
        base.effects.push(weak.term(&[1.0, 0.9], &[1]));
        // thrusts without torque where rotor 1 gives nine tenths
        let whole = [0.25; 4];
        let airframe = Airframe::new(&base.vehicle).unwrap();
        let trim = hovering(&vehicle, whole);
        let hover = Hover { airframe: &airframe, arm_m: mean_arm_m(&vehicle), of: &trim.each[0] };
        assert!(hover.balance(&base, &[]).norm() < 1e-9, "nothing is missing");
        assert_eq!(trim.refuted(&base).unwrap(), Some(0));
        let mut weak = whole;
        weak[1] /= 0.9;
        let sum: f64 = weak.iter().sum();
        let trim = hovering(&vehicle, weak.map(|share| share / sum));
        let hover = Hover { airframe: &airframe, arm_m: mean_arm_m(&vehicle), of: &trim.each[0] };
        assert!(hover.balance(&base, &[]).norm() > 0.01 && hover.balance(&base, &[0]).norm() < 1e-9);
        assert_eq!(trim.refuted(&base).unwrap(), None);
    }
}
