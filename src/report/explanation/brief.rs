//! Each effect in a few words with its one number, for a list of several.

use super::words::{called, point_of, rotor_name};
use crate::diagnose::{Named, NamedParameter};
use crate::report::number::{significant, spoken, with_error};
use crate::vehicle::Vehicle;

/// Name and, where `with_size` says so, size: `drag (0.41 +- 0.02 N per m/s)`.
#[must_use]
pub(super) fn brief(named: &Named, vehicle: &Vehicle, with_size: bool) -> String {
    let name = match named.id {
        "weak_rotor" => {
            let what = if value(named, "factor") < 1.0 { "weak" } else { "strong" };
            format!("a {what} {}", rotor_name(vehicle, value(named, "rotor")))
        }
        id => called(id).to_owned(),
    };
    match size(named).filter(|_| with_size) {
        // no parentheses within parentheses
        Some(size) => format!("{name} ({})", size.replace("(m/s)^2", "m^2/s^2")),
        None => name,
    }
}

fn get<'a>(named: &'a Named, name: &str) -> Option<&'a NamedParameter> {
    named.parameters.iter().find(|parameter| parameter.name == name)
}

fn value(named: &Named, name: &str) -> f64 {
    get(named, name).map_or(0.0, |parameter| parameter.value)
}

/// With its error where that needs no parentheses.
fn plain(value: f64, std: f64) -> String {
    let text = with_error(value, std);
    if text.starts_with('(') { significant(value, 3) } else { text }
}

/// The number by which the effect is known, with its unit.
fn size(named: &Named) -> Option<String> {
    let said = |name: &str, factor: f64, unit: &str| {
        let p = get(named, name)?;
        Some(format!("{} {unit}", plain(factor * p.value, factor.abs() * p.std)).trim_end().to_owned())
    };
    match named.id {
        "linear_drag" | "quadratic_drag" | "angular_damping" => Some(range(named)),
        "steady_wind" => {
            let (north, west) = (value(named, "north"), value(named, "west"));
            Some(format!("{} m/s from the {}", significant(north.hypot(west), 3), point_of(north, west)))
        }
        "mass_change" => {
            Some(format!("{} at {} s", said("delta", 1.0, "kg")?, significant(value(named, "time"), 3)))
        }
        "weak_rotor" => {
            let p = get(named, "factor")?;
            let change = 100.0 * (1.0 - p.value).abs();
            Some(format!("{} %", plain(change, 100.0 * p.std)))
        }
        "com_offset" => Some(format!("{} mm", significant(1e3 * norm(named), 3))),
        "imu_offset" => Some(format!("{} mm", significant(1e3 * norm(named), 2))),
        "thrust_tilt" | "imu_misalignment" | "frame_misalignment" => {
            Some(format!("{} deg", significant(norm(named).to_degrees(), 2)))
        }
        "motor_lag" => match (said("time_constant", 1e3, "ms"), said("time_constant_down", 1e3, "ms")) {
            (Some(up), Some(down)) => Some(format!("{up} up, {down} down")),
            (up, _) => up,
        },
        "transport_delay" => said("delay", 1e3, "ms"),
        "thrust_curve" => said("curvature", 100.0, "% about hover"),
        "battery_sag" => Some(format!("the voltage to the power of {}", said("exponent", 1.0, "")?)),
        "ground_effect" => match get(named, "ca") {
            Some(ca) if ca.value > 0.0 => {
                let at_two = ca.value * (-2.0 * value(named, "cb")).exp();
                Some(format!("{} % of the thrust two rotor radii up", significant(100.0 * at_two, 2)))
            }
            _ => said("rho", 1.0, "times Cheeseman and Bennett's"),
        },
        "gust" => said("sigma", 1.0, "m/s rms"),
        _ => {
            let first = named.parameters.first()?;
            Some(format!("{} {}", plain(first.value, first.std), spoken(first.unit)).trim_end().to_owned())
        }
    }
}

fn norm(named: &Named) -> f64 {
    let angles = named.parameters.iter().filter(|p| p.unit != "-");
    angles.map(|p| p.value * p.value).sum::<f64>().sqrt()
}

/// One number where the axes agree within two standard errors, else the least and the greatest.
fn range(named: &Named) -> String {
    let Some(first) = named.parameters.first() else { return String::new() };
    let same: Vec<&NamedParameter> = named.parameters.iter().filter(|p| p.unit == first.unit).collect();
    let unit = spoken(first.unit);
    let weight: f64 = same.iter().map(|p| p.std.powi(-2)).sum();
    let mean = same.iter().map(|p| p.value * p.std.powi(-2)).sum::<f64>() / weight;
    if weight.is_finite() && same.iter().all(|p| (p.value - mean).abs() < 2.0 * p.std) {
        return format!("{} {unit}", plain(mean, weight.powf(-0.5)));
    }
    let least = same.iter().map(|p| p.value).fold(f64::INFINITY, f64::min);
    let most = same.iter().map(|p| p.value).fold(f64::NEG_INFINITY, f64::max);
    format!("{} to {} {unit}", significant(least, 2), significant(most, 2))
}
