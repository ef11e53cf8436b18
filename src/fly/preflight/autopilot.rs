//! The trajectory against what the autopilot makes of a setpoint. A limit that it exceeds makes the
//! vehicle miss it, and the miss looks like physics that is not there.

use super::Extremes;
use crate::autopilot::Autopilot;
use crate::fly::finding::Finding;
use crate::fly::parameters::Parameters;
use crate::units::deg_from_rad;

/// One limit: what it bounds, its parameter (older name), how many of its units make one of SI, the value
/// along the path in SI (degrees for angles).
struct Limit {
    what: &'static str,
    name: &'static str,
    per_si: f64,
    needed: f64,
    unit: &'static str,
}

/// Reserve that the controller needs above what the trajectory asks for.
const RESERVE: f64 = 1.3;

pub(super) fn findings(parameters: &Parameters, extremes: &Extremes) -> Vec<Finding> {
    let limits = match parameters.autopilot {
        Autopilot::ArduPilot => ardupilot(extremes),
        Autopilot::Px4 => px4(extremes),
        Autopilot::Other | Autopilot::Unknown => return Vec::new(),
    };
    let (mut findings, mut silent) = (Vec::new(), Vec::new());
    for limit in &limits {
        match parameters.get(limit.name) {
            None => silent.push(parameters.name_of(limit.name)),
            // zero or below stands for no limit
            Some(value) if value > 0.0 && value < limit.per_si * limit.needed => {
                findings.push(too_low(parameters, limit, value));
            }
            Some(_) => {}
        }
    }
    if !silent.is_empty() {
        findings.push(Finding::warning(
            "autopilot limits",
            "the limits that the autopilot puts on a setpoint",
            format!("no answer for {}", silent.join(", ")),
            "look them up: one that is too low makes the vehicle miss the trajectory",
        ));
    }
    if findings.is_empty() {
        findings.push(Finding::ok(
            "autopilot limits",
            "limits above what the trajectory asks for",
            format!("all {} are", limits.len()),
        ));
    }
    findings
}

fn too_low(parameters: &Parameters, limit: &Limit, value: f64) -> Finding {
    let name = parameters.name_of(limit.name);
    let advice = parameters.in_own_unit(limit.name, limit.per_si * limit.needed * RESERVE);
    Finding::warning(
        "autopilot limits",
        format!("{} of at least {:.2} {}", limit.what, limit.needed, limit.unit),
        format!(
            "{:.2} {} ({name} = {:.4})",
            value / limit.per_si,
            limit.unit,
            parameters.in_own_unit(limit.name, value)
        ),
        format!(
            "the vehicle will miss the trajectory, by metres if this is far too low: set {name} to {advice:.2} \
             or more, or plan for lower limits"
        ),
    )
}

fn ardupilot(extremes: &Extremes) -> Vec<Limit> {
    let limit = |what, name, per_si, needed, unit| Limit { what, name, per_si, needed, unit };
    vec![
        limit("horizontal speed", "WPNAV_SPEED", 100.0, extremes.horizontal_speed_m_s, "m/s"),
        limit("climb speed", "WPNAV_SPEED_UP", 100.0, extremes.up_speed_m_s, "m/s"),
        limit("descent speed", "WPNAV_SPEED_DN", 100.0, extremes.down_speed_m_s, "m/s"),
        limit(
            "horizontal acceleration",
            "WPNAV_ACCEL",
            100.0,
            extremes.horizontal_acceleration_m_s2,
            "m/s^2",
        ),
        limit("vertical acceleration", "WPNAV_ACCEL_Z", 100.0, extremes.vertical_acceleration_m_s2, "m/s^2"),
        limit("horizontal jerk", "PSC_JERK_XY", 1.0, extremes.horizontal_jerk_m_s3, "m/s^3"),
        limit("vertical jerk", "PSC_JERK_Z", 1.0, extremes.vertical_jerk_m_s3, "m/s^3"),
        limit("tilt", "ANGLE_MAX", 100.0, deg_from_rad(extremes.tilt_rad), "deg"),
    ]
}

fn px4(extremes: &Extremes) -> Vec<Limit> {
    let limit = |what, name, needed, unit| Limit { what, name, per_si: 1.0, needed, unit };
    vec![
        limit("horizontal speed", "MPC_XY_VEL_MAX", extremes.horizontal_speed_m_s, "m/s"),
        limit("climb speed", "MPC_Z_VEL_MAX_UP", extremes.up_speed_m_s, "m/s"),
        limit("descent speed", "MPC_Z_VEL_MAX_DN", extremes.down_speed_m_s, "m/s"),
        limit("tilt", "MPC_TILTMAX_AIR", deg_from_rad(extremes.tilt_rad), "deg"),
        limit("yaw rate", "MC_YAWRATE_MAX", deg_from_rad(extremes.yaw_rate_rad_s), "deg/s"),
    ]
}
