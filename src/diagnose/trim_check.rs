//! Hover as a check: a name that moves the balance of the vehicle has to move it to where the vehicle hovers.
//!
//! In still air a vehicle hovers with commands whose torque is nought. A weak rotor or a centre of mass that is off is found from all of
//! the motion, where other causes can look like it. Means over seconds of hover and slow flight know less, and of nothing else.

use super::base::Base;
use super::channels::Nuisance;
use super::hover_force::{excludes, sideways};
use super::signature::EffectTerm;
use crate::change::{LOADED, NAMED_SIGMAS};
use crate::physics::{
    Airframe, Condition, Effect, Input, MAX_ROTORS, PhysicsError, Rotors, State, Wrench, effects_wrench,
};
use crate::signals::{OwnOfFlight, Signals};
use crate::trim::{AXES, Balance, balance, legs, mean_arm_m};
use crate::vehicle::Vehicle;
use nalgebra::{Vector2, Vector3};

/// Share of the name's size below which the balance does not show it.
const SHOWN: f64 = 0.5;
/// A name that moves the balance by less than this does not act on it, arms.
const MOVED: f64 = 1e-6;
/// Standard errors from which on hover shows a part of the name for certain, and does not exclude it.
const CERTAIN: f64 = 3.0;
/// Height above ground at which the model hovers, m: no effect of ground or ceiling acts there.
const HEIGHT_M: f64 = 100.0;

/// How flights hover.
pub(super) struct Trim {
    /// each with what is its own
    each: Vec<(Balance, OwnOfFlight)>,
    /// what their accelerometers show across body z
    sideways: Option<Vector2<f64>>,
}

impl Trim {
    /// Of flights; those that show no balance, and those in which torques cannot be told, say nothing.
    pub(super) fn of(flights: &[Signals], vehicle: &Vehicle) -> Self {
        let shown =
            flights.iter().filter_map(|signals| Some((legs(signals, vehicle).ok()?, signals.own.clone())));
        let each = shown.map(|(legs, own)| (balance(&[legs]), own)).collect();
        Self { each, sideways: sideways(flights) }
    }

    /// The effect of the model, by its place, that the balance of hover excludes most clearly, or that the accelerometer does not feel there.
    ///
    /// # Errors
    /// [`PhysicsError`] where the vehicle is not physical.
    pub(super) fn refuted(&self, base: &Base) -> Result<Option<usize>, PhysicsError> {
        let airframe = Airframe::new(&base.vehicle)?;
        // what else moves the balance a little is known by other evidence
        let acts = |place: &usize| {
            let role = &base.effects[*place].signature.role;
            role.which.is_some() || role.of_the_loading
        };
        let places: Vec<usize> = (0..base.effects.len()).filter(acts).collect();
        let mut worst: Option<(f64, usize)> = None;
        for &place in &places {
            let others: Vec<usize> = places.iter().copied().filter(|other| *other != place).collect();
            let mut shown = HoverEvidence::default();
            for (of, own) in &self.each {
                let base = &*base.on(own);
                let hover = Hover { airframe: &airframe, arm_m: mean_arm_m(&base.vehicle), of };
                shown.add(of, &hover.left(base, &places), &hover.left(base, &others));
            }
            let missed = shown.missed();
            if missed > worst.map_or(NAMED_SIGMAS, |(most, _)| most) {
                worst = Some((missed, place));
            }
        }
        Ok(worst.map(|(_, place)| place).or_else(|| self.unfelt(base, &airframe)))
    }

    /// The place of a thrust axis that leans, where the accelerometer does not feel it in hover. A wind pushes there as well, and then
    /// hover excludes nothing.
    fn unfelt(&self, base: &Base, airframe: &Airframe) -> Option<usize> {
        let shown = self.sideways?;
        let leans = |term: &EffectTerm| (term.signature.role.stands_for)(term, Nuisance::Tilt(0));
        let place = base.effects.iter().position(leans)?;
        if base.estimates(|term| term.signature.role.wind.is_some()) {
            return None;
        }
        let rotors = base.vehicle.rotors.len();
        let force = hover_wrench(airframe, base, &[place], &vec![1.0 / rotors as f64; rotors]).force_n;
        excludes(shown, force.xy() / force.z).then_some(place)
    }
}

/// How much of a name hover shows, over all flights.
#[derive(Default)]
struct HoverEvidence {
    /// reciprocal variance of the size over the named one
    information: f64,
    /// the same times how much that size is less than the named one
    less: f64,
}

impl HoverEvidence {
    /// Adds a flight. `left` is the balance with the effect, and `without` that without it.
    fn add(&mut self, of: &Balance, left: &Vector3<f64>, without: &Vector3<f64>) {
        let by = without - left;
        if by.norm() < MOVED {
            return;
        }
        // what turns a vehicle about the vertical has other causes too
        for axis in 0..AXES - 1 {
            let (_, std) = of.lean(0, axis);
            let weight = (std * std + LOADED * LOADED).recip();
            self.information += weight * by[axis] * by[axis];
            self.less -= weight * by[axis] * left[axis];
        }
    }

    /// Standard errors by which hover misses the name; 0 where it shows half of it, or a part of it for certain.
    fn missed(&self) -> f64 {
        if self.information.is_nan() || self.information <= 0.0 {
            return 0.0;
        }
        let (shown, root) = (1.0 - self.less / self.information, self.information.sqrt());
        if shown < SHOWN && shown * root < CERTAIN { (1.0 - shown) * root } else { 0.0 }
    }
}

/// One flight's hover under a model.
struct Hover<'a> {
    airframe: &'a Airframe,
    arm_m: f64,
    of: &'a Balance,
}

impl Hover<'_> {
    /// What is left of the balance in still air under a model with these effects: arms along body x and y, and a share about z.
    fn left(&self, base: &Base, places: &[usize]) -> Vector3<f64> {
        Vector3::from(self.of.flights[0].lean) + self.by_model(base, places) - self.by_model(base, &[])
    }

    /// The balance of a model with these effects, with the commands of hover.
    fn by_model(&self, base: &Base, places: &[usize]) -> Vector3<f64> {
        let wrench = hover_wrench(self.airframe, base, places, &self.of.flights[0].shares);
        let (force_n, torque) = (wrench.force_n.z, wrench.torque_nm);
        let about_z = base.vehicle.propulsion.torque_per_thrust_m;
        Vector3::new(-torque.y / self.arm_m, torque.x / self.arm_m, torque.z / about_z) / force_n
    }
}

/// Force and torque of a model with these effects that hovers in still air, with these shares of the rotors in the thrust.
fn hover_wrench(airframe: &Airframe, base: &Base, places: &[usize], shares: &[f64]) -> Wrench {
    let weight_n = base.vehicle.body.mass_kg * airframe.gravity_m_s2;
    let mut speed = [0.0; MAX_ROTORS];
    for (speed, share) in speed.iter_mut().zip(shares) {
        *speed = airframe.relative_speed_of_thrust(share * weight_n);
    }
    let rotors = Rotors::as_commanded(airframe, &speed);
    let input = Input { speed_command: speed, ..Input::from_commands(airframe, 0.0, &[]) };
    let state = State::at_rest(Vector3::z() * HEIGHT_M, 0.0);
    let at = Condition::new(airframe, &state, &input, Vector3::zeros());
    let effects = places.iter().map(|&place| {
        let term = &base.effects[place];
        (term.effect() as &dyn Effect, term.values.as_slice())
    });
    effects_wrench(effects, &at, &rotors)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test ends where it fails")]
    use super::*;
    use crate::diagnose::signatures::signature_of;
    use crate::trim::{LEAST_LEGS, Leg};

    /// A vehicle that hovers in still air with these shares of its rotors, and leans in a wind along body x by a lever of half an arm.
    fn hovering(vehicle: &Vehicle, shares: [f64; 4], wind: f64) -> Trim {
        let arm_m = mean_arm_m(vehicle);
        let mut lean = [0.0; AXES];
        for (rotor, share) in vehicle.rotors.iter().zip(shares) {
            lean[0] += share * rotor.position_m.x / arm_m;
            lean[1] += share * rotor.position_m.y / arm_m;
            lean[2] += share * rotor.spin.yaw_sign();
        }
        let leg = |number: usize| {
            let felt = wind * (1.0 + (number as f64).sin());
            let noise = if number.is_multiple_of(2) { 1e-3 } else { -1e-3 };
            let [x, y, z] = lean.map(|lean| lean + noise);
            leg_of(number, [x + 0.5 * felt, y, z], [felt, 0.0], shares)
        };
        let each = vec![(balance(&[(0..2 * LEAST_LEGS).map(leg).collect()]), OwnOfFlight::default())];
        Trim { each, sideways: None }
    }

    fn leg_of(number: usize, lean: [f64; AXES], felt: [f64; 2], shares: [f64; 4]) -> Leg {
        Leg {
            time_s: 2.0 * number as f64,
            lean,
            felt,
            turning: [0.0; AXES],
            rate: [0.0; AXES],
            shares: shares.to_vec(),
            lift: None,
            voltage_v: None,
        }
    }

    /// The vehicle of a practice case, and a rigid body of it.
    fn practice() -> (Vehicle, Base) {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/p01_vehicle.toml");
        let vehicle = crate::config::load_vehicle(&path).unwrap();
        let base = Base::anchored(&vehicle);
        (vehicle, base)
    }

    #[test]
    fn a_thrust_axis_that_leans_has_to_be_felt_in_hover() {
        let (_, mut base) = practice();
        let tilt = signature_of("thrust_tilt").unwrap();
        base.effects.push(tilt.term(&[0.0, 0.04], &[0, 1]));
        let felt = |x| Trim { each: Vec::new(), sideways: Some(Vector2::new(x, 0.0)) };
        assert_eq!(felt(0.001).refuted(&base).unwrap(), Some(0));
        assert_eq!(felt(0.03).refuted(&base).unwrap(), None);
        assert_eq!(Trim { each: Vec::new(), sideways: None }.refuted(&base).unwrap(), None);
        // a wind pushes as well
        base.effects.push(signature_of("steady_wind").unwrap().term(&[3.0, 0.0, 0.0], &[0, 1]));
        assert_eq!(felt(0.001).refuted(&base).unwrap(), None);
    }

    #[test]
    fn a_weak_rotor_has_to_show_in_hover() {
        let (vehicle, mut base) = practice();
        let weak = signature_of("weak_rotor").unwrap();
        base.effects.push(weak.term(&[1.0, 0.7], &[1]));
        // commands without torque exclude a rotor that gives seven tenths
        let whole = [0.25; 4];
        let airframe = Airframe::new(&base.vehicle).unwrap();
        let trim = hovering(&vehicle, whole, 0.0);
        let hover = Hover { airframe: &airframe, arm_m: mean_arm_m(&vehicle), of: &trim.each[0].0 };
        assert!(hover.left(&base, &[]).norm() < 1e-3, "nothing is missing");
        assert_eq!(trim.refuted(&base).unwrap(), Some(0));
        let mut weak = whole;
        weak[1] /= 0.7;
        let sum: f64 = weak.iter().sum();
        let weak = weak.map(|share| share / sum);
        let trim = hovering(&vehicle, weak, 0.0);
        let hover = Hover { airframe: &airframe, arm_m: mean_arm_m(&vehicle), of: &trim.each[0].0 };
        assert!(hover.left(&base, &[]).norm() > 0.01 && hover.left(&base, &[0]).norm() < 1e-3);
        assert_eq!(trim.refuted(&base).unwrap(), None);
        // the lean of a vehicle in the wind is no balance
        assert_eq!(hovering(&vehicle, weak, 0.08).refuted(&base).unwrap(), None);
    }
}
