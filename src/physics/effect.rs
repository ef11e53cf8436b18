//! The one trait: a physical effect that the rigid body with exact thrust leaves out.

use std::fmt::Debug;

use nalgebra::Vector3;

use super::{Airframe, Input, MAX_ROTORS, State, Wrench};

/// One parameter of an effect.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parameter {
    /// name in reports and files
    pub name: &'static str,
    /// SI unit, `-` if none
    pub unit: &'static str,
    /// least physically plausible value
    pub min: f64,
    /// greatest physically plausible value
    pub max: f64,
}

/// What the vehicle does and what flows around it at one instant.
#[derive(Debug, Clone, Copy)]
pub struct Condition<'a> {
    /// the rotors' geometry
    pub airframe: &'a Airframe,
    /// the rigid body
    pub state: &'a State,
    /// time, commands, battery
    pub input: &'a Input,
    /// velocity of the centre of mass through the air, body, m/s
    pub air_velocity_m_s: Vector3<f64>,
}

impl<'a> Condition<'a> {
    /// The condition in a given wind (world, m/s).
    #[must_use]
    pub fn new(airframe: &'a Airframe, state: &'a State, input: &'a Input, wind_m_s: Vector3<f64>) -> Self {
        let air_velocity_m_s = state.attitude.inverse_transform_vector(&(state.velocity_m_s - wind_m_s));
        Self { airframe, state, input, air_velocity_m_s }
    }

    /// Velocity of a point of the body through the air (`arm_m` from the centre of mass), body, m/s.
    #[must_use]
    pub fn air_velocity_at(&self, arm_m: &Vector3<f64>) -> Vector3<f64> {
        self.air_velocity_m_s + self.state.rates_rad_s.cross(arm_m)
    }
}

/// Motion and thrust of each rotor; entries beyond the airframe's rotor count are not used.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rotors {
    /// over the hover speed (-)
    pub speed: [f64; MAX_ROTORS],
    /// rate of the relative speed, 1/s
    pub acceleration_1_s: [f64; MAX_ROTORS],
    /// N
    pub thrust_n: [f64; MAX_ROTORS],
}

impl Rotors {
    /// Rotors that turn as commanded, at constant speed.
    #[must_use]
    pub fn as_commanded(airframe: &Airframe, relative_speed: &[f64; MAX_ROTORS]) -> Self {
        let mut rotors =
            Self { speed: *relative_speed, acceleration_1_s: [0.0; MAX_ROTORS], thrust_n: [0.0; MAX_ROTORS] };
        rotors.thrust_from_speed(airframe);
        rotors
    }

    /// Sets the thrusts that belong to the speeds.
    pub fn thrust_from_speed(&mut self, airframe: &Airframe) {
        for (thrust, speed) in self.thrust_n.iter_mut().zip(&self.speed) {
            *thrust = airframe.thrust_n(*speed);
        }
    }
}

/// An effect's parameter values and own states, and where it writes the rates of the latter.
#[derive(Debug)]
pub struct Own<'a> {
    /// in the order of [`Effect::parameters`]
    pub parameters: &'a [f64],
    /// as many as [`Effect::state_count`]
    pub states: &'a [f64],
    /// 1/s of each state; the effect writes them in whichever hook it likes, unset ones stay zero
    pub rates: &'a mut [f64],
}

/// One physical effect: equation, parameters, and the sentence by which the report names it.
///
/// The hooks run in this order over all effects of a model: [`Effect::wind_m_s`],
/// [`Effect::rotor_speed`], [`Effect::rotor_thrust`], [`Effect::wrench`]. An effect fills in those
/// that it acts through; the others change nothing.
pub trait Effect: Debug + Sync {
    /// identifier as in reports and files
    fn id(&self) -> &'static str;

    /// what a person reads
    fn sentence(&self) -> &'static str;

    /// name, unit, bounds
    fn parameters(&self) -> &'static [Parameter];

    /// number of own states on this airframe
    fn state_count(&self, _airframe: &Airframe) -> usize {
        0
    }

    /// own states at the start, for rotors that have long followed their command
    fn initial_states(&self, _at: &Condition, _rotors: &Rotors, _states: &mut [f64]) {}

    /// wind that it adds, world, m/s
    fn wind_m_s(&self, _input: &Input, _own: &Own) -> Vector3<f64> {
        Vector3::zeros()
    }

    /// alters the rotors' speed and its rate
    fn rotor_speed(&self, _at: &Condition, _own: &mut Own, _rotors: &mut Rotors) {}

    /// alters the rotors' thrust at their speed
    fn rotor_thrust(&self, _at: &Condition, _own: &mut Own, _rotors: &mut Rotors) {}

    /// adds force and torque beyond the rotors' thrust
    fn wrench(&self, _at: &Condition, _rotors: &Rotors, _own: &mut Own) -> Wrench {
        Wrench::zero()
    }

    /// Whether its wrench is linear in its parameters, so that [`Effect::regressor`] holds.
    fn is_linear(&self) -> bool {
        false
    }

    /// The wrench for one unit of each parameter, one column a parameter, without own states.
    /// Columns of an effect that is not linear are left as they are.
    fn regressor(&self, _at: &Condition, _rotors: &Rotors, _columns: &mut [Wrench]) {}
}

/// The whole change of force and torque that one effect makes, through thrust and otherwise, to
/// rotors that turn at `rotors.speed`.
#[must_use]
pub fn effect_wrench(effect: &dyn Effect, at: &Condition, rotors: &Rotors, own: &mut Own) -> Wrench {
    let mut changed = *rotors;
    effect.rotor_speed(at, own, &mut changed);
    if changed.speed != rotors.speed {
        changed.thrust_from_speed(at.airframe);
    }
    effect.rotor_thrust(at, own, &mut changed);
    let mut difference_n = changed.thrust_n;
    for (difference, before) in difference_n.iter_mut().zip(&rotors.thrust_n) {
        *difference -= before;
    }
    at.airframe.thrust_wrench(&difference_n) + effect.wrench(at, &changed, own)
}
