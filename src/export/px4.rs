//! PX4, simulation in hardware: `param load`, or lines of an airframe's script.
//!
//! Its quadrotor (src/modules/simulation/simulator_sih): `T = T_MAX u`, lagging by `T_TAU`; body FRD,
//! `Mx = L_ROLL T_MAX (-u0 + u1 + u2 - u3)`, `My = L_PITCH T_MAX (u0 - u1 + u2 - u3)`,
//! `Mz = Q_MAX (u0 + u1 - u2 - u3)`, drag `-KDV v`, damping `-KDW w`.

use super::axes::frd;
use super::error::ExportError;
use super::notes::line_comments;
use super::source::{Exported, Source};
use crate::text::line_comment;
use nalgebra::Vector3;
use std::fmt::Write;

const FORMAT: &str = "px4-sih";
/// PX4's own default of the rotors' lag, s.
const TAU_DEFAULT_S: f64 = 0.05;

pub(super) fn write(mut source: Source<'_>) -> Result<Exported, ExportError> {
    let arms = source.arms_m();
    source.refuse("com_offset");
    if arms.len() != 4 {
        let got = format!("{} rotors", arms.len());
        return Err(ExportError::Unfit { format: FORMAT, expected: "four rotors in an X", got });
    }
    let mean = |axis: usize| arms.iter().map(|arm| arm[axis].abs()).sum::<f64>() / 4.0;
    let (forward_m, left_m) = (mean(0), mean(1));
    if arms.iter().any(|arm| (arm.x.abs() - forward_m).abs() > 1e-3 || (arm.y.abs() - left_m).abs() > 1e-3) {
        source.note("the simulator's rotors are symmetric about the centre of mass: arms are means, an offset of the centre of mass is left out");
    }
    let thrust_max_n = linear_thrust_max_n(&mut source);
    let torque_max_nm = thrust_max_n * source.vehicle.propulsion.torque_per_thrust_m;
    let drag = drag(&mut source);
    let damping = damping(&mut source);
    let lag_s = source.time_constant_s();
    if lag_s.is_none() {
        source.note(format!(
            "no lag of the rotors is known: SIH_T_TAU keeps PX4's default of {TAU_DEFAULT_S} s"
        ));
    }
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
        ("SIH_T_TAU", lag_s.unwrap_or(TAU_DEFAULT_S)),
    ];
    let name = source.vehicle.name.clone();
    Ok(source.finish(|notes| {
        let mut text = line_comment("#", &format!("{name}: PX4 simulation in hardware (SIH), quadrotor X"));
        text.push_str(&line_comment("#", &order));
        text.push_str(&line_comments("#", notes));
        for (parameter, value) in parameters {
            let _ = writeln!(text, "param set {parameter} {value:.6e}");
        }
        text
    }))
}

/// One rotor's thrust at full command, N: the simulator's is linear in the command, along the chord through hover.
fn linear_thrust_max_n(source: &mut Source<'_>) -> f64 {
    let thrust_max_n = source.thrust_max_n();
    let hover = source.airframe.hover_thrust_n;
    let command = source.vehicle.propulsion.command_from_thrust(hover);
    let linear_max_n = hover / command;
    if (linear_max_n / thrust_max_n - 1.0).abs() > 1e-6 {
        source.note(format!(
            "the simulator's thrust is linear in the command: SIH_T_MAX is chosen so that hover needs the same command ({command:.3}); at full command the model gives {thrust_max_n:.3} N, the simulator {linear_max_n:.3} N"
        ));
    }
    linear_max_n
}

/// N/(m/s), the same along all axes.
fn drag(source: &mut Source<'_>) -> f64 {
    let drag = ["dx", "dy", "dz"].map(|axis| source.take("linear_drag", axis));
    let inflow = source.take("inflow", "kz");
    let across = 0.5 * (drag[0] + drag[1]);
    let along = drag[2] + inflow;
    if across.max(along) > 0.0 && (drag[0] - drag[1]).abs().max((along - across).abs()) > 0.05 * across {
        source.note(format!(
            "the simulator's drag is the same along all axes: SIH_KDV is the mean across the rotor axis; the model has {:.4}, {:.4}, {along:.4} N/(m/s)",
            drag[0], drag[1]
        ));
    }
    across
}

/// N m/(rad/s), the same about all axes.
fn damping(source: &mut Source<'_>) -> f64 {
    let damping = ["bx", "by", "bz"].map(|axis| source.take("angular_damping", axis));
    let mean = damping.iter().sum::<f64>() / 3.0;
    if damping.iter().any(|b| (b - mean).abs() > 0.05 * mean) {
        source.note(format!(
            "the simulator's damping is the same about all axes: SIH_KDW is the mean of {damping:?} N m/(rad/s)"
        ));
    }
    mean
}

/// Which motor of the simulator is where, beside the model's rotors (`arms`: m, body, from the centre of mass).
fn motors(source: &Source<'_>, arms: &[Vector3<f64>]) -> String {
    let order: Vec<String> = arms
        .iter()
        .zip(&source.vehicle.rotors)
        .map(|(arm, rotor)| {
            let [x, y, _] = frd(arm);
            format!("{} at x {x:.4}, y {y:.4}, {:?}", rotor.name, rotor.spin)
        })
        .collect();
    format!(
        "the simulator's motors 1 to 4: front right ccw, rear left ccw, front left cw, rear right cw; the model's, forward-right: {}",
        order.join("; ")
    )
}
