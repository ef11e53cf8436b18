//! The drag of a flight whose autopilot flies on an estimate with errors: the reconstruction finds it, a regression on that
//! estimate does not.

use std::f64::consts::TAU;
use std::sync::Arc;

use mavid::physics::effects::LinearDrag;
use mavid::reconstruction::{Fit, KnownLag, STATE, State, Term, fit, force_problem};
use mavid::recording::{Quantity, Stream};
use mavid::signals::{
    AsRecorded, Grid, OwnOfFlight, Quality, Series, Signals, ThrustSource, TorqueError, Usable,
    VelocityHeldBy,
};
use mavid::simulate::random_vehicle;
use mavid::vehicle::Vehicle;
use nalgebra::{Rotation3, UnitQuaternion, Vector3, Vector4};
use rand::SeedableRng;
use rand_distr::{Distribution, Normal};
use rand_pcg::Pcg64;

const STEP_S: f64 = 0.004;
const COUNT: usize = 15_000;
/// N/(m/s), all axes
const DRAG: f64 = 0.8;
/// m/s^2 a sample of 4 ms
const NOISE_M_S2: f64 = 2.0;

fn vehicle() -> Vehicle {
    let mut vehicle = random_vehicle(1).nominal;
    vehicle.body.mass_kg = 1.3;
    vehicle.gravity_m_s2 = 9.81;
    vehicle
}

/// Velocity and acceleration of a path of five harmonics along each axis, m/s and m/s^2.
fn motion(time_s: f64) -> (Vector3<f64>, Vector3<f64>) {
    let along = |axis: usize| {
        let of = |harmonic: i32| {
            let hz = f64::from(harmonic) / 12.0;
            let phase = TAU * hz * time_s + 1.7 * f64::from(harmonic) + 2.1 * axis as f64;
            let size = if axis == 2 { 0.25 } else { 0.45 };
            (size * phase.sin(), size * TAU * hz * phase.cos())
        };
        (1..=5).map(of).fold((0.0, 0.0), |sum, each| (sum.0 + each.0, sum.1 + each.1))
    };
    let [x, y, z] = [along(0), along(1), along(2)];
    (Vector3::new(x.0, y.0, z.0), Vector3::new(x.1, y.1, z.1))
}

/// What the autopilot recorded of it. Its velocity integrates the noisy accelerometer with its leaning attitude and is pulled
/// to a receiver's; its attitude walks about the true one.
fn recorded(vehicle: &Vehicle, seed: u64) -> Signals {
    let mut generator = Pcg64::seed_from_u64(seed);
    let normal = Normal::new(0.0, 1.0).unwrap();
    let mut draw = |std: f64| Vector3::from_fn(|_, _| std * normal.sample(&mut generator));
    let up = Vector3::z() * vehicle.gravity_m_s2;
    let (mut tilt, mut estimate) = (draw(0.008), motion(0.0).0);
    let (mut attitude, mut velocity, mut position) = (Vec::new(), Vec::new(), Vec::new());
    let (mut thrusts, mut felt, mut rates) = (Vec::new(), Vec::new(), Vec::new());
    let rotors = vehicle.rotors.len();
    let mut before: Option<UnitQuaternion<f64>> = None;
    for index in 0..COUNT {
        let (speed, acceleration) = motion(STEP_S * index as f64);
        let carried = (acceleration + up) * vehicle.body.mass_kg + speed * DRAG;
        let axis = carried.normalize();
        let sideways = axis.cross(&Vector3::x()).normalize();
        let true_turn = Rotation3::from_basis_unchecked(&[sideways.cross(&axis), sideways, axis]);
        let true_turn = UnitQuaternion::from_rotation_matrix(&true_turn);
        rates.push(
            before
                .map_or_else(Vector3::zeros, |before| (before.inverse() * true_turn).scaled_axis() / STEP_S),
        );
        before = Some(true_turn);
        let reading = true_turn.inverse_transform_vector(&(acceleration + up)) + draw(NOISE_M_S2);
        tilt += draw(0.004 * STEP_S.sqrt());
        let believed = true_turn * UnitQuaternion::from_scaled_axis(-tilt);
        let receiver = speed + draw(1.0);
        estimate += STEP_S * (believed * reading - up + 0.5 * (receiver - estimate));
        thrusts.extend(std::iter::repeat_n(carried.norm() / rotors as f64, rotors));
        attitude.push(believed);
        velocity.push(estimate);
        position.push(Vector3::new(0.0, 0.0, 5.0));
        felt.push(reading);
    }
    let stream = |values: &[Vector3<f64>]| Stream {
        time_s: (0..COUNT).map(|index| STEP_S * index as f64).collect(),
        width: 3,
        values: values.iter().flat_map(|value| value.iter().copied()).collect(),
    };
    Signals {
        grid: Grid { start_s: 0.0, step_s: STEP_S, count: COUNT },
        usable: vec![true; COUNT],
        as_recorded: AsRecorded {
            specific_force: Some(Arc::new(stream(&felt))),
            velocity: Some(Arc::new(stream(&velocity))),
            gps_velocity: None,
        },
        attitude: Some(attitude.into()),
        rate: Some(rates.into()),
        specific_force: Some(felt.into()),
        world_acceleration: None,
        position: Some(position.into()),
        velocity: Some(velocity.into()),
        rotor_thrust_n: thrusts.into(),
        full_thrust_n: vehicle.propulsion.full_thrust_n(),
        wrench: vec![Vector4::zeros(); COUNT].into(),
        jitter_wrench: None,
        battery_voltage_v: None,
        reference: None,
        own: OwnOfFlight::default(),
        air_m_s: Vector3::zeros(),
        quality: Quality {
            sources: vec![(Quantity::ActuatorCommand, "by hand", 1.0 / STEP_S)],
            thrust_source: ThrustSource::Command,
            offsets: Vec::new(),
            airborne_s: vec![(0.0, STEP_S * COUNT as f64)],
            usable: Usable::default(),
            torques: true,
            torque_error: TorqueError::default(),
            gyro_noise_rad_s: None,
            velocity_held_by: VelocityHeldBy::default(),
            position_by_receiver: false,
            steady_voltage_v: None,
            simulated: false,
            notes: Vec::new(),
        },
    }
}

/// Drag of the body, with these of its values free.
fn drag(with_speed: f64, free: &[usize]) -> Term {
    let values = vec![0.3, 0.3, 0.3, 1.0, with_speed];
    Term::new(&LinearDrag, values, free.to_vec(), vec![1e-4; free.len()])
}

fn fitted(signals: &Signals, vehicle: &Vehicle, term: Term) -> Fit {
    // the commands of this flight act at once
    let known = KnownLag { delay_s: -0.004, lag_s: 0.0, lag_std_s: 1e-4, uneven: 0.0 };
    let problem = force_problem(signals, vehicle, known, vec![term]).unwrap();
    let free: Vec<usize> = (0..problem.unknowns.len()).collect();
    fit(problem, &free).unwrap()
}

/// Least squares of the measured sideways force on the autopilot's velocity, N/(m/s).
fn regressed(signals: &Signals, vehicle: &Vehicle, axis: usize) -> f64 {
    let vectors = |series: &Option<Series<Vector3<f64>>>| series.clone().unwrap_or_default();
    let (velocity, felt) = (vectors(&signals.velocity), vectors(&signals.specific_force));
    let attitude = signals.attitude.clone().unwrap_or_default();
    let each = attitude.iter().zip(velocity.iter()).zip(felt.iter());
    let sums = each.fold((0.0, 0.0), |(cross, square), ((attitude, velocity), felt)| {
        let through = attitude.inverse_transform_vector(velocity)[axis];
        (cross - vehicle.body.mass_kg * felt[axis] * through, square + through * through)
    });
    sums.0 / sums.1
}

#[test]
fn drag_is_found_where_a_regression_on_the_estimate_loses_a_part_of_it() {
    let vehicle = vehicle();
    let (mut found, mut plain) = (Vec::new(), Vec::new());
    for seed in [11, 12, 13] {
        let signals = recorded(&vehicle, seed);
        let fit = fitted(&signals, &vehicle, drag(0.0, &[0, 1, 2]));
        for (axis, name) in ["dx", "dy"].into_iter().enumerate() {
            let (value, by_model, by_blocks) = fit.value(name).unwrap();
            let std = by_model.max(by_blocks);
            assert!((value - DRAG).abs() < 3.0 * std, "seed {seed}: {name} {value} +- {std}");
            assert!(std < 0.1 * DRAG, "seed {seed}: {name} +- {std}");
            found.push(value / DRAG);
            plain.push(regressed(&signals, &vehicle, axis) / DRAG);
        }
        let (scale, by_model, by_blocks) = fit.value("scale").unwrap();
        assert!((scale - 1.0).abs() < 3.0 * by_model.max(by_blocks), "seed {seed}: {scale}");
    }
    let mean = |of: &[f64]| of.iter().sum::<f64>() / of.len() as f64;
    assert!((mean(&found) - 1.0).abs() < 0.03, "{found:?}");
    assert!(mean(&plain) < 0.95, "{plain:?}");
}

#[test]
fn the_drag_of_a_body_is_told_from_that_of_the_rotors() {
    let vehicle = vehicle();
    let found = fitted(&recorded(&vehicle, 14), &vehicle, drag(0.5, &[0, 1, 2, 4]));
    let (share, by_model, by_blocks) = found.value("with_speed").unwrap();
    let std = by_model.max(by_blocks);
    assert!(share.abs() < 3.0 * std, "{share} +- {std}");
}

#[test]
fn what_is_not_recorded_is_said() {
    let vehicle = vehicle();
    let mut signals = recorded(&vehicle, 15);
    let known = KnownLag { delay_s: 0.0, lag_s: 0.05, lag_std_s: 0.01, uneven: 0.0 };
    let refused = |signals: &Signals| {
        force_problem(signals, &vehicle, known, vec![drag(1.0, &[0])]).unwrap_err().to_string()
    };
    signals.as_recorded.specific_force = None;
    assert_eq!(refused(&signals), "expected a stream of specific_force, got none");
    signals = recorded(&vehicle, 15);
    signals.quality.airborne_s = vec![(1.0, 6.0)];
    assert_eq!(refused(&signals), "expected at least 8 s in the air, a metre above the ground, got less");
}

/// Each residual's derivatives against differences of the residual, about states and parameters that are not those of a
/// solution.
#[test]
fn derivatives_are_those_of_the_residuals() {
    let vehicle = vehicle();
    let known = KnownLag { delay_s: 0.0, lag_s: 0.034, lag_std_s: 0.01, uneven: 0.0 };
    let term = drag(0.4, &[0, 1, 2, 4]);
    let problem = force_problem(&recorded(&vehicle, 16), &vehicle, known, vec![term]).unwrap();
    let mut theta: Vec<f64> = problem.unknowns.iter().map(|unknown| unknown.mean).collect();
    theta[0] = 1.1;
    theta[6] = 0.02;
    theta[9] = 0.003;
    let mut generator = Pcg64::seed_from_u64(17);
    let normal = Normal::new(0.0, 0.02).unwrap();
    for (index, group) in problem.groups.iter().enumerate() {
        let form = group.form.as_ref();
        for row in [0, form.intervals().len() / 2] {
            let at = form.intervals()[row];
            let mut near = |state: &State| state.map(|value| value + normal.sample(&mut generator));
            let (a, b) = (near(&problem.states[at]), near(&problem.states[at + 1]));
            let here = form.row(row, &a, &b, &theta);
            let step = 1e-6;
            for column in 0..2 * STATE {
                let mut moved = [a, b];
                moved[column / STATE][column % STATE] += step;
                let slope = (form.row(row, &moved[0], &moved[1], &theta).residual - here.residual) / step;
                let error = (slope - here.by_states.column(column)).norm();
                // the right Jacobian is to first order in the tilt
                assert!(error < 5e-3 * (1.0 + slope.norm()), "group {index}, state {column}: off by {error}");
            }
            for (place, &parameter) in form.parameters().iter().enumerate() {
                let mut moved = theta.clone();
                moved[parameter] += step;
                let slope = (form.row(row, &a, &b, &moved).residual - here.residual) / step;
                let error = (slope - here.by_parameters.column(place)).norm();
                assert!(
                    error < 5e-3 * (1.0 + slope.norm()),
                    "group {index}, parameter {parameter}: off by {error}"
                );
            }
        }
    }
}
