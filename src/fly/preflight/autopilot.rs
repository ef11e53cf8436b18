//! The trajectory against what the autopilot makes of a setpoint. A limit that it exceeds makes the
//! vehicle miss it, and the miss looks like physics that is not there.

use crate::autopilot::Bounded;
use crate::fly::finding::Finding;
use crate::fly::parameters::Parameters;
use crate::plan::Extremes;
use crate::units::deg_from_rad;

/// One limit: what it bounds, its parameter (older name), how many of its units make one of what is bounded, and what the
/// path asks for.
struct Limit {
    bounded: Bounded,
    name: &'static str,
    per_base: f64,
    needed: f64,
}

/// Reserve that the controller needs above what the trajectory asks for.
const RESERVE: f64 = 1.3;

pub(super) fn findings(parameters: &Parameters, extremes: &Extremes) -> Vec<Finding> {
    let Some(stack) = parameters.autopilot.stack() else { return Vec::new() };
    let (mut findings, mut silent) = (Vec::new(), Vec::new());
    for (bounded, name) in stack.limits {
        let per_base = stack.parameters.find(name).map_or(1.0, |entry| entry.unit.per_base);
        let limit = Limit { bounded: *bounded, name, per_base, needed: needed(*bounded, extremes) };
        match parameters.get(name) {
            None => silent.push(parameters.name_of(name)),
            // zero or below stands for no limit
            Some(value) if value > 0.0 && value < per_base * limit.needed => {
                findings.push(too_low(parameters, &limit, value));
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
            format!("all {} are", stack.limits.len()),
        ));
    }
    findings
}

fn too_low(parameters: &Parameters, limit: &Limit, value: f64) -> Finding {
    let name = parameters.name_of(limit.name);
    let advice = parameters.in_own_unit(limit.name, limit.per_base * limit.needed * RESERVE);
    Finding::warning(
        "autopilot limits",
        format!("{} of at least {:.2} {}", limit.bounded.name(), limit.needed, limit.bounded.unit()),
        format!(
            "{:.2} {} ({name} = {:.4})",
            value / limit.per_base,
            limit.bounded.unit(),
            parameters.in_own_unit(limit.name, value)
        ),
        format!(
            "the vehicle will miss the trajectory, by metres if this is far too low: set {name} to {advice:.2} \
             or more, or plan for lower limits"
        ),
    )
}

/// What the path asks for, in the unit of what is bounded.
fn needed(bounded: Bounded, extremes: &Extremes) -> f64 {
    match bounded {
        Bounded::HorizontalSpeed => extremes.horizontal_speed_m_s,
        Bounded::ClimbSpeed => extremes.up_speed_m_s,
        Bounded::DescentSpeed => extremes.down_speed_m_s,
        Bounded::HorizontalAcceleration => extremes.horizontal_acceleration_m_s2,
        Bounded::VerticalAcceleration => extremes.vertical_acceleration_m_s2,
        Bounded::HorizontalJerk => extremes.horizontal_jerk_m_s3,
        Bounded::VerticalJerk => extremes.vertical_jerk_m_s3,
        Bounded::Tilt => deg_from_rad(extremes.tilt_rad),
        Bounded::YawRate => deg_from_rad(extremes.yaw_rate_rad_s),
    }
}
