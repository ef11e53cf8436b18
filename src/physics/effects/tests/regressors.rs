//! What each regressor gives: the wrench and its derivative by the parameters.

use nalgebra::Vector3;
use proptest::prelude::*;

use super::fixtures::*;
use crate::physics::effects::ALL;
use crate::physics::{Airframe, Condition, Input, Rotors, State, Wrench};

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
