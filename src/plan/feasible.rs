//! Detection of limits that contradict each other or the vehicle, before the search.

use crate::vehicle::{Limits, Vehicle};

/// A contradiction between two limits, or between a limit and the vehicle or the start.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{first} and {second} cannot both hold: {why}")]
pub struct Conflict {
    /// one limit with its value
    pub first: String,
    /// the other limit, or the requirement of the vehicle or of the start
    pub second: String,
    /// the reason
    pub why: String,
}

fn conflict(first: String, second: String, why: &str) -> Result<(), Conflict> {
    Err(Conflict { first, second, why: why.to_owned() })
}

/// The requested start: x, y and z if they are prescribed (m), yaw (rad).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct StartPlace {
    /// m, north; `None`: 0, or the planner's choice for a plan that is to rest inside
    pub x_m: Option<f64>,
    /// m, west; the same
    pub y_m: Option<f64>,
    /// m, up; `None`: the planner chooses the height
    pub z_m: Option<f64>,
    /// rad
    pub yaw_rad: f64,
}

/// Refuses limits that no flight can keep. If they pass, hovering at the start keeps every limit.
///
/// # Errors
/// The first conflict found.
pub fn feasible(limits: &Limits, vehicle: &Vehicle, start: &StartPlace) -> Result<(), Conflict> {
    positive_limits(limits)?;
    ordered("z_min_m", limits.z_min_m, "z_max_m", limits.z_max_m)?;
    ordered(
        "vertical_acceleration_min_m_s2",
        limits.vertical_acceleration_min_m_s2,
        "vertical_acceleration_max_m_s2",
        limits.vertical_acceleration_max_m_s2,
    )?;
    start_inside(limits, start)?;
    rest_allowed(limits)?;
    hover_possible(limits, vehicle)
}

fn positive_limits(limits: &Limits) -> Result<(), Conflict> {
    let sizes = [
        ("roll_max", limits.roll_max_rad),
        ("pitch_max", limits.pitch_max_rad),
        ("yaw_max", limits.yaw_max_rad),
        ("yaw_rate_max", limits.yaw_rate_max_rad_s),
        ("yaw_acceleration_max", limits.yaw_acceleration_max_rad_s2),
        ("x_max_m", limits.x_max_m),
        ("y_max_m", limits.y_max_m),
        ("speed_max_m_s", limits.speed_max_m_s),
        ("acceleration_max_m_s2", limits.acceleration_max_m_s2),
        ("thrust_max_n", limits.thrust_max_n),
        ("torque_max_nm", limits.torque_max_nm),
    ];
    for (name, size) in sizes {
        if let Some(size) = size.filter(|size| *size <= 0.0 || size.is_nan()) {
            let asked = "an excitation".to_owned();
            return conflict(format!("{name} = {size}"), asked, "it leaves no room to move");
        }
    }
    Ok(())
}

fn ordered(low_name: &str, low: Option<f64>, high_name: &str, high: Option<f64>) -> Result<(), Conflict> {
    match (low, high) {
        (Some(low), Some(high)) if low >= high || low.is_nan() || high.is_nan() => conflict(
            format!("{low_name} = {low}"),
            format!("{high_name} = {high}"),
            "the lower bound is not below the upper one",
        ),
        _ => Ok(()),
    }
}

fn start_inside(limits: &Limits, start: &StartPlace) -> Result<(), Conflict> {
    let negative = |limit: Option<f64>| limit.map(|value| -value);
    // nothing of a place that is not prescribed is outside
    let [x, y, z] = [start.x_m, start.y_m, start.z_m].map(|value| value.unwrap_or(f64::NAN));
    let places = [
        ("x", x, "x_max_m", negative(limits.x_max_m), limits.x_max_m),
        ("y", y, "y_max_m", negative(limits.y_max_m), limits.y_max_m),
        ("yaw", start.yaw_rad, "yaw_max", negative(limits.yaw_max_rad), limits.yaw_max_rad),
        ("z", z, "z_min_m", limits.z_min_m, None),
        ("z", z, "z_max_m", None, limits.z_max_m),
    ];
    for (axis, value, name, min, max) in places {
        let broken = min.filter(|min| value < *min).or(max.filter(|max| value > *max));
        if let Some(limit) = broken {
            let place = format!("the start at {axis} = {value}");
            return conflict(format!("{name} (bound {limit})"), place, "the start lies outside");
        }
    }
    Ok(())
}

fn rest_allowed(limits: &Limits) -> Result<(), Conflict> {
    let rest = || "starting and ending at rest".to_owned();
    let why = "vertical acceleration is zero at rest";
    if let Some(min) = limits.vertical_acceleration_min_m_s2.filter(|min| *min > 0.0) {
        return conflict(format!("vertical_acceleration_min_m_s2 = {min}"), rest(), why);
    }
    if let Some(max) = limits.vertical_acceleration_max_m_s2.filter(|max| *max < 0.0) {
        return conflict(format!("vertical_acceleration_max_m_s2 = {max}"), rest(), why);
    }
    Ok(())
}

fn hover_possible(limits: &Limits, vehicle: &Vehicle) -> Result<(), Conflict> {
    let weight_n = vehicle.body.mass_kg * vehicle.gravity_m_s2;
    let weight = || format!("the weight of {weight_n:.3} N");
    if let Some(max) = limits.thrust_max_n.filter(|max| *max <= weight_n) {
        return conflict(format!("thrust_max_n = {max}"), weight(), "the vehicle could not hover");
    }
    let full_n = vehicle.propulsion.thrust_from_command_n(1.0) * vehicle.rotors.len() as f64;
    if full_n.is_finite() && full_n <= weight_n {
        return conflict(format!("full thrust of {full_n:.3} N"), weight(), "the vehicle could not hover");
    }
    Ok(())
}
