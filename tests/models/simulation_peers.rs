//! Simulation against independent programs: SciPy's integrators and RotorPy's multirotor. Skipped, with a
//! message, where Python or a package is missing (`tests/peers/setup.sh` installs them).

use crate::python;
use crate::rotorpy;
use crate::support;

use mavid::physics::{Input, RIGID_STATES, RigidBodyModel, State, Wrench};
use mavid::simulate::Plant;
use mavid::simulate::integrator::{Tolerance, dormand_prince, rk4_step};
use mavid::vehicle::RigidBody;
use nalgebra::{Matrix3, SVector, UnitQuaternion, Vector3};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use rotorpy::HUMMINGBIRD;
use serde_json::json;
use support::Needed;

fn any(random: &mut Pcg64Mcg, size: f64) -> Vector3<f64> {
    Vector3::from_fn(|_, _| random.random_range(-size..size))
}

fn any_state(random: &mut Pcg64Mcg) -> State {
    State {
        position_m: any(random, 5.0),
        velocity_m_s: any(random, 8.0),
        attitude: UnitQuaternion::from_scaled_axis(any(random, 1.5)),
        rates_rad_s: any(random, 4.0),
    }
}

/// RotorPy's state.
fn in_its_words(state: &State, wind_m_s: &Vector3<f64>, speeds_rad_s: &[f64]) -> serde_json::Value {
    let q = state.attitude.quaternion();
    json!({
        "x": state.position_m.as_slice(), "v": state.velocity_m_s.as_slice(), "q": [q.i, q.j, q.k, q.w],
        "w": state.rates_rad_s.as_slice(), "wind": wind_m_s.as_slice(), "rotor_speeds": speeds_rad_s,
    })
}

#[test]
fn both_integrators_agree_with_scipy() {
    let mut random = Pcg64Mcg::seed_from_u64(4);
    let inertia_kg_m2 = Matrix3::new(0.012, -0.0008, 0.0001, -0.0008, 0.015, -0.0006, 0.0001, -0.0006, 0.022);
    let body = RigidBody { mass_kg: 1.8, inertia_kg_m2, center_of_mass_m: Vector3::zeros(), gyroscopic: 1.0 };
    let model = RigidBodyModel::new(&body, 9.81).unwrap();
    for _ in 0..5 {
        let state = any_state(&mut random);
        let wrench = Wrench { force_n: any(&mut random, 20.0), torque_nm: any(&mut random, 0.01) };
        let matrix = state.attitude.to_rotation_matrix();
        let answer = python::ask(
            "rigid_body.py",
            &[],
            &json!({
                "mass": 1.8, "gravity": 9.81, "inertia": inertia_kg_m2.as_slice(),
                "force": wrench.force_n.as_slice(), "torque": wrench.torque_nm.as_slice(),
                "position": state.position_m.as_slice(), "velocity": state.velocity_m_s.as_slice(),
                // row by row
                "matrix": matrix.matrix().transpose().as_slice(), "rates": state.rates_rad_s.as_slice(),
                "end_s": 2.0,
            }),
        );
        let answer = match answer {
            Ok(answer) => python::numbers(&answer),
            Err(why) => return support::skip(Needed::Peers, &why),
        };
        let mut derivative = |_: f64, vector: &SVector<f64, RIGID_STATES>| {
            let mut out = SVector::zeros();
            model.derivative(&State::read(vector), &wrench).write(&mut out);
            out
        };
        let mut start = SVector::zeros();
        state.write(&mut start);
        let fixed = (0..4000_u32)
            .fold(start, |at, step| rk4_step(&mut derivative, f64::from(step) * 5e-4, &at, 5e-4));
        let tight = Tolerance { absolute: 1e-11, relative: 1e-11, ..Tolerance::default() };
        let adaptive = dormand_prince(&mut derivative, (0.0, 2.0), &start, &tight).unwrap();
        for end in [State::read(&fixed), State::read(&adaptive)] {
            let turned = end.attitude.to_rotation_matrix().matrix().transpose();
            let ours = [
                end.position_m.as_slice(),
                end.velocity_m_s.as_slice(),
                turned.as_slice(),
                end.rates_rad_s.as_slice(),
            ]
            .concat();
            for (ours, theirs) in ours.iter().zip(&answer) {
                assert!((ours - theirs).abs() < 1e-8, "{ours} {theirs}");
            }
        }
    }
}

#[test]
fn accelerations_are_rotorpys() {
    let mut random = Pcg64Mcg::seed_from_u64(3);
    let model = HUMMINGBIRD.model();
    let hover_rad_s = HUMMINGBIRD.hover_rad_s();
    let (mut cases, mut ours) = (Vec::new(), Vec::new());
    for _ in 0..200 {
        let (state, wind_m_s) = (any_state(&mut random), any(&mut random, 5.0));
        let speeds: [f64; 4] = std::array::from_fn(|_| random.random_range(200.0..1400.0));
        let commands: [f64; 4] = std::array::from_fn(|_| random.random_range(200.0..1400.0));
        let u = commands.map(|speed| speed / HUMMINGBIRD.speed_max_rad_s);
        let mut input = Input::from_commands(&model.airframe, 0.0, &u);
        input.wind_m_s = wind_m_s;
        let own = speeds.map(|speed| speed / hover_rad_s);
        let mut rates = [0.0; 4];
        let wrench = model.evaluate(&state, &input, &own, &mut rates).wrench;
        let change = model.body.derivative(&state, &wrench);
        ours.push((change.acceleration_m_s2, change.angular_acceleration_rad_s2));
        for ((rate, command), speed) in rates.iter().zip(commands).zip(speeds) {
            assert!((rate * hover_rad_s - (command - speed) / HUMMINGBIRD.tau_m_s).abs() < 1e-6);
        }
        cases.push(json!({"state": in_its_words(&state, &wind_m_s, &speeds), "command": commands}));
    }
    let given = json!({"params": HUMMINGBIRD.params(), "cases": cases});
    match python::ask("rotorpy_multirotor.py", &["--accelerations"], &given) {
        Err(why) => support::skip(Needed::Peers, &why),
        Ok(answer) => {
            for (theirs, (linear, angular)) in answer.as_array().unwrap().iter().zip(ours) {
                let theirs = python::numbers(theirs);
                let theirs =
                    (Vector3::from_column_slice(&theirs[..3]), Vector3::from_column_slice(&theirs[3..]));
                let scale = 1.0 + linear.norm() + angular.norm();
                assert!((linear - theirs.0).norm() < 1e-9 * scale, "{linear} {}", theirs.0);
                assert!((angular - theirs.1).norm() < 1e-9 * scale, "{angular} {}", theirs.1);
            }
        }
    }
}

#[test]
fn five_seconds_open_loop_end_where_rotorpys_do() {
    const STEP_S: f64 = 0.01;
    let mut random = Pcg64Mcg::seed_from_u64(5);
    let model = HUMMINGBIRD.model();
    let hover_rad_s = HUMMINGBIRD.hover_rad_s();
    for _ in 0..3 {
        let wind_m_s = any(&mut random, 3.0);
        let state = State { rates_rad_s: any(&mut random, 0.3), ..any_state(&mut random) };
        let commands: Vec<[f64; 4]> = (0..500)
            .map(|_| std::array::from_fn(|_| hover_rad_s * random.random_range(0.97..1.05)))
            .collect();
        let given = json!({
            "params": HUMMINGBIRD.params(), "step_s": STEP_S, "commands": commands,
            "start": in_its_words(&state, &wind_m_s, &[hover_rad_s; 4]),
        });
        let answer = match python::ask("rotorpy_multirotor.py", &["--trajectory"], &given) {
            Ok(answer) => answer,
            Err(why) => return support::skip(Needed::Peers, &why),
        };
        let of = |speeds: &[f64; 4]| {
            let u = speeds.map(|speed| speed / HUMMINGBIRD.speed_max_rad_s);
            Input { wind_m_s, ..Input::from_commands(&model.airframe, 0.0, &u) }
        };
        let mut plant = Plant::new(&model, None, &state, &of(&[hover_rad_s; 4])).unwrap();
        for (command, theirs) in commands.iter().zip(answer.as_array().unwrap()) {
            for _ in 0..10 {
                plant.step(&of(command), STEP_S / 10.0);
            }
            let (ours, theirs) = (plant.state(), python::numbers(theirs));
            let away_m = (ours.position_m - Vector3::from_column_slice(&theirs[..3])).norm();
            assert!(away_m < 1e-4, "{away_m} m");
        }
    }
}
