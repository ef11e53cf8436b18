//! A vehicle, its states and what effects do to it, for the tests.

use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use proptest::prelude::*;

use crate::physics::{
    ActiveEffect, Condition, Effect, Input, Model, Own, Parameter, Rotors, State, Wrench, effect_wrench,
};
use crate::vehicle::{Actuator, Anchor, Limits, Propulsion, RigidBody, Rotor, Spin, ThrustLaw, Vehicle};

pub(super) fn vehicle() -> Vehicle {
    let rotor =
        |x: f64, y: f64, spin| Rotor { name: String::new(), position_m: Vector3::new(x, y, 0.02), spin };
    Vehicle {
        name: "test".into(),
        body: RigidBody {
            mass_kg: 2.0,
            inertia_kg_m2: Matrix3::from_diagonal(&Vector3::new(0.02, 0.022, 0.04)),
            center_of_mass_m: Vector3::new(0.003, -0.002, 0.001),
            gyroscopic: 1.0,
        },
        propulsion: Propulsion {
            actuator: Actuator::Speed,
            law: ThrustLaw::Speed { speed_max_rad_s: 1100.0 },
            thrust_coefficient: Some(8.55e-6),
            torque_per_thrust_m: 0.016,
            rotor_radius_m: Some(0.165),
            time_constant_s: None,
            time_constant_down_s: None,
        },
        rotors: vec![
            rotor(0.17, 0.17, Spin::Cw),
            rotor(0.17, -0.17, Spin::Ccw),
            rotor(-0.17, -0.17, Spin::Cw),
            rotor(-0.17, 0.17, Spin::Ccw),
        ],
        limits: Limits::default(),
        anchor: Anchor::Thrust,
        guesses: Vec::new(),
        gravity_m_s2: 9.81,
    }
}

prop_compose! {
    pub(super) fn any_vector(size: f64)(x in -size..size, y in -size..size, z in -size..size) -> Vector3<f64> {
        Vector3::new(x, y, z)
    }
}

prop_compose! {
    pub(super) fn any_state()(
        position_m in any_vector(5.0),
        velocity_m_s in any_vector(8.0),
        turn in any_vector(1.5),
        rates_rad_s in any_vector(4.0),
    ) -> State {
        State { position_m, velocity_m_s, attitude: UnitQuaternion::from_scaled_axis(turn), rates_rad_s }
    }
}

/// The effect's wrench with these parameters, with own states as they start.
pub(super) fn wrench_of(effect: &dyn Effect, at: &Condition, rotors: &Rotors, parameters: &[f64]) -> Wrench {
    let mut states = vec![0.0; effect.state_count(at.airframe)];
    effect.initial_states(at, rotors, &mut states);
    let mut rates = states.clone();
    effect_wrench(effect, at, rotors, &mut Own { parameters, states: &states, rates: &mut rates })
}

pub(super) fn size(wrench: &Wrench) -> f64 {
    wrench.force_n.norm() + wrench.torque_nm.norm()
}

/// A place within the bounds of each parameter.
pub(super) fn within_bounds(effect: &dyn Effect, shares: &[f64]) -> Vec<f64> {
    let size = vehicle().size();
    let within = |(parameter, share): (&Parameter, &f64)| {
        let (least, greatest) = parameter.bounds.at(&size);
        least + share * (greatest - least)
    };
    effect.parameters().iter().zip(shares).map(within).collect()
}

/// Model with these effects, hovering commands, at this state.
pub(super) fn evaluate(effects: Vec<ActiveEffect>, state: &State) -> Wrench {
    let model = Model::new(&vehicle(), effects).unwrap();
    let hover = vehicle().propulsion.command_from_thrust(2.0 * 9.81 / 4.0);
    let input = Input::from_commands(&model.airframe, 0.0, &[hover; 4]);
    let mut states = vec![0.0; model.own_state_count()];
    model.initial_states(state, &input, &mut states);
    let mut rates = states.clone();
    model.evaluate(state, &input, &states, &mut rates).wrench
}

pub(super) fn drifting(velocity_m_s: Vector3<f64>) -> State {
    State { velocity_m_s, ..State::at_rest(Vector3::zeros(), 0.0) }
}
