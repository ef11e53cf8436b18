//! Tests of the rows of the weak form.

use super::*;
use crate::diagnose::channels::SECOND;
use crate::recording::Quantity;
use crate::signals::{
    AsRecorded, Grid, OwnOfFlight, Quality, Series, Signals, ThrustSource, TorqueError, Usable,
    VelocityHeldBy,
};
use crate::simulate::random_vehicle;
use crate::vehicle::{RigidBody, Rotor, Spin, Vehicle};
use nalgebra::{Matrix3, UnitQuaternion, Vector4};

/// Rows that no flight made, 0.05 s apart.
pub(in super::super) fn rows_of(
    runs: Vec<Range<usize>>,
    residual: Channels,
    nuisances: Vec<NuisanceColumn>,
    effects: Vec<Channels>,
) -> Rows {
    let time_s = (0..residual[0].len()).map(|row| 0.05 * row as f64).collect();
    let measured = std::array::from_fn(|_| runs.clone());
    Rows {
        time_s,
        runs,
        measured,
        residual,
        nuisances,
        effects,
        compares_torques: true,
        torque_error: TorqueError::default(),
        torque_rms: [1.0; 3],
        flights: Vec::new(),
        known_motion: None,
    }
}

const STEP_S: f64 = 0.01;
const RATE_RAD_S: [f64; 3] = [0.8, -0.5, 1.1];
const FELT_M_S2: [f64; 3] = [0.3, -0.2, 11.0];
const THRUSTS_N: [f64; 4] = [4.0, 5.0, 6.0, 3.5];

/// 1.6 kg, with products of inertia, on hubs at 0.2 m and 0.15 m.
pub(in super::super) fn vehicle() -> Vehicle {
    let inertia_kg_m2 = Matrix3::new(0.02, 0.001, -0.002, 0.001, 0.03, 0.0015, -0.002, 0.0015, 0.045);
    let hubs =
        [(0.2, 0.15, Spin::Cw), (0.2, -0.15, Spin::Ccw), (-0.2, -0.15, Spin::Cw), (-0.2, 0.15, Spin::Ccw)];
    let rotor = |(x, y, spin)| Rotor { name: String::new(), position_m: Vector3::new(x, y, 0.0), spin };
    let mut vehicle = random_vehicle(1).nominal;
    vehicle.body =
        RigidBody { mass_kg: 1.6, inertia_kg_m2, center_of_mass_m: Vector3::zeros(), gyroscopic: 1.0 };
    vehicle.rotors = hubs.map(rotor).to_vec();
    vehicle.propulsion.torque_per_thrust_m = 0.02;
    vehicle.gravity_m_s2 = 9.81;
    vehicle
}

/// 5 s at a constant rate on the spot, with constant thrusts and a constant reading of the accelerometer.
pub(in super::super) fn turning_on_the_spot() -> Signals {
    let count = 500;
    let rate = Vector3::from(RATE_RAD_S);
    let turned = |i: usize| UnitQuaternion::from_scaled_axis(rate * (STEP_S * i as f64));
    Signals {
        grid: Grid { start_s: 0.0, step_s: STEP_S, count },
        usable: vec![true; count],
        attitude: Some(Series::new((0..count).map(turned).collect())),
        rate: Some(vec![rate; count].into()),
        specific_force: Some(vec![Vector3::from(FELT_M_S2); count].into()),
        world_acceleration: None,
        position: None,
        velocity: Some(vec![Vector3::zeros(); count].into()),
        rotor_thrust_n: THRUSTS_N.repeat(count).into(),
        full_thrust_n: vehicle().propulsion.full_thrust_n(),
        wrench: vec![Vector4::zeros(); count].into(),
        jitter_wrench: None,
        battery_voltage_v: None,
        as_recorded: AsRecorded::default(),
        reference: None,
        own: OwnOfFlight::default(),
        air_m_s: Vector3::zeros(),
        quality: Quality {
            sources: vec![(Quantity::ActuatorCommand, "by hand", 1.0 / STEP_S)],
            thrust_source: ThrustSource::Command,
            offsets: Vec::new(),
            airborne_s: Vec::new(),
            usable: Usable::default(),
            torques: true,
            gyro_noise_rad_s: None,
            velocity_held_by: VelocityHeldBy::default(),
            position_by_receiver: false,
            steady_voltage_v: None,
            torque_error: TorqueError::default(),
            simulated: false,
            notes: Vec::new(),
        },
    }
}

/// By hand: the thrusts make 18.5 N and (0.15 (4 - 5 - 6 + 3.5), -0.2 (4 + 5 - 6 - 3.5), 0.02 (4 - 5 + 6 - 3.5)) N m; a
/// constant rate w takes `w x J w`, which is (-0.00977, -0.02309, -0.00339) N m (NumPy: `numpy.cross(w, J @ w)`). On the
/// spot the kinematics show gravity alone, which turns about w: its part along w is constant, that across it is lowered
/// by the test function to `gamma(5.5) (2 / x)^4.5 J_4.5(x)` for x the angle turned in half its width (SciPy:
/// `gamma(5.5) * (2 / x) ** 4.5 * jv(4.5, x)` at x = 0.21 sqrt(2.1)).
#[test]
fn rows_of_a_body_that_turns_at_a_constant_rate_are_known() {
    let vehicle = vehicle();
    let trace = Trace::new(&turning_on_the_spot(), &vehicle, 0.2).unwrap();
    assert_eq!(trace.kernel.half_count, 20);
    let rows = Rows::new(std::slice::from_ref(&trace), &Base::rigid(&vehicle)).unwrap();
    assert!(rows.len() > 80);
    let first = [0.48, -0.32, 17.6 - 18.5, 0.515_23, -0.123_09, -0.033_39];
    let (rate, lowered) = (Vector3::from(RATE_RAD_S), 0.995_797_943_874_802_5);
    let axis = rate.normalize();
    let along = axis * axis.z;
    let across = Vector3::z() - along;
    for row in 0..rows.len() {
        for (channel, expected) in first.iter().enumerate() {
            let found = rows.residual[channel][row];
            assert!((found - expected).abs() < 1e-9, "channel {channel}: {found}, not {expected}");
        }
        let (s, c) = (rate.norm() * rows.time_s[row]).sin_cos();
        let up = along + lowered * (across * c - axis.cross(&across) * s);
        let expected = 1.6 * 9.81 * up - Vector3::new(0.0, 0.0, 18.5);
        let found = Vector3::from_fn(|axis, _| rows.residual[SECOND + axis][row]);
        assert!((found - expected).norm() < 1e-5, "row {row}: {found}, not {expected}");
    }
    for (found, expected) in rows.torque_rms.iter().zip([0.009_77, 0.023_09, 0.003_39]) {
        assert!((found - expected).abs() < 1e-9, "{found}, not {expected}");
    }
}
