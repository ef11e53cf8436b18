//! ArduPilot's simulator: a frame file for `--model "x:frame.json"`.
//!
//! libraries/SITL/SIM_Frame.cpp and SIM_Motor.cpp. With `u` the command of a motor, `W` the weight, `rho` the air's
//! density and `A` the discs of all `N` rotors:
//!
//! - thrust `W / (N hoverThrOut) ((1 - propExpo) u + propExpo u^2)`: `hoverThrOut` is a share of full thrust, no
//!   command. In a climb it loses `W / N (v / v_h)^2` with `v_h = 2 P / W` and `P = refVoltage refCurrent`;
//! - reaction torque `motorN_yaw 0.05 diagonal_size u T`;
//! - momentum drag at each hub, the same along all axes, `mdrag_coef sqrt(rho A T / N) v`: of the whole vehicle at
//!   hover `mdrag_coef sqrt(rho A W) v`;
//! - bluff-body drag `c |v_i| v_i` along each axis, where `c` is what `refSpd` at the tilt `refAngle` leaves:
//!   `W tan(a) = d v cos(a)^1.5 + c v^2`;
//! - rotation damped by `400 deg / refRotRate` of the rate, and no gyroscopic torque;
//! - motor positions from the centre of mass, forward-right-down.
//!
//! Thrust and drag go with the density over that at `refAlt`.

use super::axes::frd;
use super::drag::{RotorDrag, damping};
use super::error::ExportError;
use super::notes::line_comments;
use super::source::{Exported, Source};
use crate::text::json_pretty;
use crate::vehicle::{Actuator, Propulsion, PwmRange, ThrustLaw};
use nalgebra::Vector3;
use serde_json::{Map, Value, json};
use std::f64::consts::PI;

const FORMAT: &str = "ardupilot-sitl";
/// m/s at which the reference flight of the drag is.
const REFERENCE_M_S: f64 = 15.0;
/// m, where the simulator's vehicle stands unless told otherwise.
const HOME_M: f64 = 584.0;
/// degrees Celsius of the standard atmosphere there. Versions that take the density from it have 25 without it, 5 % thinner air.
const HOME_C: f64 = 11.2;
/// kg/m^3 of the standard atmosphere there.
const HOME_DENSITY_KG_M3: f64 = 1.1578;
/// V, the simulator's full battery. The highest that it reports.
const BATTERY_V: f64 = 50.4;
/// m/s, the simulator's outflow at hover: so fast that a climb costs no thrust beside the drag. With 80 m/s, the loss of a vehicle of
/// 4.6 kg was 8 % of its quadratic drag.
const OUTFLOW_M_S: f64 = 400.0;
/// Pulse widths of no and of full thrust with ArduPilot's default parameters.
const PULSES: PwmRange = PwmRange { min_us: 1150.0, max_us: 1950.0 };

pub(super) fn write(mut source: Source<'_>) -> Result<Exported, ExportError> {
    let arms = source.arms_m();
    let count = arms.len() as f64;
    let propulsion = source.vehicle.propulsion;
    let radius_m = propulsion
        .rotor_radius_m
        .ok_or(ExportError::Missing { format: FORMAT, what: "rotor_radius (for its drag and thrust)" })?;
    let weight_n = source.vehicle.body.mass_kg * source.vehicle.gravity_m_s2;
    let disc_m2 = PI * radius_m * radius_m * count;
    let air = Air { density_kg_m3: HOME_DENSITY_KG_M3, disc_m2, weight_n };
    let rotor_drag = RotorDrag::of(&mut source);
    rotor_drag.tell_growth(&mut source);
    let across = rotor_drag.even(&mut source, "mdrag_coef");
    let bluff = bluff_drag(&mut source);
    let diagonal_m = 2.0 * arms.iter().map(|arm| arm.norm()).fold(0.0, f64::max);
    let mut file = Map::new();
    let mut set = |key: &str, value: f64| file.insert(key.into(), json!(value));
    set("mass", source.vehicle.body.mass_kg);
    set("diagonal_size", diagonal_m);
    set("refSpd", REFERENCE_M_S);
    set("refAngle", air.reference_angle(across, bluff).to_degrees());
    set("refAlt", HOME_M);
    set("refTempC", HOME_C);
    set("refVoltage", BATTERY_V);
    set("refCurrent", air.hover_power_w() / BATTERY_V);
    set("maxVoltage", BATTERY_V);
    // the model's thrust does not go with this battery
    set("refBatRes", 0.0);
    set("battCapacityAh", 0.0);
    set("mdrag_coef", across / air.momentum());
    set("disc_area", disc_m2);
    set("hoverThrOut", weight_n / (count * propulsion.full_thrust_n()));
    set("propExpo", expo(propulsion.law));
    set("refRotRate", reference_rate(&mut source, &rotor_drag, &arms));
    pulses(&mut file, &mut source);
    file.insert("moment_inertia".into(), json!(moments_kg_m2(&mut source)));
    motors(&mut file, &source, &arms, diagonal_m);
    tell(&mut source, air.hover_power_w() / BATTERY_V);
    Ok(source.finish(|notes| {
        let head = line_comments("#", notes);
        let body = json_pretty(&Value::Object(file)).unwrap_or_default();
        // comments are the simulator's own: it blanks from # to the end of the line, after the first brace
        format!("{}{}\n", body.replacen('{', &format!("{{\n{head}"), 1), "")
    }))
}

/// mAh, ArduPilot's default of `BATT_CAPACITY`.
const DEFAULT_MAH: f64 = 3300.0;
/// mAh in one Ah, and s in one hour.
const MAH: f64 = 1000.0;
const HOUR_S: f64 = 3600.0;

/// What is the same for every model, the battery's current (A at hover), and the lag.
fn tell(source: &mut Source<'_>, hover_a: f64) {
    source.note("motors are in the model's own order; the simulator's frame must have as many, and its servo functions the same order");
    source.note(format!(
        "thrust and drag are the model's at the simulator's own home, {HOME_M} m above sea level; for a home elsewhere set refAlt to its altitude"
    ));
    source.note(format!(
        "battery and power were not identified, and those of the file are not the vehicle's: refVoltage times refCurrent makes the simulator's own loss of thrust in a climb, which the model does not have, a share of (v / {OUTFLOW_M_S})^2 at v m/s; SIM_BATT_VOLTAGE has to be {BATTERY_V} V, as by default"
    ));
    source.note(format!(
        "the simulator's current is {hover_a:.0} A at hover for that reason. It uses up a BATT_CAPACITY of {DEFAULT_MAH} mAh, the default, in {:.0} s: set BATT_CAPACITY to {:.0} mAh for an hour of hover. The thrust does not fall, because the simulator's battery has no capacity (battCapacityAh 0) and no resistance",
        HOUR_S * DEFAULT_MAH / (MAH * hover_a),
        MAH * hover_a
    ));
    let propulsion = &source.vehicle.propulsion;
    let hover_n = source.airframe.hover_thrust_n;
    let share = propulsion.command_from_thrust(hover_n) / torque_slope(propulsion, hover_n);
    source.note(format!(
        "the reaction torque goes with thrust times command in the simulator and with thrust in the model. motorN_yaw makes it change with the thrust at hover as in the model; the torque itself is {share:.2} of the model's there, and cancels between the rotors. A flight of the simulator identifies the model's izz with the model's torque_ratio, some percent too large from a violent turn. An izz for a torque per thrust that is that of hover is not the simulator's"
    ));
    source.note("versions with parameters SIM_FRM_* take their defaults from this file, so that none has to be set; one that was set by hand stays as it was set");
    source.turns_without_gyroscopic();
    if source.lags_s().is_some() {
        source.note("the simulator's rotors have no lag (slew_max limits their rate alone)");
        source.refuse("motor_lag");
    }
}

/// The air that the frame file works with.
struct Air {
    density_kg_m3: f64,
    /// of all rotors
    disc_m2: f64,
    weight_n: f64,
}

impl Air {
    /// kg/s: the momentum drag of the vehicle at hover for a coefficient of one, N/(m/s).
    fn momentum(&self) -> f64 {
        (self.density_kg_m3 * self.disc_m2 * self.weight_n).sqrt()
    }

    /// W at hover.
    fn hover_power_w(&self) -> f64 {
        0.5 * OUTFLOW_M_S * self.weight_n
    }

    /// Tilt (rad) of the level flight at the reference speed that leaves `quadratic` (N/(m/s)^2) beside `linear`
    /// (N/(m/s)) by the simulator's equation. The left side of it grows with the tilt, the right side falls.
    fn reference_angle(&self, linear: f64, quadratic: f64) -> f64 {
        let (mut low, mut high) = (0.0_f64, 0.5 * PI);
        for _ in 0..60 {
            let angle = f64::midpoint(low, high);
            let momentum_n = linear * REFERENCE_M_S * angle.cos().powf(1.5);
            let short = self.weight_n * angle.tan() < momentum_n + quadratic * REFERENCE_M_S * REFERENCE_M_S;
            if short { low = angle } else { high = angle }
        }
        high
    }
}

/// N/(m/s)^2, the same along all axes.
fn bluff_drag(source: &mut Source<'_>) -> f64 {
    let c = ["cx", "cy", "cz"].map(|axis| source.take("quadratic_drag", axis));
    let across = f64::midpoint(c[0], c[1]);
    if c.iter().any(|axis| (axis - across).abs() > 0.05 * across) {
        source.note(format!(
            "the simulator's bluff-body drag is the same along all axes: the mean across the rotor axis is taken; the model has {:.5}, {:.5}, {:.5} N/(m/s)^2",
            c[0], c[1], c[2]
        ));
    }
    if across > 0.0 && source.take("quadratic_drag", "by_face") < 0.95 {
        source.note("the simulator's bluff-body drag along an axis goes with the speed along that axis alone, the model's with the whole airspeed");
    }
    across
}

/// The pulse widths of no and of full thrust.
fn pulses(file: &mut Map<String, Value>, source: &mut Source<'_>) {
    let range = match source.vehicle.propulsion.actuator {
        Actuator::Pwm(Some(range)) => range,
        Actuator::Pwm(None) | Actuator::Speed | Actuator::Thrust => PULSES,
    };
    file.insert("pwmMin".into(), json!(range.min_us));
    file.insert("pwmMax".into(), json!(range.max_us));
    file.insert("spin_min".into(), json!(0.0));
    file.insert("spin_max".into(), json!(1.0));
    source.note(format!(
        "a motor turns from {} us on and has full thrust at {} us: MOT_PWM_MIN, MOT_PWM_MAX, MOT_SPIN_MIN and MOT_SPIN_MAX of the autopilot have to say the same, and MOT_THST_EXPO {}; identify a flight of the simulator with these pulse widths",
        range.min_us,
        range.max_us,
        expo(source.vehicle.propulsion.law)
    ));
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
fn motors(file: &mut Map<String, Value>, source: &Source<'_>, arms: &[Vector3<f64>], diagonal_m: f64) {
    let reaction = source.vehicle.propulsion.torque_per_thrust_m
        / (0.05 * diagonal_m * torque_slope(&source.vehicle.propulsion, source.airframe.hover_thrust_n));
    file.insert("num_motors".into(), json!(arms.len()));
    for (number, (arm, rotor)) in (1..).zip(arms.iter().zip(&source.vehicle.rotors)) {
        file.insert(format!("motor{number}_position"), json!(frd(arm)));
        file.insert(format!("motor{number}_vector"), json!([0.0, 0.0, -1.0]));
        // about z down: opposite to about z up
        file.insert(format!("motor{number}_yaw"), json!(-rotor.spin.yaw_sign() * reaction));
    }
}

/// `d(u T) / dT` at hover (-): how the simulator's reaction torque changes with the thrust of a rotor.
fn torque_slope(propulsion: &Propulsion, hover_thrust_n: f64) -> f64 {
    let (u, expo) = (propulsion.command_from_thrust(hover_thrust_n), expo(propulsion.law));
    u + u * (1.0 - expo + expo * u) / (1.0 - expo + 2.0 * expo * u)
}

/// Exponent of the thrust curve: a rotor commanded by speed is quadratic.
fn expo(law: ThrustLaw) -> f64 {
    match law {
        ThrustLaw::Speed { .. } => 1.0,
        ThrustLaw::Curve { expo, .. } => expo,
    }
}

/// Damping below which there is none, 1/s. Only words depend on it.
const LEAST_DAMPING_1_S: f64 = 0.1;

/// deg/s: the simulator damps with `400 deg / refRotRate` in 1/s, and does not where that is 0. Its drag at the hubs
/// damps as well.
fn reference_rate(source: &mut Source<'_>, drag: &RotorDrag, arms_m: &[Vector3<f64>]) -> f64 {
    let own = Vector3::from(["bx", "by", "bz"].map(|axis| source.take("angular_damping", axis)));
    let of_simulator = damping(&Vector3::repeat(drag.across()), arms_m);
    let missing = own + damping(&drag.at_hubs, arms_m) - of_simulator;
    let rates = missing.component_div(&source.vehicle.body.inertia_kg_m2.diagonal());
    let mean = rates.mean();
    if mean < -LEAST_DAMPING_1_S {
        // its drag at the hubs cannot be less than all of it, and there is no damping below none
        source.note(format!(
            "all of the simulator's drag acts at its hubs, the model's in part only, and that damps the rotation more than in the model: \
             by {:.3}, {:.3}, {:.3} 1/s about x, y, z (less where that is negative). No refRotRate takes this away, so it is 0 (none)",
            -rates.x, -rates.y, -rates.z
        ));
    } else if mean > 0.0 && rates.iter().any(|rate| (rate - mean).abs() > 0.05 * mean.max(LEAST_DAMPING_1_S))
    {
        source.note(format!(
            "the simulator damps all axes alike beside the drag at its hubs: refRotRate is from the mean of {:.3}, {:.3}, {:.3} 1/s",
            rates.x, rates.y, rates.z
        ));
    }
    if mean > 0.0 { 400.0_f64.to_radians() / mean } else { 0.0 }
}
