use super::flight::feedback;
use super::*;
use crate::physics::{RigidBodyModel, State, Wrench};
use crate::recording::{Quantity, StreamKey};
use crate::simulate::{NoiseLevels, SimulateError};
use crate::trajectory::{FourierAxis, FourierTrajectory};
use crate::vehicle::RigidBody;
use nalgebra::{Matrix3, Vector3, Vector4};

/// Table 2 of the paper, period 10 s.
fn table2() -> FourierTrajectory {
    let axis = |a: [f64; 5], b: [f64; 5], c| FourierAxis { a: a.to_vec(), b: b.to_vec(), c };
    FourierTrajectory {
        period_s: 10.0,
        axes: [
            axis(
                [-0.1000, -0.0386, -0.0828, -0.0698, 0.2911],
                [-0.0712, 0.0290, 0.0218, 0.0249, -0.0304],
                -0.0784,
            ),
            axis(
                [-0.0163, 0.0418, -0.0079, 0.0147, -0.0322],
                [0.2112, 0.0830, 0.0954, 0.1418, -0.2462],
                0.4310,
            ),
            axis(
                [-0.0338, -0.1039, 0.2224, -0.0738, -0.0108],
                [0.0833, 0.0414, 0.2020, -0.1457, -0.0379],
                0.9026,
            ),
            axis(
                [0.1959, 0.1709, -0.0586, -0.2600, -0.0483],
                [0.1136, -0.2140, 0.1724, -0.0428, -0.0063],
                0.0830,
            ),
        ],
    }
}

/// Table 3, column FMLS.
fn qball2() -> RigidBodyModel {
    let (xx, xy, xz, yy, yz, zz) = (0.00749, -0.00051, -0.00003, 0.00976, -0.00098, 0.05130);
    let inertia_kg_m2 = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
    let body =
        RigidBody { mass_kg: 1.82245, inertia_kg_m2, center_of_mass_m: Vector3::zeros(), gyroscopic: 1.0 };
    RigidBodyModel::new(&body, 9.81).unwrap()
}

fn at_rest() -> Feedback {
    feedback(&State::at_rest(Vector3::zeros(), 0.0))
}

fn asking(x: f64, y: f64, z: f64, yaw: f64) -> [[f64; 5]; 4] {
    [x, y, z, yaw].map(|value| [value, 0.0, 0.0, 0.0, 0.0])
}

#[test]
fn tracks_table_2_for_50_s_without_saturating() {
    let flight = simulate_pid_flight(&qball2(), &table2(), &PidFlightSettings::default(), None).unwrap();
    assert!(flight.tracking_error_max_m < 0.1, "{} m", flight.tracking_error_max_m);
    assert!(flight.saturated < 0.001, "{}", flight.saturated);
    for quantity in [Quantity::Position, Quantity::Attitude, Quantity::AngularRate, Quantity::Wrench] {
        let stream = &flight.recording.streams[&StreamKey { quantity, source: SOURCE, instance: 0 }];
        assert_eq!(stream.len(), 25_000);
        assert!((stream.time_s[1] - 0.002).abs() < 1e-12);
        assert!(stream.values.iter().all(|value| value.is_finite()));
    }
}

#[test]
fn at_rest_on_the_reference_it_asks_for_the_weight() {
    let settings = PidSettings::default();
    let f = Pid::new(settings).wrench(&asking(0.0, 0.0, 0.0, 0.0), &at_rest(), 0.001);
    assert!((f - Vector4::new(1.79 * 9.81, 0.0, 0.0, 0.0)).norm() < 1e-12);
}

#[test]
fn errors_are_answered_with_the_right_sign() {
    let response =
        |desired: [[f64; 5]; 4]| Pid::new(PidSettings::default()).wrench(&desired, &at_rest(), 0.001);
    // forwards needs the nose down: positive pitch about the left axis
    assert!(response(asking(0.1, 0.0, 0.0, 0.0))[2] > 0.0);
    // to the left needs the left side down: negative roll
    assert!(response(asking(0.0, 0.1, 0.0, 0.0))[1] < 0.0);
    assert!(response(asking(0.0, 0.0, 0.1, 0.0))[0] > 1.79 * 9.81);
    // K_po 2.6 and one period of K_io 0.01 on a yaw error of 0.2
    assert!((response(asking(0.0, 0.0, 0.0, 0.2))[3] - (0.52 + 0.01 * 0.2 * 0.001)).abs() < 1e-12);
    // the short way round
    assert!(response(asking(0.0, 0.0, 0.0, 6.2))[3] < 0.0);
}

#[test]
fn saturates_at_the_printed_bounds() {
    let mut pid = Pid::new(PidSettings::default());
    let f = pid.wrench(&asking(0.0, 0.0, 50.0, 3.0), &at_rest(), 0.001);
    assert_eq!((f[0], f[3]), (34.4, 1.72));
    assert_eq!(pid.wrench(&asking(0.0, 0.0, -50.0, 0.0), &at_rest(), 0.001)[0], 0.0);
}

#[test]
fn the_derivative_filter_is_the_papers() {
    // D(s) on a unit ramp from rest: 1 - exp(-20 t)
    let mut pid = Pid::new(PidSettings::default());
    let mut rate = [0.0; 2];
    for step in 0..=100_u32 {
        rate = pid.tilt_rate([f64::from(step) * 0.001, 0.0], 0.001);
    }
    assert!((rate[0] - (1.0 - (-2.0_f64).exp())).abs() < 0.01, "{rate:?}");
    assert_eq!(rate[1], 0.0);
}

#[test]
fn a_push_is_held_off_by_the_integral_and_seen_in_the_force() {
    let still = FourierTrajectory {
        period_s: 10.0,
        axes: std::array::from_fn(|_| FourierAxis { a: vec![], b: vec![], c: 1.0 }),
    };
    let lift = |_: f64, _: &State| Wrench { force_n: Vector3::z(), torque_nm: Vector3::zeros() };
    let settings = PidFlightSettings { duration_s: 60.0, ..PidFlightSettings::default() };
    let flight = simulate_pid_flight(&qball2(), &still, &settings, Some(&lift)).unwrap();
    let key = StreamKey { quantity: Quantity::Wrench, source: SOURCE, instance: 0 };
    let applied = &flight.recording.streams[&key];
    // one newton of lift is one newton less of thrust
    assert!((applied.sample(applied.len() - 1)[0] - (1.82245 * 9.81 - 1.0)).abs() < 1e-3);
}

#[test]
fn log_noise_is_seeded_and_leaves_the_flight_alone() {
    let fly = |log_noise| {
        let settings = PidFlightSettings { duration_s: 3.0, log_noise, ..PidFlightSettings::default() };
        simulate_pid_flight(&qball2(), &table2(), &settings, None).unwrap()
    };
    let (clean, noisy) = (fly(None), fly(Some((NoiseLevels::default(), 7))));
    assert_eq!(noisy, fly(Some((NoiseLevels::default(), 7))));
    assert_ne!(noisy, fly(Some((NoiseLevels::default(), 8))));
    let key = |quantity| StreamKey { quantity, source: SOURCE, instance: 0 };
    let (a, b) = (&clean.recording.streams, &noisy.recording.streams);
    assert_eq!(a[&key(Quantity::Wrench)], b[&key(Quantity::Wrench)]);
    let difference: Vec<f64> = a[&key(Quantity::Position)]
        .values
        .iter()
        .zip(&b[&key(Quantity::Position)].values)
        .map(|(x, y)| x - y)
        .collect();
    let sd = (difference.iter().map(|d| d * d).sum::<f64>() / difference.len() as f64).sqrt();
    assert!((sd / 0.004 - 1.0).abs() < 0.05, "{sd}");
}

#[test]
fn an_unstable_loop_ends_in_an_error() {
    let gains = PidGains { position: Vector3::repeat(-50.0), ..PidGains::default() };
    let controller = PidSettings { gains, ..PidSettings::default() };
    let settings = PidFlightSettings { controller, ..PidFlightSettings::default() };
    let end = simulate_pid_flight(&qball2(), &table2(), &settings, None);
    assert!(matches!(end, Err(SimulateError::Diverged { .. })));
}

#[test]
fn the_tilt_points_the_thrust_along_the_force() {
    let (force, yaw) = (Vector3::new(1.3, -2.1, 17.0), 0.8);
    let [roll, pitch] = tilt_of_force(&force, yaw);
    let up = crate::frames::Attitude::from_euler(roll, pitch, yaw).0 * Vector3::z();
    assert!((up - force.normalize()).norm() < 1e-12);
}
