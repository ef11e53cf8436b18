use super::commands::Commands;
use super::{PlaybackSettings, playback};
use crate::compare::CompareError;
use crate::physics::effects::{BatterySag, LinearDrag, MotorLag, RotorInertia, TransportDelay};
use crate::physics::{ActiveEffect, MAX_ROTORS, Model};
use crate::signals::{ConditionSettings, Signals, ThrustPreference, ThrustSource, condition};
use crate::simulate::{
    FlightSettings, RandomTrajectory, Reference, TelemetrySettings, Truth, random_vehicle, simulate_flight,
};
use crate::vehicle::Vehicle;

/// A flight of the true vehicle with these effects, conditioned; sensors with this share of their noise.
fn flown(effects: Vec<ActiveEffect>, noise: f64, thrust: ThrustPreference) -> (Vehicle, Signals) {
    let vehicle = random_vehicle(11).truth;
    let trajectory = RandomTrajectory::default().draw(11).unwrap();
    let reference = Reference { trajectory, hover_s: 4.0, ramp_s: 2.0 };
    let telemetry = TelemetrySettings { noise_scale: noise, ..TelemetrySettings::default() };
    let base = FlightSettings { duration_s: 34.0, seed: 3, ..FlightSettings::default() };
    let settings = FlightSettings { telemetry, control_noise_scale: noise, ..base };
    let truth = Truth { vehicle: vehicle.clone(), effects, disturbance: None };
    let flight = simulate_flight(truth, &vehicle, &reference, &settings).unwrap();
    let settings = ConditionSettings { thrust, ..ConditionSettings::default() };
    let signals = condition(&flight.recording, &vehicle, &settings).unwrap();
    (vehicle, signals)
}

fn fit(vehicle: &Vehicle, signals: &Signals, effects: Vec<ActiveEffect>, window_s: f64) -> [f64; 4] {
    let model = Model::new(vehicle, effects).unwrap();
    let settings = PlaybackSettings { window_s, ..PlaybackSettings::default() };
    let fit = playback((&model, vehicle), signals, &settings).unwrap();
    assert!(fit.windows > 20);
    fit.quantities().map(|quantity| quantity.unwrap())
}

fn drag() -> ActiveEffect {
    ActiveEffect::new(&LinearDrag, &[0.3, 0.3, 0.1]).unwrap()
}

#[test]
fn concealed_drag_shows_and_is_mended_by_the_true_effect() {
    let (vehicle, signals) = flown(vec![drag()], 0.1, ThrustPreference::Measured);
    for window_s in [0.1, 0.5, 1.0] {
        let (without, with) =
            (fit(&vehicle, &signals, vec![], window_s), fit(&vehicle, &signals, vec![drag()], window_s));
        assert!(with[1] < 0.75 * without[1], "{window_s} s: velocity {} to {}", without[1], with[1]);
    }
    // errors grow with the window
    let error = |window_s| fit(&vehicle, &signals, vec![], window_s)[1];
    assert!(error(0.1) < error(0.5) && error(0.5) < error(1.0));
}

#[test]
fn concealed_lag_and_delay_show_in_commands_and_not_in_measured_speeds() {
    let late = || {
        vec![
            ActiveEffect::new(&TransportDelay, &[0.02]).unwrap(),
            ActiveEffect::new(&MotorLag, &[0.04]).unwrap(),
        ]
    };
    let (vehicle, signals) = flown(late(), 0.1, ThrustPreference::Commands);
    let (without, with) = (fit(&vehicle, &signals, vec![], 0.5), fit(&vehicle, &signals, late(), 0.5));
    assert!(with[3] < 0.5 * without[3], "rates {} to {}", without[3], with[3]);
    let (vehicle, signals) = flown(late(), 0.1, ThrustPreference::Measured);
    assert_eq!(fit(&vehicle, &signals, vec![], 0.5), fit(&vehicle, &signals, late(), 0.5));
}

#[test]
fn flywheels_show_in_measured_speeds_as_they_spin_up() {
    let flywheels = || vec![ActiveEffect::new(&RotorInertia, &[3e-5]).unwrap()];
    let (vehicle, mut signals) = flown(flywheels(), 0.1, ThrustPreference::Measured);
    let without = fit(&vehicle, &signals, vec![], 0.5)[3];
    let with = fit(&vehicle, &signals, flywheels(), 0.5)[3];
    assert!(with < 0.8 * without, "rates {without} to {with}");
    // thrust that rises by 2 N/s from 1 N on: n = sqrt(T / T_hover), n' = T' / (2 T_hover n)
    let rotors = vehicle.rotors.len();
    for (place, thrust_n) in std::sync::Arc::make_mut(&mut signals.rotor_thrust_n).iter_mut().enumerate() {
        *thrust_n = 1.0 + 2.0 * signals.grid.step_s * (place / rotors) as f64;
    }
    let model = Model::new(&vehicle, vec![]).unwrap();
    let hover_n = model.airframe.hover_thrust_n;
    let at = |signals: &Signals| Commands::of(&model, &vehicle, signals).unwrap().at(100, 0.5);
    let (measured, thrust_n) = (at(&signals), 1.0 + 201.0 * signals.grid.step_s);
    let speed = (thrust_n / hover_n).sqrt();
    assert!((measured.speed_command[0] - speed).abs() < 1e-9);
    assert!((measured.speed_rate_1_s[0] - 2.0 / (2.0 * hover_n * speed)).abs() < 1e-9);
    // commands are no speeds
    signals.quality.thrust_source = ThrustSource::Command;
    assert_eq!(at(&signals).speed_rate_1_s, [0.0; MAX_ROTORS]);
}

#[test]
fn the_recorded_voltage_sags_the_thrust_of_commands_and_not_of_measured_speeds() {
    let sag = || vec![ActiveEffect::new(&BatterySag, &[2.0, 17.0]).unwrap()];
    let (vehicle, signals) = flown(sag(), 0.1, ThrustPreference::Commands);
    // 16.4 V and 10 mV less each second; the log starts with the flight
    let volts = signals.battery_voltage_v.as_ref().unwrap();
    for index in [0, volts.len() / 2, volts.len() - 1] {
        let expected = 16.4 - 0.01 * signals.grid.time_s(index);
        assert!((volts[index] - expected).abs() < 0.02, "{} V, expected {expected} V", volts[index]);
    }
    let (without, with) = (fit(&vehicle, &signals, vec![], 0.5), fit(&vehicle, &signals, sag(), 0.5));
    assert!(with[1] < 0.5 * without[1], "velocity {} to {}", without[1], with[1]);
    let (vehicle, signals) = flown(sag(), 0.1, ThrustPreference::Measured);
    assert_eq!(fit(&vehicle, &signals, vec![], 0.5), fit(&vehicle, &signals, sag(), 0.5));
}

#[test]
fn what_cannot_be_played_back_is_refused() {
    let (vehicle, mut signals) = flown(vec![], 1.0, ThrustPreference::Measured);
    let model = Model::new(&vehicle, vec![]).unwrap();
    let run = |signals: &Signals, window_s| {
        playback((&model, &vehicle), signals, &PlaybackSettings { window_s, ..PlaybackSettings::default() })
    };
    assert!(matches!(run(&signals, 300.0), Err(CompareError::NoWindow { .. })));
    signals.rate = None;
    assert!(matches!(run(&signals, 0.5), Err(CompareError::Missing { what: "body rates", .. })));
}

#[test]
fn a_lag_of_a_fraction_of_a_step_stays_finite() {
    let (vehicle, signals) = flown(vec![], 0.1, ThrustPreference::Commands);
    let lag = || vec![ActiveEffect::new(&MotorLag, &[0.0005]).unwrap()];
    let model = Model::new(&vehicle, lag()).unwrap();
    let settings = PlaybackSettings { step_s: 0.004, ..PlaybackSettings::default() };
    let fit = playback((&model, &vehicle), &signals, &settings).unwrap();
    assert!(fit.quantities().iter().all(|error| error.is_some_and(|error| error < 10.0)), "{fit:?}");
}

/// A log that is too slow to compare torques says nothing of inertia, and what a model makes of its rotation is no prediction.
#[test]
fn without_torques_the_body_turns_as_measured() {
    let (vehicle, mut signals) = flown(vec![drag()], 0.1, ThrustPreference::Commands);
    signals.quality.torques = false;
    let mut heavy = vehicle.clone();
    heavy.body.inertia_kg_m2 *= 3.0;
    let settings = PlaybackSettings::default();
    let played = |vehicle: &Vehicle, effects| {
        let model = Model::new(vehicle, effects).unwrap();
        playback((&model, vehicle), &signals, &settings).unwrap()
    };
    let (one, other) = (played(&vehicle, vec![drag()]), played(&heavy, vec![drag()]));
    assert_eq!((one.attitude_rad, one.rates_rad_s), (None, None));
    let [one, other, without] = [one, other, played(&vehicle, vec![])]
        .map(|fit| (fit.position_m.unwrap(), fit.velocity_m_s.unwrap()));
    assert!((one.1 - other.1).abs() < 1e-3 * one.1, "{one:?} {other:?}");
    assert!(one.1 < 0.7 * without.1, "{one:?} {without:?}");
    let unchanged = super::unchanged_windows(&signals, &settings).unwrap();
    assert!(unchanged.iter().all(|window| window.counts[0] > 0 && window.counts[2..] == [0, 0]));
}

#[test]
fn what_does_not_change_errs_by_the_motion_itself() {
    let (_, signals) = flown(vec![], 0.1, ThrustPreference::Commands);
    let settings = PlaybackSettings::default();
    let windows = super::unchanged_windows(&signals, &settings).unwrap();
    let position = signals.position.as_ref().unwrap();
    let steps = windows[3].counts[0];
    let start =
        (0..signals.grid.count).find(|&n| signals.grid.time_s(n) >= windows[3].start_s - 1e-9).unwrap();
    let moved = (position[start + steps] - position[start]).norm();
    assert!((windows[3].at_end[0] - moved).abs() < 1e-9, "{} m against {moved} m", windows[3].at_end[0]);
    let sum: f64 = (1..=steps).map(|n| (position[start + n] - position[start]).norm_squared()).sum();
    assert!((windows[3].squares[0] - sum).abs() < 1e-9 * sum.max(1.0));
}
