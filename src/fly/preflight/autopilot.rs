//! The trajectory against the autopilot's limits. If it exceeds a limit, the vehicle deviates from it, and the
//! deviation looks like missing physics.

use crate::autopilot::{Autopilot, Bounded};
use crate::fly::finding::Finding;
use crate::fly::parameters::{Parameters, has_bit};
use crate::plan::Extremes;
use crate::units::deg_from_rad;

/// A limit of the autopilot that a path does not keep.
#[derive(Debug, Clone, PartialEq)]
pub struct LimitShortfall {
    /// what is bounded
    pub bounded: Bounded,
    /// the limit, in the unit of what is bounded
    pub limit: f64,
    /// the demand of the path, in the same unit
    pub needed: f64,
    /// its parameter, as this autopilot calls it
    pub name: String,
    /// the parameter's value, in its own unit
    pub value: f64,
    /// the value with which a controller follows the path, in its own unit
    pub advised: f64,
}

const SUBJECT: &str = "autopilot limits";
/// Bits of GUID_OPTIONS, and the quantity that is not stabilised if they are set.
const NOT_FOLLOWED: &[(u32, &str)] = &[(4, "position"), (5, "velocity")];
/// Factor between the limit that a controller needs and the demand of the trajectory. With less the controller would
/// sit at its limit in wind.
pub const LIMIT_RESERVE: f64 = 1.3;

/// The autopilot's limits that a path does not keep, of those whose parameters are known.
#[must_use]
pub fn limit_shortfalls(parameters: &Parameters, extremes: &Extremes) -> Vec<LimitShortfall> {
    let Some(stack) = parameters.autopilot.stack() else { return Vec::new() };
    let one = |(bounded, name): &(Bounded, &'static str)| {
        let per_base = stack.parameters.find(name).map_or(1.0, |entry| entry.unit.per_base);
        let (value, needed) = (parameters.get(name)?, needed(*bounded, extremes));
        // zero or below stands for no limit
        (value > 0.0 && value < per_base * needed).then(|| LimitShortfall {
            bounded: *bounded,
            limit: value / per_base,
            needed,
            name: parameters.name_of(name).to_owned(),
            value: parameters.in_own_unit(name, value),
            advised: parameters.in_own_unit(name, per_base * needed * LIMIT_RESERVE),
        })
    };
    stack.limits.iter().filter_map(one).collect()
}

pub(super) fn findings(parameters: &Parameters, extremes: &Extremes) -> Vec<Finding> {
    let Some(stack) = parameters.autopilot.stack() else { return Vec::new() };
    let mut findings = Vec::from_iter(not_followed(parameters));
    findings.extend(limit_shortfalls(parameters, extremes).iter().map(too_low));
    let silent = stack.limits.iter().filter(|(_, name)| parameters.get(name).is_none());
    let silent: Vec<&str> = silent.map(|(_, name)| parameters.name_of(name)).collect();
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
            format!("all {} are", stack.limits.len()),
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

fn too_low(shortfall: &LimitShortfall) -> Finding {
    let LimitShortfall { bounded, limit, needed, name, value, advised } = shortfall;
    let unit = bounded.unit();
    Finding::warning(
        SUBJECT,
        format!("{} of at least {needed:.2} {unit}", bounded.name()),
        format!("{limit:.2} {unit} ({name} = {value:.4})"),
        format!(
            "the vehicle will miss the trajectory, by metres if this is far too low: set {name} to {advised:.2} \
             or more, or plan for lower limits"
        ),
    )
}

/// Demand of the path, in the unit of the bounded quantity.
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
