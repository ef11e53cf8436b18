//! PX4, simulation in hardware: `param load`, or lines of an airframe's script.
//!
//! Its quadrotor (src/modules/simulation/simulator_sih): `T = T_MAX u`, lagging by `T_TAU`; body FRD,
//! `Mx = L_ROLL T_MAX (-u0 + u1 + u2 - u3)`, `My = L_PITCH T_MAX (u0 - u1 + u2 - u3)`,
//! `Mz = Q_MAX (u0 + u1 - u2 - u3)`, drag `-KDV v` at the centre of mass, damping `-KDW w`.
//!
//! Its thrust is linear in the command, as PX4 makes a vehicle's by THR_MDL_FAC. So `T_MAX` is the thrust at full
//! command, and THR_MDL_FAC is 0: thrust and torque that PX4 asks for do what they do on the vehicle.

use super::axes::frd;
use super::drag::{RotorDrag, damping};
use super::error::ExportError;
use super::notes::line_comments;
use super::source::{Exported, Source};
use crate::text::line_comment;
use nalgebra::Vector3;
use std::fmt::Write;

const FORMAT: &str = "px4-sih";
/// PX4's own default of the rotors' lag, s.
const TAU_DEFAULT_S: f64 = 0.05;
/// Hz, of the simulator's steps, by Euler's rule. Its accelerometer shows the force in the attitude of the step before:
/// at PX4's default of 250 Hz thrust leaks into drag, 6 % of it in an identification flight.
const STEPS_HZ: f64 = 1000.0;

pub(super) fn write(mut source: Source<'_>) -> Result<Exported, ExportError> {
    let arms = source.arms_m();
    source.refuse("com_offset");
    let unfit = |got| ExportError::Unfit { format: FORMAT, expected: "four rotors in an X", got };
    if arms.len() != 4 {
        return Err(unfit(format!("{} rotors", arms.len())));
    }
    let mean = |axis: usize| arms.iter().map(|arm| arm[axis].abs()).sum::<f64>() / 4.0;
    let (forward_m, left_m) = (mean(0), mean(1));
    if !in_an_x(&arms, forward_m, left_m) {
        return Err(unfit("other places of them".to_owned()));
    }
    if arms.iter().zip(&source.vehicle.rotors).any(|(arm, rotor)| rotor.spin.yaw_sign() * arm.x * arm.y < 0.0)
    {
        source.note("the simulator's front right and rear left rotors turn counter-clockwise, the model's do not: identify a flight of the simulator with the simulator's spins");
    }
    if arms.iter().any(|arm| (arm.x.abs() - forward_m).abs() > 1e-3 || (arm.y.abs() - left_m).abs() > 1e-3) {
        source.note("the simulator's rotors are symmetric about the centre of mass: arms are means, an offset of the centre of mass is left out");
    }
    let thrust_max_n = source.thrust_max_n();
    let torque_max_nm = thrust_max_n * source.vehicle.propulsion.torque_per_thrust_m;
    let hover = tell_linear(&mut source, thrust_max_n);
    let drag = RotorDrag::of(&mut source);
    let damping = even_damping(&mut source, &drag, &arms);
    drag.tell_at_center(&mut source, &arms);
    drag.tell_no_growth(&mut source);
    let drag = drag.even(&mut source, "SIH_KDV");
    let lag_s = lag(&mut source);
    let order = motors(&source, &arms);
    let body = &source.vehicle.body;
    let j = &body.inertia_kg_m2;
    // about x forward, y right, z down: products with y or z change their sign once, yz twice
    let parameters = [
        ("SIH_MASS", body.mass_kg),
        ("SIH_IXX", j[(0, 0)]),
        ("SIH_IYY", j[(1, 1)]),
        ("SIH_IZZ", j[(2, 2)]),
        ("SIH_IXY", 0.0 - j[(0, 1)]),
        ("SIH_IXZ", 0.0 - j[(0, 2)]),
        ("SIH_IYZ", j[(1, 2)]),
        ("SIH_T_MAX", thrust_max_n),
        ("SIH_Q_MAX", torque_max_nm),
        ("SIH_L_ROLL", left_m),
        ("SIH_L_PITCH", forward_m),
        ("SIH_KDV", drag),
        ("SIH_KDW", damping),
        ("SIH_T_TAU", lag_s),
        ("THR_MDL_FAC", 0.0),
        ("MPC_THR_HOVER", hover),
    ];
    let name = source.vehicle.name.clone();
    Ok(source.finish(|notes| {
        let mut text = line_comment("#", &format!("{name}: PX4 simulation in hardware (SIH), quadrotor X"));
        text.push_str(&line_comment("#", &order));
        text.push_str(&line_comments("#", notes));
        for (parameter, value) in parameters {
            let _ = writeln!(text, "param set {parameter} {value:.6e}");
        }
        for parameter in ["IMU_GYRO_RATEMAX", "IMU_INTEG_RATE"] {
            let _ = writeln!(text, "param set {parameter} {STEPS_HZ}");
        }
        text
    }))
}

/// Share of the mean arm forward and to the left that every rotor of an X has at least (-). In a plus two rotors have none, and a
/// centre of mass that is off leaves more.
const LEAST_OF_MEAN: f64 = 0.4;

/// Whether there is one rotor in each quadrant, none near an axis (`arms`: m, body, from the centre of mass).
fn in_an_x(arms: &[Vector3<f64>], forward_m: f64, left_m: f64) -> bool {
    let quadrants = [(true, true), (true, false), (false, true), (false, false)];
    let one_in = |quadrant: (bool, bool)| {
        arms.iter().filter(|arm| (arm.x > 0.0, arm.y > 0.0) == quadrant).count() == 1
    };
    let away =
        |arm: &Vector3<f64>| arm.x.abs() > LEAST_OF_MEAN * forward_m && arm.y.abs() > LEAST_OF_MEAN * left_m;
    quadrants.into_iter().all(one_in) && arms.iter().all(away)
}

/// Thrust at hover over full thrust (-): the simulator's command there. Tells what that means for the model's.
fn tell_linear(source: &mut Source<'_>, thrust_max_n: f64) -> f64 {
    let hover_n = source.airframe.hover_thrust_n;
    let (ours, its) = (source.vehicle.propulsion.command_from_thrust(hover_n), hover_n / thrust_max_n);
    if (ours - its).abs() > 1e-6 {
        source.note(format!(
            "the simulator's thrust is linear in the command, the model's is not: hover is at {its:.3} here and at {ours:.3} in the model. Identify a flight of the simulator with thrust_max = {thrust_max_n:.4} and thrust_expo = 0"
        ));
    }
    its
}

/// s, with the least that the simulator integrates. Tells of its steps.
fn lag(source: &mut Source<'_>) -> f64 {
    source.note(format!(
        "IMU_GYRO_RATEMAX and IMU_INTEG_RATE, after a restart, make the simulator's steps {} ms long: with PX4's default of 4 ms its accelerometer shows drag about 6 % too small",
        1e3 / STEPS_HZ
    ));
    let Some(lag_s) = source.mean_lag_s() else {
        source.note(format!(
            "no lag of the rotors is known: SIH_T_TAU keeps PX4's default of {TAU_DEFAULT_S} s"
        ));
        return TAU_DEFAULT_S;
    };
    source.note(
        "the lag acts on the thrust here and on the rotor speed in the model: the same for small changes",
    );
    let step_s = STEPS_HZ.recip();
    if lag_s < step_s {
        source.note(format!(
            "the simulator's steps are {step_s} s long: SIH_T_TAU is that, the model's lag is {lag_s} s"
        ));
    }
    lag_s.max(step_s)
}

/// N m/(rad/s), the same about all axes: the model's damping, with that of a drag at the hubs.
fn even_damping(source: &mut Source<'_>, drag: &RotorDrag, arms_m: &[Vector3<f64>]) -> f64 {
    let own = Vector3::from(["bx", "by", "bz"].map(|axis| source.take("angular_damping", axis)));
    let all = own + damping(&drag.at_hubs, arms_m);
    let mean = all.mean();
    if all.iter().any(|b| (b - mean).abs() > 0.05 * mean) {
        source.note(format!(
            "the simulator's damping is the same about all axes: SIH_KDW is the mean of {:.5}, {:.5}, {:.5} N m/(rad/s), the drag at the hubs included",
            all.x, all.y, all.z
        ));
    }
    mean
}

/// Which motor of the simulator is where, beside the model's rotors (`arms`: m, body, from the centre of mass).
fn motors(source: &Source<'_>, arms: &[Vector3<f64>]) -> String {
    let order: Vec<String> = arms
        .iter()
        .zip(&source.vehicle.rotors)
        .enumerate()
        .map(|(index, (arm, rotor))| {
            let [x, y, _] = frd(arm);
            format!("{} at x {x:.4}, y {y:.4}, {:?}", rotor.motor_words(index), rotor.spin)
        })
        .collect();
    format!(
        "the simulator's motors 1 to 4: front right ccw, rear left ccw, front left cw, rear right cw; the model's, forward-right: {}",
        order.join("; ")
    )
}
