//! The trajectory against what the autopilot makes of a setpoint. A limit that it exceeds makes the
//! vehicle miss it, and the miss looks like physics that is not there.

use crate::fly::finding::Finding;
use crate::fly::parameters::{Parameters, has_bit};
use crate::plan::Extremes;
use crate::recording::Autopilot;
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

const SUBJECT: &str = "autopilot limits";
/// Bits of GUID_OPTIONS, and what is not stabilised then.
const NOT_FOLLOWED: &[(u32, &str)] = &[(4, "position"), (5, "velocity")];
/// Reserve that the controller needs above what the trajectory asks for.
const RESERVE: f64 = 1.3;

pub(super) fn findings(parameters: &Parameters, extremes: &Extremes) -> Vec<Finding> {
    let limits = match parameters.autopilot {
        Autopilot::ArduPilot => ardupilot(extremes),
        Autopilot::Px4 => px4(extremes),
        Autopilot::Other | Autopilot::Unknown => return Vec::new(),
    };
    let (mut findings, mut silent) = (Vec::from_iter(not_followed(parameters)), Vec::new());
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
            SUBJECT,
            "the limits that the autopilot puts on a setpoint",
            format!("no answer for {}", silent.join(", ")),
            "look them up: one that is too low makes the vehicle miss the trajectory",
        ));
    }
    if findings.iter().all(|finding| finding.subject != SUBJECT) {
        findings.push(Finding::ok(
            SUBJECT,
            "limits above what the trajectory asks for",
            format!("all {} are", limits.len()),
        ));
    }
    findings
}

/// GUIDED follows no place or velocity while these bits of GUID_OPTIONS are set (`ModeGuided::posvelaccel_control_run`).
fn not_followed(parameters: &Parameters) -> Option<Finding> {
    if parameters.autopilot != Autopilot::ArduPilot {
        return None;
    }
    let mask = parameters.get("GUID_OPTIONS")?;
    let set: Vec<_> = NOT_FOLLOWED.iter().filter(|(bit, _)| has_bit(mask, *bit)).collect();
    let without = set.iter().fold(mask, |mask, (bit, _)| mask - f64::from(1_u32 << bit));
    let names: Vec<String> = set.iter().map(|(bit, what)| format!("{what} is not (bit {bit})")).collect();
    (!set.is_empty()).then(|| {
        Finding::refusal(
            "guided options",
            "position and velocity stabilised in GUIDED",
            format!("{} (GUID_OPTIONS = {mask})", names.join(", ")),
            format!("the vehicle would drift: set GUID_OPTIONS to {without}"),
        )
    })
}

fn too_low(parameters: &Parameters, limit: &Limit, value: f64) -> Finding {
    let name = parameters.name_of(limit.name);
    let advice = parameters.in_own_unit(limit.name, limit.per_si * limit.needed * RESERVE);
    Finding::warning(
        SUBJECT,
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
