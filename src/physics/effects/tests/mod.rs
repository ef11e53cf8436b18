mod laws;
mod limits;
mod speed;

use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use proptest::prelude::*;

use super::*;
use crate::physics::{
    ActiveEffect, Airframe, Condition, Hook, Input, MAX_ROTORS, Model, Own, Rotors, State, Wrench,
    effect_wrench,
};
use crate::vehicle::{Actuator, Anchor, Limits, Propulsion, RigidBody, Rotor, Spin, ThrustLaw, Vehicle};

fn vehicle() -> Vehicle {
    let rotor =
        |x: f64, y: f64, spin| Rotor { name: String::new(), position_m: Vector3::new(x, y, 0.02), spin };
    Vehicle {
        name: "test".into(),
        body: RigidBody {
            mass_kg: 2.0,
            inertia_kg_m2: Matrix3::from_diagonal(&Vector3::new(0.02, 0.022, 0.04)),
            center_of_mass_m: Vector3::new(0.003, -0.002, 0.001),
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
        gravity_m_s2: 9.81,
    }
}

prop_compose! {
    fn any_vector(size: f64)(x in -size..size, y in -size..size, z in -size..size) -> Vector3<f64> {
        Vector3::new(x, y, z)
    }
}

prop_compose! {
    fn any_state()(
        position_m in any_vector(5.0),
        velocity_m_s in any_vector(8.0),
        turn in any_vector(1.5),
        rates_rad_s in any_vector(4.0),
    ) -> State {
        State { position_m, velocity_m_s, attitude: UnitQuaternion::from_scaled_axis(turn), rates_rad_s }
    }
}

/// The effect's wrench with these parameters, with own states as they start.
fn wrench_of(effect: &dyn Effect, at: &Condition, rotors: &Rotors, parameters: &[f64]) -> Wrench {
    let mut states = vec![0.0; effect.state_count(at.airframe)];
    effect.initial_states(at, rotors, &mut states);
    let mut rates = states.clone();
    effect_wrench(effect, at, rotors, &mut Own { parameters, states: &states, rates: &mut rates })
}

fn size(wrench: &Wrench) -> f64 {
    wrench.force_n.norm() + wrench.torque_nm.norm()
}

/// A place within the bounds of each parameter.
fn within_bounds(effect: &dyn Effect, shares: &[f64]) -> Vec<f64> {
    effect.parameters().iter().zip(shares).map(|(p, share)| p.min + share * (p.max - p.min)).collect()
}

proptest! {
    #[test]
    fn regressor_times_theta_is_the_wrench(
        state in any_state(),
        wind_m_s in any_vector(5.0),
        commands in prop::collection::vec(0.2..1.0, 4),
        theta in prop::collection::vec(-2.0..2.0, 16),
    ) {
        let vehicle = vehicle();
        let airframe = Airframe::new(&vehicle).unwrap();
        let input = Input::from_commands(&airframe, 1.0, &commands);
        let at = Condition::new(&airframe, &state, &input, wind_m_s);
        let mut rotors = Rotors::as_commanded(&airframe, &input.speed_command);
        rotors.acceleration_1_s = [3.0, -1.0, 2.0, 0.5, 0.0, 0.0, 0.0, 0.0];
        for effect in ALL.iter().filter(|effect| effect.is_linear()) {
            let theta = &theta[..effect.parameters().len()];
            let mut columns = vec![Wrench::zero(); theta.len()];
            effect.regressor(&at, &rotors, theta, &mut columns);
            let sum = columns.iter().zip(theta).fold(Wrench::zero(), |sum, (column, value)| sum + *column * *value);
            prop_assert!(size(&(sum - wrench_of(*effect, &at, &rotors, theta))) < 1e-9, "{}", effect.id());
        }
    }

    #[test]
    fn regressor_is_the_numeric_derivative(
        state in any_state(),
        commands in prop::collection::vec(0.2..1.0, 4),
        shares in prop::collection::vec(0.05..0.95, 3),
    ) {
        let vehicle = vehicle();
        let airframe = Airframe::new(&vehicle).unwrap();
        let input = Input { battery_voltage_v: Some(14.1), ..Input::from_commands(&airframe, 1.0, &commands) };
        let at = Condition::new(&airframe, &state, &input, Vector3::zeros());
        let rotors = Rotors::as_commanded(&airframe, &input.speed_command);
        for effect in ALL.iter().filter(|effect| effect.has_regressor()) {
            let theta = within_bounds(*effect, &shares);
            let mut columns = vec![Wrench::zero(); theta.len()];
            effect.regressor(&at, &rotors, &theta, &mut columns);
            for (index, column) in columns.iter().enumerate() {
                let shifted = |by: f64| {
                    let mut there = theta.clone();
                    there[index] += by;
                    wrench_of(*effect, &at, &rotors, &there)
                };
                let step = 1e-6 * theta[index].abs().max(1e-2);
                let numeric = (shifted(step) - shifted(-step)) * (0.5 / step);
                let allowed = 1e-5 * (1.0 + size(column)) ;
                prop_assert!(size(&(numeric - *column)) < allowed, "{} {index}", effect.id());
            }
        }
    }
}

proptest! {
    /// A simulation calls only the hooks that an effect names; none that does something is left out.
    #[test]
    fn hooks_are_named(
        state in any_state(),
        commands in prop::collection::vec(0.2..1.0, 4),
        shares in prop::collection::vec(0.05..0.95, 3),
    ) {
        let vehicle = vehicle();
        for effect in ALL {
            let theta = within_bounds(*effect, &shares);
            let model = Model::new(&vehicle, vec![ActiveEffect::new(*effect, &theta).unwrap()]).unwrap();
            let bare = Model::new(&vehicle, vec![]).unwrap();
            let from = Input::from_commands(&model.airframe, 1e5, &commands);
            let input = Input { battery_voltage_v: Some(14.1), ..from };
            let at = Condition::new(&model.airframe, &state, &input, Vector3::zeros());
            let rotors = Rotors::as_commanded(&model.airframe, &input.speed_command);
            let mut own = vec![0.0; model.own_state_count()];
            model.initial_states(&state, &input, &mut own);
            let change = model.evaluate(&state, &input, &own, &mut own.clone()).wrench
                - bare.evaluate(&state, &input, &[], &mut []).wrench;
            let alone = wrench_of(*effect, &at, &rotors, &theta);
            prop_assert!(size(&(change - alone)) < 1e-9 * (1.0 + size(&alone)), "{}", effect.id());
            let moves = |hook| effect.hooks().contains(&hook);
            let own = Own { parameters: &theta, states: &[], rates: &mut [] };
            prop_assert!(moves(Hook::Air) || effect.wind_m_s(&input, &own) == Vector3::zeros());
            prop_assert!(moves(Hook::Commands) || effect.command_delay_s(&theta) == 0.0);
            let seen = model.measure(&state, &Wrench::zero());
            prop_assert!(moves(Hook::Sensors) || seen.state == state);
        }
    }
}

#[test]
fn each_parameter_of_a_regressor_moves_something() {
    let vehicle = vehicle();
    let airframe = Airframe::new(&vehicle).unwrap();
    // descending fast under a low ceiling, high enough to stretch a line, after the mass has changed
    let velocity_m_s = Vector3::new(2.0, 1.0, -6.0);
    let rates_rad_s = Vector3::new(0.7, -0.4, 0.3);
    let state = State { velocity_m_s, rates_rad_s, ..State::at_rest(Vector3::new(1.0, 0.5, 0.2), 0.3) };
    let commands = [0.5, 0.6, 0.7, 0.8];
    let input = Input { battery_voltage_v: Some(14.1), ..Input::from_commands(&airframe, 1e5, &commands) };
    let at = Condition::new(&airframe, &state, &input, Vector3::zeros());
    let rotors = Rotors::as_commanded(&airframe, &input.speed_command);
    for effect in ALL.iter().filter(|effect| effect.has_regressor()) {
        let theta = within_bounds(*effect, &[0.3, 0.3, 0.0]);
        let mut columns = vec![Wrench::zero(); theta.len()];
        effect.regressor(&at, &rotors, &theta, &mut columns);
        for (parameter, column) in effect.parameters().iter().zip(columns) {
            // a rotor's number and a moment have no slope; thrust is along z; beyond z alone nothing turns
            let none = matches!(
                (effect.id(), parameter.name),
                ("weak_rotor", "rotor") | ("mass_change", "time") | ("com_offset", "z")
            );
            assert_eq!(size(&column) > 0.0, !none, "{} {}", effect.id(), parameter.name);
        }
    }
}

#[test]
fn identifiers_are_unique_and_bounds_in_order() {
    for (index, effect) in ALL.iter().enumerate() {
        assert_eq!(by_id(effect.id()).unwrap().sentence(), effect.sentence());
        assert!(ALL.iter().skip(index + 1).all(|other| other.id() != effect.id()));
        assert!(effect.parameters().iter().all(|p| p.min < p.max && !p.unit.is_empty()));
    }
    assert!(by_id("no_such_effect").is_none());
}

#[test]
fn wrong_parameter_counts_are_refused() {
    assert!(ActiveEffect::new(&LinearDrag, &[0.1]).is_err());
    assert!(ActiveEffect::new(&MotorLag, &[0.1]).is_ok());
}

#[test]
fn effects_are_made_by_name_within_their_bounds() {
    let drag = ActiveEffect::named("linear_drag", &[("dy", 0.2), ("dx", 0.1), ("dz", 0.0)]).unwrap();
    assert_eq!(drag.parameters(), [0.1, 0.2, 0.0]);
    for (id, values) in [
        ("no_such", vec![]),
        ("inflow", vec![]),
        ("inflow", vec![("kz", -1.0)]),
        ("inflow", vec![("kz", f64::NAN)]),
        ("inflow", vec![("kz", 0.1), ("k", 0.1)]),
    ] {
        assert!(ActiveEffect::named(id, &values).is_err(), "{id} {values:?}");
    }
}

#[test]
fn an_effect_that_the_description_does_not_carry_is_refused() {
    let mut bare = vehicle();
    bare.propulsion.rotor_radius_m = None;
    let ground = ActiveEffect::new(&GroundEffect, &[1.0, 0.0, 1.0]).unwrap();
    let refused = Model::new(&bare, vec![ground]).unwrap_err();
    assert!(refused.to_string().contains("rotor_radius"), "{refused}");
}

/// Model with these effects, hovering commands, at this state.
fn evaluate(effects: Vec<ActiveEffect>, state: &State) -> Wrench {
    let model = Model::new(&vehicle(), effects).unwrap();
    let hover = vehicle().propulsion.command_from_thrust(2.0 * 9.81 / 4.0);
    let input = Input::from_commands(&model.airframe, 0.0, &[hover; 4]);
    let mut states = vec![0.0; model.own_state_count()];
    model.initial_states(state, &input, &mut states);
    let mut rates = states.clone();
    model.evaluate(state, &input, &states, &mut rates).wrench
}

fn drifting(velocity_m_s: Vector3<f64>) -> State {
    State { velocity_m_s, ..State::at_rest(Vector3::zeros(), 0.0) }
}

#[test]
fn hover_drag_is_its_coefficient_times_speed_and_acts_at_the_hubs() {
    let drag = || vec![ActiveEffect::new(&LinearDrag, &[0.4, 0.3, 0.0]).unwrap()];
    let state = drifting(Vector3::new(2.0, 0.0, 0.0));
    let change = evaluate(drag(), &state) - evaluate(vec![], &state);
    assert!((change.force_n - Vector3::new(-0.8, 0.0, 0.0)).norm() < 1e-9);
    // hubs are 19 mm above the centre of mass: -0.8 N there pitches the nose up, negative about y;
    // and 2 mm to the left of it on average, which yaws: -r_y F_x = 0.0016
    assert!((change.torque_nm - Vector3::new(0.0, -0.0152, 0.0016)).norm() < 1e-9);
}

#[test]
fn wind_acts_through_drag_alone() {
    let wind = || ActiveEffect::new(&SteadyWind, &[3.0, -1.0, 0.0]).unwrap();
    let drag = || ActiveEffect::new(&LinearDrag, &[0.4, 0.3, 0.1]).unwrap();
    let still = drifting(Vector3::zeros());
    assert_eq!(evaluate(vec![wind()], &still), evaluate(vec![], &still));
    let blown = evaluate(vec![drag(), wind()], &still);
    assert!((blown.force_n.x - 1.2).abs() < 1e-9 && (blown.force_n.y + 0.3).abs() < 1e-9);
    // drifting with the wind there is no drag
    let carried = drifting(Vector3::new(3.0, -1.0, 0.0));
    let change = evaluate(vec![drag(), wind()], &carried) - evaluate(vec![], &carried);
    assert!(change.force_n.norm() < 1e-12);
}

#[test]
fn damping_opposes_the_rates() {
    let state = State { rates_rad_s: Vector3::new(1.0, -2.0, 0.5), ..drifting(Vector3::zeros()) };
    let damping = ActiveEffect::new(&AngularDamping, &[0.01, 0.02, 0.03]).unwrap();
    let change = evaluate(vec![damping], &state) - evaluate(vec![], &state);
    assert!((change.torque_nm - Vector3::new(-0.01, 0.04, -0.015)).norm() < 1e-12);
    assert!(change.force_n.norm() < 1e-12);
}

#[test]
fn lagging_rotors_keep_their_speed_and_head_for_the_command() {
    let vehicle = vehicle();
    let airframe = Airframe::new(&vehicle).unwrap();
    let state = drifting(Vector3::zeros());
    let input = Input { speed_command: [1.5; MAX_ROTORS], ..Input::from_commands(&airframe, 0.0, &[]) };
    let at = Condition::new(&airframe, &state, &input, Vector3::zeros());
    let rotors = Rotors::as_commanded(&airframe, &input.speed_command);
    let mut rates = [0.0; 4];
    let mut own = Own { parameters: &[0.05], states: &[1.0; 4], rates: &mut rates };
    let change = effect_wrench(&MotorLag, &at, &rotors, &mut own);
    // still at hover thrust: 19.62 instead of 1.5^2 times that
    assert!((change.force_n.z - 19.62 * (1.0 - 2.25)).abs() < 1e-9);
    assert!(rates.iter().all(|rate| (rate - 10.0).abs() < 1e-9));
}
