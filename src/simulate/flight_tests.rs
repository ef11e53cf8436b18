//! Tests of the simulated flight.

use super::*;
use crate::physics::effects::LinearDrag;
use crate::recording::{Quantity, Stream, StreamKey};
use crate::simulate::{RandomTrajectory, random_vehicle};
use crate::stats::white_level_of;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};

fn reference(seed: u64) -> Reference {
    let trajectory = RandomTrajectory::default().draw(seed).unwrap();
    Reference { trajectory, hover_s: 4.0, ramp_s: 2.0 }
}

fn fly(seed: u64, settings: &FlightSettings) -> SimulatedFlight {
    let pair = random_vehicle(seed);
    simulate_flight(Truth::clean(pair.truth), &pair.nominal, &reference(seed), settings).unwrap()
}

fn quiet(duration_s: f64) -> FlightSettings {
    let telemetry = TelemetrySettings { noise_scale: 0.0, loss: 0.0, ..TelemetrySettings::default() };
    FlightSettings { duration_s, control_noise_scale: 0.0, telemetry, ..FlightSettings::default() }
}

fn stream<'a>(flight: &'a SimulatedFlight, quantity: Quantity, source: &'static str) -> &'a Stream {
    &flight.recording.streams[&StreamKey { quantity, source, instance: 0 }]
}

fn column(stream: &Stream, column: usize) -> Vec<f64> {
    (0..stream.len()).map(|sample| stream.sample(sample)[column]).collect()
}

#[test]
fn default_flights_track_without_crashing() {
    for seed in 0..12 {
        let flight = fly(seed, &FlightSettings { seed, ..FlightSettings::default() });
        assert!(flight.tracking_error_max_m < 0.5, "seed {seed}: {} m", flight.tracking_error_max_m);
        assert!(flight.saturated < 0.02, "seed {seed}: {}", flight.saturated);
    }
}

#[test]
fn telemetry_has_the_rates_and_noise_of_the_settings() {
    let flight = fly(1, &FlightSettings::default());
    let imu = stream(&flight, Quantity::SpecificForce, "HIGHRES_IMU");
    let expected = 54.0 * 125.0;
    assert!((imu.len() as f64 / expected - 0.996).abs() < 0.004, "{} samples", imu.len());
    for (quantity, source, level) in [
        (Quantity::SpecificForce, "HIGHRES_IMU", 0.12),
        (Quantity::AngularRate, "HIGHRES_IMU", 6e-3),
        (Quantity::AngularRate, "ATTITUDE_QUATERNION", 6e-3),
        (Quantity::Position, "LOCAL_POSITION_NED", 4e-3),
        (Quantity::Velocity, "LOCAL_POSITION_NED", 15e-3),
    ] {
        for axis in 0..3 {
            let found = white_level_of(&column(stream(&flight, quantity, source), axis));
            // the body's own jitter adds to the gyros and the vertical accelerometer
            assert!(found > 0.9 * level && found < 1.35 * level, "{quantity:?} {axis}: {found}");
        }
    }
    let attitude = stream(&flight, Quantity::Attitude, "ATTITUDE_QUATERNION");
    let found = 2.0 * white_level_of(&column(attitude, 3));
    assert!((found / 1.7e-3 - 1.0).abs() < 0.1, "attitude {found}");
    assert!(attitude.time_s.windows(2).all(|pair| pair[1] > pair[0]));
    assert_eq!(attitude.time_s[0], 0.0);
}

#[test]
fn commands_jitter_as_accelerations_do_in_the_practice_recordings() {
    // from the practice recordings: collective .10 m/s^2, roll and pitch 1.5, yaw .32 rad/s^2
    let pair = random_vehicle(1);
    let flight = fly(1, &FlightSettings::default());
    let commands = stream(&flight, Quantity::ActuatorCommand, "ACTUATOR_OUTPUT_STATUS");
    let mut patterns = [Vec::new(), Vec::new(), Vec::new(), Vec::new()];
    for sample in 0..commands.len() {
        let thrusts: Vec<f64> =
            commands.sample(sample).iter().map(|u| pair.truth.propulsion.thrust_from_command_n(*u)).collect();
        let wrench = pair.nominal.mixer().wrench(&thrusts);
        let body = &pair.nominal.body;
        patterns[0].push(wrench[0] / body.mass_kg);
        for axis in 0..3 {
            patterns[axis + 1].push(wrench[axis + 1] / body.inertia_kg_m2[(axis, axis)]);
        }
    }
    for (pattern, level) in patterns.iter().zip([0.10, 1.5, 1.5, 0.32]) {
        let found = white_level_of(pattern);
        assert!((found / level - 1.0).abs() < 0.35, "found {found}, expected {level}");
    }
    let jitter = white_level_of(&column(commands, 0));
    assert!((0.003..0.028).contains(&jitter), "one motor {jitter}");
}

#[test]
fn same_seed_same_flight_and_telemetry_does_not_disturb_it() {
    let settings = FlightSettings { duration_s: 8.0, ..FlightSettings::default() };
    assert_eq!(fly(3, &settings).recording, fly(3, &settings).recording);
    let mut louder = settings;
    louder.telemetry.noise_scale = 3.0;
    louder.telemetry.rates.attitude_hz = 50.0;
    let source = "POSITION_TARGET_LOCAL_NED";
    let (a, b) = (fly(3, &settings), fly(3, &louder));
    assert_eq!(a.tracking_error_max_m, b.tracking_error_max_m);
    assert!(stream(&b, Quantity::PositionSetpoint, source).len() > 190);
    assert_ne!(fly(3, &FlightSettings { seed: 1, ..settings }).recording, a.recording);
}

#[test]
fn quiet_hover_feels_gravity_and_commands_the_weight() {
    let pair = random_vehicle(5);
    let flight =
        simulate_flight(Truth::clean(pair.truth.clone()), &pair.truth, &reference(5), &quiet(3.9)).unwrap();
    let imu = stream(&flight, Quantity::SpecificForce, "HIGHRES_IMU");
    let commands = stream(&flight, Quantity::ActuatorCommand, "ACTUATOR_OUTPUT_STATUS");
    for sample in 0..imu.len() {
        let force = imu.sample(sample);
        assert!(force[0].abs() < 1e-9 && force[1].abs() < 1e-9 && (force[2] - 9.81).abs() < 1e-9);
        let thrusts: Vec<f64> =
            commands.sample(sample).iter().map(|u| pair.truth.propulsion.thrust_from_command_n(*u)).collect();
        let wrench = pair.truth.mixer().wrench(&thrusts);
        assert!((wrench[0] - pair.truth.body.mass_kg * 9.81).abs() < 1e-9);
        assert!(wrench.rows(1, 3).norm() < 1e-9);
    }
}

#[test]
fn quiet_streams_obey_kinematics_and_newton() {
    let pair = random_vehicle(6);
    let flight =
        simulate_flight(Truth::clean(pair.truth), &pair.nominal, &reference(6), &quiet(20.0)).unwrap();
    let velocity = stream(&flight, Quantity::Velocity, "LOCAL_POSITION_NED");
    let position = stream(&flight, Quantity::Position, "LOCAL_POSITION_NED");
    let attitude = stream(&flight, Quantity::Attitude, "ATTITUDE_QUATERNION");
    let imu = stream(&flight, Quantity::SpecificForce, "HIGHRES_IMU");
    // every 40 ms all three rates coincide
    for k in 100..450 {
        let (slow, fast) = (2 * k, 5 * k);
        let rate = (position.sample(slow + 1)[0] - position.sample(slow - 1)[0]) / 0.04;
        assert!((rate - velocity.sample(slow)[0]).abs() < 0.01);
        let q = attitude.sample(fast);
        let attitude = UnitQuaternion::from_quaternion(Quaternion::new(q[0], q[1], q[2], q[3]));
        let world = attitude * Vector3::from_column_slice(imu.sample(fast)) - Vector3::z() * 9.81;
        let numeric = (Vector3::from_column_slice(velocity.sample(slow + 1))
            - Vector3::from_column_slice(velocity.sample(slow - 1)))
            / 0.04;
        assert!((world - numeric).norm() < 0.08, "{world} {numeric}");
    }
}

#[test]
fn drag_is_felt_by_the_accelerometer_against_the_motion() {
    let pair = random_vehicle(2);
    let mass_kg = pair.truth.body.mass_kg;
    let drag = ActiveEffect::new(&LinearDrag, &[0.2, 0.2, 0.0]).unwrap();
    let truth = Truth { effects: vec![drag], ..Truth::clean(pair.truth) };
    let flight = simulate_flight(truth, &pair.nominal, &reference(2), &quiet(24.0)).unwrap();
    let velocity = stream(&flight, Quantity::Velocity, "LOCAL_POSITION_NED");
    let attitude = stream(&flight, Quantity::Attitude, "ATTITUDE_QUATERNION");
    let imu = stream(&flight, Quantity::SpecificForce, "HIGHRES_IMU");
    let (mut along, mut square) = (0.0, 0.0);
    for k in 150..550 {
        let q = attitude.sample(5 * k);
        let attitude = UnitQuaternion::from_quaternion(Quaternion::new(q[0], q[1], q[2], q[3]));
        let v = attitude.inverse_transform_vector(&Vector3::from_column_slice(velocity.sample(2 * k)));
        along += imu.sample(5 * k)[0] * v.x;
        square += v.x * v.x;
    }
    let found = -along / square * mass_kg;
    assert!((found / 0.2 - 1.0).abs() < 0.05, "drag {found} N/(m/s)");
}

#[test]
fn skew_shifts_stamps_and_a_clock_offset_is_floored_away_in_milliseconds() {
    let mut settings = quiet(2.0);
    settings.telemetry.skew.position_s = 0.005;
    settings.telemetry.clock_offset_s = 41.000_7;
    let flight = fly(4, &settings);
    let position = stream(&flight, Quantity::Position, "LOCAL_POSITION_NED");
    let imu = stream(&flight, Quantity::SpecificForce, "HIGHRES_IMU");
    let attitude = stream(&flight, Quantity::Attitude, "ATTITUDE_QUATERNION");
    assert!((position.time_s[3] - attitude.time_s[0] - 0.065).abs() < 1e-9);
    assert!((imu.time_s[0] - attitude.time_s[0] - 0.000_7).abs() < 1e-9);
}

#[test]
fn a_transport_delay_and_a_lag_both_postpone_the_rotors() {
    let lateness = |settings: &FlightSettings| {
        let flight = fly(7, settings);
        let commands = column(stream(&flight, Quantity::ActuatorCommand, "ACTUATOR_OUTPUT_STATUS"), 0);
        let speeds = column(stream(&flight, Quantity::RotorSpeed, "ESC_STATUS"), 0);
        let speed_max = speeds.iter().zip(commands.iter().step_by(2)).map(|(s, u)| s / u).sum::<f64>()
            / speeds.len() as f64;
        // least squares of (command - speed) on the command's rate
        let (mut along, mut square) = (0.0, 0.0);
        for k in 300..speeds.len() - 1 {
            let rate = (commands[2 * k + 1] - commands[2 * k - 1]) / 0.016;
            along += (commands[2 * k] - speeds[k] / speed_max) * rate;
            square += rate * rate;
        }
        along / square
    };
    let smooth = FlightSettings { seed: 7, ..quiet(30.0) };
    let late = lateness(&FlightSettings { transport_delay_s: 0.02, ..smooth }) - lateness(&smooth);
    assert!((late - 0.02).abs() < 0.003, "delay {late} s");
    let slow = FlightSettings { motor_time_constant_s: 0.024, ..smooth };
    let late = lateness(&slow) - lateness(&smooth);
    assert!((late - 0.02).abs() < 0.003, "lag {late} s");
}

#[test]
fn shared_noise_makes_the_log_what_the_controller_flew_on() {
    let mut settings = FlightSettings { duration_s: 20.0, ..FlightSettings::default() };
    let correlation = |settings: &FlightSettings| {
        let flight = fly(8, settings);
        let pair = random_vehicle(8);
        let commands = stream(&flight, Quantity::ActuatorCommand, "ACTUATOR_OUTPUT_STATUS");
        let rates = stream(&flight, Quantity::AngularRate, "ATTITUDE_QUATERNION");
        let (mut xy, mut xx, mut yy) = (0.0, 0.0, 0.0);
        for k in 1..2000 {
            let yaw = |k: usize| {
                let t: Vec<f64> = commands
                    .sample(k)
                    .iter()
                    .map(|u| pair.truth.propulsion.thrust_from_command_n(*u))
                    .collect();
                pair.truth.mixer().wrench(&t)[3]
            };
            let (x, y) = (rates.sample(k)[2] - rates.sample(k - 1)[2], yaw(k) - yaw(k - 1));
            (xy, xx, yy) = (xy + x * y, xx + x * x, yy + y * y);
        }
        xy / (xx * yy).sqrt()
    };
    settings.telemetry.loss = 0.0;
    assert!(correlation(&settings).abs() < 0.2);
    settings.telemetry.share_controller_noise = true;
    assert!(correlation(&settings) < -0.4);
}

#[test]
fn halving_the_step_changes_nothing_that_matters() {
    // no noise: the same flight; the reference is the finer one
    let pair = random_vehicle(9);
    let run = |step_s| {
        let settings = FlightSettings { step_s, ..quiet(14.0) };
        simulate_flight(Truth::clean(pair.truth.clone()), &pair.nominal, &reference(9), &settings).unwrap()
    };
    let (coarse, fine) = (run(0.002), run(0.001));
    let (a, b) = (
        stream(&coarse, Quantity::Position, "LOCAL_POSITION_NED"),
        stream(&fine, Quantity::Position, "LOCAL_POSITION_NED"),
    );
    let worst = a.values.iter().zip(&b.values).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max);
    assert!(worst < 1e-4, "{worst} m");
}

#[test]
fn bad_settings_are_refused() {
    let pair = random_vehicle(0);
    let run = |settings: FlightSettings, vehicle: Vehicle| {
        simulate_flight(Truth::clean(vehicle), &pair.nominal, &reference(0), &settings).map(|_| ())
    };
    let base = FlightSettings { duration_s: 0.1, ..FlightSettings::default() };
    for settings in [
        FlightSettings { step_s: 0.0, ..base },
        FlightSettings { step_s: f64::NAN, ..base },
        FlightSettings { duration_s: f64::INFINITY, ..base },
        FlightSettings { duration_s: -1.0, ..base },
        FlightSettings { control_noise_scale: -1.0, ..base },
        FlightSettings { telemetry: TelemetrySettings { loss: 1.5, ..base.telemetry }, ..base },
    ] {
        assert!(matches!(run(settings, pair.truth.clone()), Err(SimulateError::Setting { .. })));
    }
    let mut two = pair.truth.clone();
    two.rotors.truncate(2);
    assert!(run(base, two).is_ok(), "what flies may have any rotors");
    let mut none = pair.truth.clone();
    none.rotors.clear();
    assert!(run(base, none).is_err());
}
