//! ArduPilot's simulator: a frame file for `--model "x:frame.json"`.
//!
//! libraries/SITL/SIM_Frame.cpp and SIM_Motor.cpp: hover at `hoverThrOut`, thrust over the command by
//! `propExpo`; momentum drag of each motor `mdrag_coef sqrt(rho disc_area / N T) v` (all of the vehicle:
//! `mdrag_coef sqrt(rho disc_area m g) v`); bluff-body drag from `refSpd` at `refAngle`; rotation damped by
//! `400 deg / refRotRate` of the rate; motor positions from the centre of mass, forward-right-down.

use super::axes::frd;
use super::error::ExportError;
use super::notes::line_comments;
use super::source::{Exported, Source};
use crate::text::json_pretty;
use crate::units::AIR_DENSITY_KG_M3;
use crate::vehicle::{Actuator, ThrustLaw};
use nalgebra::Vector3;
use serde_json::{Map, Value, json};
use std::f64::consts::PI;

const FORMAT: &str = "ardupilot-sitl";
/// m/s at which the reference flight of the drag is.
const REFERENCE_M_S: f64 = 15.0;

pub(super) fn write(mut source: Source<'_>) -> Result<Exported, ExportError> {
    let arms = source.arms_m();
    let count = arms.len();
    let propulsion = source.vehicle.propulsion;
    let radius_m = propulsion
        .rotor_radius_m
        .ok_or(ExportError::Missing { format: FORMAT, what: "rotor_radius (for its drag and thrust)" })?;
    let weight_n = source.vehicle.body.mass_kg * source.vehicle.gravity_m_s2;
    let disc_m2 = PI * radius_m * radius_m * count as f64;
    let (momentum, angle) = drag(&mut source, disc_m2, weight_n);
    let damping = ["bx", "by", "bz"].map(|axis| source.take("angular_damping", axis));
    let mut file = Map::new();
    file.insert("mass".into(), json!(source.vehicle.body.mass_kg));
    file.insert("diagonal_size".into(), json!(2.0 * arms.iter().map(|arm| arm.norm()).fold(0.0, f64::max)));
    file.insert("refSpd".into(), json!(REFERENCE_M_S));
    file.insert("refAngle".into(), json!(angle.to_degrees()));
    file.insert("refAlt".into(), json!(0.0));
    file.insert("mdrag_coef".into(), json!(momentum));
    file.insert("disc_area".into(), json!(disc_m2));
    file.insert("hoverThrOut".into(), json!(propulsion.command_from_thrust(weight_n / count as f64)));
    file.insert("propExpo".into(), json!(expo(propulsion.law)));
    if let Some(rate) = reference_rate(&mut source, &damping) {
        file.insert("refRotRate".into(), json!(rate));
    }
    if let Actuator::Pwm(Some(range)) = propulsion.actuator {
        file.insert("pwmMin".into(), json!(range.min_us));
        file.insert("pwmMax".into(), json!(range.max_us));
        file.insert("spin_min".into(), json!(0.0));
        file.insert("spin_max".into(), json!(1.0));
    }
    file.insert("moment_inertia".into(), json!(moments_kg_m2(&mut source)));
    motors(&mut file, &source, &arms);
    source.note("motors are in the model's own order; the simulator's frame must have as many, and its servo functions the same order");
    source.note("refVoltage, refCurrent and the battery keep ArduPilot's defaults: they were not identified");
    if source.time_constant_s().is_some() {
        source.note("the simulator's rotors have no lag (slew_max limits their rate alone)");
        source.refuse("motor_lag");
    }
    Ok(source.finish(|notes| {
        let head = line_comments("#", notes);
        let body = json_pretty(&Value::Object(file)).unwrap_or_default();
        // comments are the simulator's own: it blanks from # to the end of the line, after the first brace
        format!("{}{}\n", body.replacen('{', &format!("{{\n{head}"), 1), "")
    }))
}

/// Coefficient of the momentum drag (-), and tilt (rad) of level flight at the reference speed.
fn drag(source: &mut Source<'_>, disc_m2: f64, weight_n: f64) -> (f64, f64) {
    let drag = ["dx", "dy", "dz"].map(|axis| source.take("linear_drag", axis));
    let across = 0.5 * (drag[0] + drag[1]);
    let momentum = across / (AIR_DENSITY_KG_M3 * disc_m2 * weight_n).sqrt();
    let along = drag[2] + source.take("inflow", "kz");
    if (along - across).abs().max((drag[0] - drag[1]).abs()) > 0.05 * across {
        source.note(format!(
            "the simulator's momentum drag is the same along all axes: the mean across the rotor axis is taken; the model has {:.4}, {:.4}, {along:.4} N/(m/s)",
            drag[0], drag[1]
        ));
    }
    let quadratic = ["cx", "cy", "cz"].map(|axis| source.take("quadratic_drag", axis));
    let bluff = 0.5 * (quadratic[0] + quadratic[1]);
    (momentum, reference_angle(across, bluff, weight_n))
}

/// Moments of inertia, kg m^2.
fn moments_kg_m2(source: &mut Source<'_>) -> [f64; 3] {
    let j = source.vehicle.body.inertia_kg_m2;
    if [j[(0, 1)], j[(0, 2)], j[(1, 2)]].iter().any(|product| *product != 0.0) {
        source.note(format!(
            "the simulator has no products of inertia: ixy {:.3e}, ixz {:.3e}, iyz {:.3e} kg m^2",
            j[(0, 1)],
            j[(0, 2)],
            j[(1, 2)]
        ));
    }
    [j[(0, 0)], j[(1, 1)], j[(2, 2)]]
}

/// Place (`arms`: m, body, from the centre of mass), axis and reaction of each motor.
fn motors(file: &mut Map<String, Value>, source: &Source<'_>, arms: &[Vector3<f64>]) {
    file.insert("num_motors".into(), json!(arms.len()));
    for (number, (arm, rotor)) in (1..).zip(arms.iter().zip(&source.vehicle.rotors)) {
        file.insert(format!("motor{number}_position"), json!(frd(arm)));
        file.insert(format!("motor{number}_vector"), json!([0.0, 0.0, -1.0]));
        // about z down: opposite to about z up
        let yaw = -rotor.spin.yaw_sign() * source.vehicle.propulsion.torque_per_thrust_m;
        file.insert(format!("motor{number}_yaw"), json!(yaw));
    }
}

/// Tilt (rad) of level flight at the reference speed: where the weight's share balances the drag along the
/// body's x axis.
fn reference_angle(linear: f64, quadratic: f64, weight_n: f64) -> f64 {
    ((linear * REFERENCE_M_S + quadratic * REFERENCE_M_S * REFERENCE_M_S) / weight_n).atan()
}

/// Exponent of the thrust curve: a rotor commanded by speed is quadratic.
fn expo(law: ThrustLaw) -> f64 {
    match law {
        ThrustLaw::Speed { .. } => 1.0,
        ThrustLaw::Curve { expo, .. } => expo,
    }
}

/// deg/s: the simulator damps with `400 deg / refRotRate` in 1/s.
fn reference_rate(source: &mut Source<'_>, damping: &[f64; 3]) -> Option<f64> {
    let j = &source.vehicle.body.inertia_kg_m2;
    let rates: Vec<f64> = (0..3).map(|axis| damping[axis] / j[(axis, axis)]).collect();
    let mean = rates.iter().sum::<f64>() / 3.0;
    if mean <= 0.0 {
        source.note(
            "no damping of the rotation was found; refRotRate keeps ArduPilot's default, which has some",
        );
        return None;
    }
    if rates.iter().any(|rate| (rate - mean).abs() > 0.05 * mean) {
        source.note(format!(
            "the simulator damps all axes alike: refRotRate is from the mean of {:.3}, {:.3}, {:.3} 1/s",
            rates[0], rates[1], rates[2]
        ));
    }
    Some(400.0_f64.to_radians() / mean)
}
