//! Which parameter can be identified, how well, and what is missing for it.

use super::evidence::Evidence;
use super::inspection::Outlook;
use super::missing_streams::{Need, lack};
use crate::estimate::{
    Estimated, Finding, INERTIA_ENTRIES, NAMES, Nominal, THETA, UNITS, finding, rescaled, scaling_mass,
    size_of,
};
use crate::vehicle::{Anchor, Vehicle};

/// Least rms of the angular acceleration for an identification of inertia, rad/s^2. A hover in calm air has as much;
/// the expected error then decides.
pub(super) const LEAST_ANGULAR_ACCELERATION: f64 = 0.1;
/// Names of the body axes.
pub(super) const AXIS_NAMES: [&str; 3] = ["roll", "pitch", "yaw"];

/// Why a parameter cannot be identified, as far as streams and motion tell.
fn obstacle(evidence: &Evidence<'_>, index: usize) -> Option<String> {
    if let Some(nothing) = evidence.nothing() {
        return Some(nothing);
    }
    if let Some(lack) = lack(evidence, Need::of_body(index)) {
        return Some(lack.reason);
    }
    let (first, second) = INERTIA_ENTRIES[index.checked_sub(1)?];
    [first, second].into_iter().find_map(|axis| {
        let rms = evidence.angular_acceleration(axis).filter(|rms| *rms < LEAST_ANGULAR_ACCELERATION)?;
        Some(format!("angular acceleration in {} only {rms:.2} rad/s^2 rms", AXIS_NAMES[axis]))
    })
}

/// One entry a parameter, in `Theta`'s order.
pub(super) fn outlook(evidence: &Evidence<'_>) -> Vec<Outlook> {
    (0..THETA).map(|index| of(evidence, index)).collect()
}

fn of(evidence: &Evidence<'_>, index: usize) -> Outlook {
    if let (Some(vehicle), Some(expected)) = (evidence.vehicle, &evidence.assessment.expected) {
        let found = judged(vehicle, expected, index);
        // a stream that is missing is told as without a vehicle
        let missing = || Some(lack(evidence, Need::of_body(index))?.reason);
        return match found.status {
            "not_determined" => Outlook { reason: missing().or(found.reason), ..found },
            _ => found,
        };
    }
    let none = blank(NAMES[index], UNITS[index]);
    // by a vehicle of assumed mass and size, what is not determined is not determined by any
    let tried = evidence.assumed.and_then(|(vehicle, body)| judged(vehicle, body, index).reason);
    match obstacle(evidence, index).or(tried) {
        Some(reason) => Outlook { reason: Some(reason), ..none },
        None => Outlook { status: "possible", ..none },
    }
}

fn blank(name: &'static str, unit: &'static str) -> Outlook {
    Outlook { name, status: "not_determined", std: None, unit, std_relative: None, reason: None }
}

/// What identification will say of a parameter.
pub(super) fn judged(vehicle: &Vehicle, expected: &Estimated, index: usize) -> Outlook {
    let weighed = vehicle.anchor == Anchor::Mass;
    // a weighed vehicle's thrust has the mass' place: only their ratio comes out of a flight
    let (name, unit) =
        if weighed && index == 0 { ("thrust_scale", "1") } else { (NAMES[index], UNITS[index]) };
    let none = blank(name, unit);
    match expected_finding(vehicle, expected, index) {
        Finding::Determined { value, std } if weighed && index == 0 => Outlook {
            status: "determined",
            std: Some(vehicle.body.mass_kg / value * (std / value)),
            std_relative: Some(std / value),
            ..none
        },
        Finding::Determined { std, .. } => Outlook {
            status: "determined",
            std: Some(std),
            std_relative: Some(std / size_here(vehicle, expected, index)),
            ..none
        },
        Finding::NotDetermined { reason } => Outlook { reason: Some(reason), ..none },
        Finding::Given { .. } => Outlook { reason: Some("known beforehand".into()), ..none },
    }
}

/// A parameter's size on the scale that the vehicle's anchor sets.
fn size_here(vehicle: &Vehicle, expected: &Estimated, index: usize) -> f64 {
    let theta = match vehicle.anchor {
        Anchor::Mass => rescaled(expected, vehicle.body.mass_kg).theta,
        Anchor::Thrust => expected.theta,
    };
    size_of(&theta, &Nominal::of(vehicle), index)
}

/// What `identify` will say, on the scale that the vehicle's anchor sets.
fn expected_finding(vehicle: &Vehicle, expected: &Estimated, index: usize) -> Finding {
    let nominal = Nominal::of(vehicle);
    if vehicle.anchor == Anchor::Thrust {
        return finding(expected, &nominal, index);
    }
    match scaling_mass(expected, &nominal) {
        Finding::Determined { .. } if index > 0 => {
            finding(&rescaled(expected, vehicle.body.mass_kg), &nominal, index)
        }
        Finding::NotDetermined { reason } if index > 0 => {
            Finding::NotDetermined { reason: format!("the thrust scale is not determined: {reason}") }
        }
        of_mass => of_mass,
    }
}
