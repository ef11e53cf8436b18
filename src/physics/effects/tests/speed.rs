//! What acts between command and rotor speed, and what is left of it where the speed is measured.

use nalgebra::Vector3;

use super::fixtures::*;
use crate::physics::effects::*;
use crate::physics::{
    ActiveEffect, Airframe, Condition, Effect, Input, MAX_ROTORS, Model, Own, Rotors, effect_wrench,
};
use crate::vehicle::Propulsion;

/// Thrust at hover of the test vehicle, N.
const WEIGHT_N: f64 = 19.62;

#[test]
fn rotors_speed_up_and_slow_down_with_their_own_time_constants() {
    let airframe = Airframe::new(&vehicle()).unwrap();
    let state = drifting(Vector3::zeros());
    let input = Input::from_commands(&airframe, 0.0, &[]);
    let at = Condition::new(&airframe, &state, &input, Vector3::zeros());
    let rates = |parameters: &[f64]| {
        let mut rates = [0.0; 4];
        let mut rotors = Rotors::as_commanded(&airframe, &[1.5, 1.0, 0.5, 0.9, 0.0, 0.0, 0.0, 0.0]);
        let mut own = Own { parameters, states: &[1.0, 1.0, 1.0, 1.0], rates: &mut rates };
        MotorLag.rotor_speed(&at, &mut own, &mut rotors);
        assert_eq!(rotors.speed[..4], [1.0; 4]);
        assert_eq!(rotors.acceleration_1_s[..4], rates);
        rates
    };
    let close = |a: [f64; 4], b: [f64; 4]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12);
    // 0.5 ahead over 0.0125 s is 40 1/s up; 0.5 behind over 0.025 s is 20 1/s down
    assert!(close(rates(&[0.0125, 0.025]), [40.0, 0.0, -20.0, -4.0]));
    assert!(close(rates(&[0.0125]), [40.0, 0.0, -40.0, -8.0]));
    assert!(close(rates(&[0.0125, 0.0125]), rates(&[0.0125])));
    // no rotor is faster than a tenth of a millisecond
    assert!(close(rates(&[0.0, 0.0]), [250.0, 0.0, -250.0, -50.0]));
}

#[test]
fn a_finer_form_is_given_from_its_first_value_on() {
    let lag = |values: &[(&str, f64)]| ActiveEffect::named("motor_lag", values, &vehicle().size());
    assert_eq!(lag(&[("time_constant", 0.02)]).unwrap().parameters(), [0.02]);
    let both = lag(&[("time_constant_down", 0.04), ("time_constant", 0.02)]).unwrap();
    assert_eq!(both.parameters(), [0.02, 0.04]);
    for values in [
        vec![("time_constant_down", 0.04)],
        vec![("time_constant", 0.02), ("time_constant_down", 0.6)],
        vec![("time_constant", 0.02), ("time_constant_down", 0.0)],
        vec![("time_constant", 0.02), ("time_constant_up", 0.02)],
    ] {
        assert!(lag(&values).is_err(), "{values:?}");
    }
    assert!(ActiveEffect::new(&MotorLag, &[0.02, 0.04, 0.06]).is_err());
    assert!(ActiveEffect::new(&LinearDrag, &[0.1, 0.1, 0.1, 0.1, 0.1]).is_ok());
    assert!(ActiveEffect::new(&LinearDrag, &[0.1, 0.1, 0.1, 0.1, 0.1, 0.1]).is_err());
}

#[test]
fn a_stated_time_constant_is_the_lag() {
    let stated = |time_constant_s, time_constant_down_s| {
        let propulsion = Propulsion { time_constant_s, time_constant_down_s, ..vehicle().propulsion };
        ActiveEffect::stated_rotor_lag(&propulsion).map(|lag| lag.parameters().to_vec())
    };
    assert_eq!(stated(None, None), None);
    assert_eq!(stated(Some(0.0), None), None);
    assert_eq!(stated(Some(0.02), None), Some(vec![0.02]));
    assert_eq!(stated(Some(0.02), Some(0.03)), Some(vec![0.02, 0.03]));
}

#[test]
fn what_acts_before_the_speed_is_gone_where_the_speed_is_measured() {
    let before: Vec<_> = ALL.iter().filter(|effect| effect.is_before_speed()).map(|e| e.id()).collect();
    assert_eq!(before, ["motor_lag", "transport_delay", "battery_sag"]);
    let middle = |effect: &'static dyn Effect| {
        ActiveEffect::new(effect, &within_bounds(effect, &[0.5, 0.5, 0.5])).unwrap()
    };
    let all = Model::new(&vehicle(), ALL.iter().map(|effect| middle(*effect)).collect()).unwrap();
    let left = all.with_measured_speeds();
    assert_eq!(left.effects().len(), ALL.len() - 3);
    assert_eq!(left.own_state_count(), all.own_state_count() - 4);
    assert_eq!(left.command_delay_s(), 0.0);
}

#[test]
fn a_sagging_battery_slows_the_rotors_before_they_lag() {
    let sag = ActiveEffect::new(&BatterySag, &[2.0, 16.0]).unwrap();
    let lag = ActiveEffect::new(&MotorLag, &[0.05]).unwrap();
    for effects in [vec![sag.clone(), lag.clone()], vec![lag, sag]] {
        let model = Model::new(&vehicle(), effects).unwrap();
        let hover =
            Input { speed_command: [1.0; MAX_ROTORS], ..Input::from_commands(&model.airframe, 0.0, &[]) };
        let input = Input { battery_voltage_v: Some(14.4), ..hover };
        let state = drifting(Vector3::zeros());
        let (mut states, mut rates) = ([0.0; 4], [1.0; 4]);
        model.initial_states(&state, &input, &mut states);
        let now = model.evaluate(&state, &input, &states, &mut rates);
        // 0.9 of the speed, 0.81 of the thrust, from the start on
        assert!(now.rotors.speed[..4].iter().all(|speed| (speed - 0.9).abs() < 1e-12));
        assert!((now.wrench.force_n.z - 0.81 * WEIGHT_N).abs() < 1e-9);
        assert!(rates.iter().all(|rate| rate.abs() < 1e-12));
    }
}

#[test]
fn measured_rotors_spin_up_as_measured() {
    let model = |effects| Model::new(&vehicle(), effects).unwrap();
    let inertia = ActiveEffect::new(&RotorInertia, &[1e-4]).unwrap();
    let plain = model(vec![inertia.clone()]);
    let hover_rad_s = plain.airframe.hover_speed_rad_s.unwrap();
    let mut input =
        Input { speed_command: [1.0; MAX_ROTORS], ..Input::from_commands(&plain.airframe, 0.0, &[]) };
    // the second rotor, ccw, spins up about +z by 3 n/s: -jr Omega' about z
    input.speed_rate_1_s[1] = 3.0;
    let state = drifting(Vector3::zeros());
    let torque = |model: &Model, states: &[f64]| {
        model.evaluate(&state, &input, states, &mut vec![0.0; states.len()]).wrench.torque_nm.z
    };
    let expected = -1e-4 * 3.0 * hover_rad_s;
    assert!((torque(&plain, &[]) - torque(&model(vec![]), &[]) - expected).abs() < 1e-12);
    // a lag has its own rate of change
    let lagging = model(vec![inertia, ActiveEffect::new(&MotorLag, &[0.05]).unwrap()]);
    assert!((torque(&lagging, &[1.0; 4]) - torque(&model(vec![]), &[])).abs() < 1e-12);
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
