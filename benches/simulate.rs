//! How fast simulation is: Runge-Kutta steps of a rigid body a second on one core, and simulated seconds a
//! second of one vehicle with drag, inflow, flapping, translational lift and motor lag, beside RotorPy's
//! multirotor in the same run.
//!
//! `cargo bench --bench simulate`; RotorPy from `tests/peers/setup.sh`, or where `MAVID_PYTHON` has it.

#![allow(clippy::print_stdout, clippy::unwrap_used, reason = "a benchmark prints and ends where it fails")]

#[path = "../tests/support/python.rs"]
mod python;
#[path = "../tests/support/rotorpy.rs"]
mod rotorpy;

use std::hint::black_box;
use std::time::Instant;

use mavid::physics::{Input, Model, RIGID_STATES, RigidBodyModel, State, Wrench};
use mavid::simulate::Plant;
use mavid::simulate::integrator::rk4_step;
use nalgebra::{SVector, UnitQuaternion, Vector3};
use rotorpy::HUMMINGBIRD;
use serde_json::json;

/// Best of this many runs, of ours as of RotorPy's: the machine may do something else besides.
const RUNS: usize = 5;

fn tumbling() -> State {
    State {
        position_m: Vector3::new(0.0, 0.0, 10.0),
        velocity_m_s: Vector3::new(1.0, -2.0, 0.5),
        attitude: UnitQuaternion::from_euler_angles(0.1, -0.2, 0.3),
        rates_rad_s: Vector3::new(0.3, 0.5, -0.2),
    }
}

/// Units of work a second, best of some runs.
fn best_rate(work: f64, mut run: impl FnMut()) -> f64 {
    (0..RUNS).fold(0.0, |best, _| {
        let start = Instant::now();
        run();
        f64::max(best, work / start.elapsed().as_secs_f64())
    })
}

/// Steps a second of (1) to (4) under constant force and torque.
fn rigid_body(body: &RigidBodyModel) -> f64 {
    let steps = 2_000_000_u32;
    let wrench = Wrench { force_n: Vector3::new(0.0, 0.0, 5.0), torque_nm: Vector3::new(1e-6, -2e-6, 1e-6) };
    best_rate(f64::from(steps), || {
        let mut vector = SVector::<f64, RIGID_STATES>::zeros();
        tumbling().write(&mut vector);
        let mut derivative = |_: f64, vector: &SVector<f64, RIGID_STATES>| {
            let mut out = SVector::zeros();
            body.derivative(&State::read(vector), black_box(&wrench)).write(&mut out);
            out
        };
        for step in 0..steps {
            vector = rk4_step(&mut derivative, f64::from(step) * 1e-3, &vector, 1e-3);
        }
        black_box(vector);
    })
}

/// Simulated seconds a second, steps of 2 ms.
fn with_effects(model: &Model, input: &Input) -> f64 {
    let steps = 200_000_u32;
    best_rate(f64::from(steps) * 2e-3, || {
        let mut plant = Plant::new(model, None, &tumbling(), input).unwrap();
        for _ in 0..steps {
            plant.step(black_box(input), 2e-3);
        }
        black_box(plant.state());
    })
}

/// RotorPy's simulated seconds a second, commands every 2 ms, best of some runs.
fn its_rate() -> Result<f64, String> {
    let state = tumbling();
    let q = state.attitude.quaternion();
    let hover = [HUMMINGBIRD.hover_rad_s(); 4];
    let given = json!({
        "params": HUMMINGBIRD.params(), "step_s": 2e-3, "commands": vec![hover; 500],
        "start": {
            "x": state.position_m.as_slice(), "v": state.velocity_m_s.as_slice(), "q": [q.i, q.j, q.k, q.w],
            "w": state.rates_rad_s.as_slice(), "wind": [0.0, 0.0, 0.0], "rotor_speeds": hover,
        },
    });
    (0..RUNS).try_fold(0.0, |best, _| {
        let answer = python::ask("rotorpy_multirotor.py", &["--time"], &given)?;
        Ok(f64::max(best, answer.as_f64().unwrap()))
    })
}

fn main() {
    let model = HUMMINGBIRD.model();
    let mut input = Input::from_commands(&model.airframe, 0.0, &[]);
    input.speed_command[..4].fill(1.0);
    println!("rigid body, RK4                  {:>12.0} steps/s on one core", rigid_body(&model.body));
    let ours = with_effects(&model, &input);
    println!("with effects, RK4 at 2 ms        {ours:>12.0} simulated s/s, {:.0} steps/s", ours / 2e-3);
    match its_rate() {
        Ok(theirs) => {
            println!("RotorPy, its default integrator  {theirs:>12.2} simulated s/s");
            println!("ratio                            {:>12.0}", ours / theirs);
        }
        Err(why) => println!("RotorPy                          not measured: {why}"),
    }
}
