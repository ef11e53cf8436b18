//! Which parameter can be identified, how well, and what is missing for it.

use super::assess::Assessment;
use super::inspection::Outlook;
use crate::autopilot::VehicleKind;
use crate::estimate::{
    Estimated, Finding, NAMES, Nominal, THETA, UNITS, finding, rescaled, scale_of, theta_of,
};
use crate::recording::{Quantity, StreamKey, StreamStats};
use crate::signals::{LEAST_ACTUATOR_HZ, LEAST_BODY_RATE_HZ, SignalsError};
use crate::vehicle::{Anchor, Vehicle};

/// Least rms of the angular acceleration for an identification of inertia, rad/s^2. Chosen; not measured.
pub(super) const LEAST_ANGULAR_ACCELERATION: f64 = 0.1;
/// Least usable time of flight, s. Chosen; not measured.
pub(super) const LEAST_USABLE_S: f64 = 2.0;
/// Body axis or axes of each entry of the inertia, in `Theta`'s order from its second on.
const AXES: [(usize, usize); THETA - 1] = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)];
/// Names of the body axes.
pub(super) const AXIS_NAMES: [&str; 3] = ["roll", "pitch", "yaw"];

/// What the judgement rests on.
#[derive(Debug, Clone, Copy)]
pub(super) struct Evidence<'a> {
    pub streams: &'a [(StreamKey, usize, StreamStats)],
    pub assessment: &'a Assessment,
    pub vehicle: Option<&'a Vehicle>,
    /// parameters of the autopilot's thrust curve that the log does not hold
    pub missing_curve: Option<&'static str>,
    /// what kind of vehicle it is of
    pub kind: Option<VehicleKind>,
    /// whether it was ever armed, where it tells
    pub armed: Option<bool>,
    /// the log's messages carry times
    pub timed: bool,
    /// how to make the vehicle log more, where it wrote the log
    pub logging: Option<&'static str>,
}

impl Evidence<'_> {
    /// Rate of the fastest stream of a quantity that moves, Hz.
    pub(super) fn rate_hz(&self, quantity: Quantity) -> Option<f64> {
        self.streams
            .iter()
            .filter(|(key, _, stats)| {
                key.quantity == quantity && stats.count >= 10 && !stats.all_zero && !stats.is_constant()
            })
            .map(|(_, _, stats)| stats.rate_hz)
            .reduce(f64::max)
    }

    /// Rate of what tells the thrust, Hz. Commands that are logged seldom are rebuilt from torque and thrust setpoints.
    pub(super) fn actuator_hz(&self) -> Option<f64> {
        let quantities = [Quantity::RotorSpeed, Quantity::ActuatorCommand, Quantity::Wrench];
        let logged = quantities.into_iter().filter_map(|quantity| self.rate_hz(quantity)).reduce(f64::max)?;
        let thrust = [Quantity::ThrustVectorSetpoint, Quantity::ThrustSetpoint];
        let thrust_hz = thrust.into_iter().filter_map(|quantity| self.rate_hz(quantity)).reduce(f64::max);
        let rebuilt = self.rate_hz(Quantity::TorqueSetpoint).filter(|_| thrust_hz.is_some());
        Some(rebuilt.map_or(logged, |rebuilt| logged.max(rebuilt)))
    }

    /// Something tells the force along the thrust.
    pub(super) fn has_vertical_motion(&self) -> bool {
        let has = |quantity| self.rate_hz(quantity).is_some();
        has(Quantity::SpecificForce)
            || has(Quantity::WorldAcceleration)
            || (has(Quantity::Attitude) && has(Quantity::AngularRate) && has(Quantity::Velocity))
    }

    /// rms about an axis, rad/s^2.
    pub(super) fn angular_acceleration(&self, axis: usize) -> Option<f64> {
        self.assessment.excitation.as_ref()?.angular_acceleration_rms_rad_s2.map(|rms| rms[axis])
    }

    /// Why nothing at all can be identified.
    pub(super) fn nothing(&self) -> Option<String> {
        if let Some(kind) = self.kind.filter(|kind| *kind != VehicleKind::Multirotor) {
            return Some(format!("it is of a {}, and a multirotor is needed", kind.name()));
        }
        if !self.timed {
            return Some("its messages carry no time of the vehicle's".into());
        }
        if self.streams.is_empty() {
            return Some("it holds no stream that is known here".into());
        }
        let flown = self.assessment.flight.airborne_s >= LEAST_USABLE_S;
        match self.armed {
            Some(false) => return Some("the vehicle was never armed".into()),
            Some(true) if !flown => return Some("the vehicle was armed and never in the air".into()),
            _ => {}
        }
        if self.actuator_hz().is_none() {
            return Some("no actuator outputs".into());
        }
        if !flown {
            return Some("no flight".into());
        }
        if let Some(refusal) = &self.assessment.refusal {
            return Some(match refusal {
                // which of them, and how fast, is in the advice
                SignalsError::TooSlow { .. } => "streams are sampled too slowly".to_owned(),
                other => other.to_string(),
            });
        }
        (self.assessment.flight.usable_s < LEAST_USABLE_S).then(|| "no stretch of flight can be used".into())
    }

    /// Why a parameter cannot be identified, as far as streams and motion tell.
    fn obstacle(&self, index: usize) -> Option<String> {
        if let Some(nothing) = self.nothing() {
            return Some(nothing);
        }
        if index == 0 {
            let missing = !self.has_vertical_motion();
            return missing.then(|| {
                "no vertical motion: neither accelerometer nor attitude, rates and velocity".into()
            });
        }
        let Some(rate_hz) = self.rate_hz(Quantity::AngularRate) else { return Some("no body rates".into()) };
        let slowest = [
            ("body rates", Some(rate_hz), LEAST_BODY_RATE_HZ),
            ("actuators", self.actuator_hz(), LEAST_ACTUATOR_HZ),
        ];
        for (what, hz, least_hz) in slowest {
            if let Some(hz) = hz.filter(|hz| *hz < least_hz) {
                return Some(format!("{what} at {hz:.0} Hz: too slow"));
            }
        }
        let (first, second) = AXES[index - 1];
        [first, second].into_iter().find_map(|axis| {
            let rms = self.angular_acceleration(axis).filter(|rms| *rms < LEAST_ANGULAR_ACCELERATION)?;
            Some(format!("angular acceleration in {} only {rms:.2} rad/s^2 rms", AXIS_NAMES[axis]))
        })
    }
}

/// One entry a parameter, in `Theta`'s order.
pub(super) fn outlook(evidence: &Evidence<'_>) -> Vec<Outlook> {
    (0..THETA).map(|index| of(evidence, index)).collect()
}

fn of(evidence: &Evidence<'_>, index: usize) -> Outlook {
    let blank = |name, unit| Outlook {
        name,
        status: "not_determined",
        std: None,
        unit,
        std_relative: None,
        reason: None,
    };
    let none = blank(NAMES[index], UNITS[index]);
    if let (Some(vehicle), Some(expected)) = (evidence.vehicle, &evidence.assessment.expected) {
        let weighed = vehicle.anchor == Anchor::Mass;
        // a weighed vehicle's thrust has the mass' place: only their ratio comes out of a flight
        let none = if weighed && index == 0 { blank("thrust_scale", "1") } else { none };
        return match expected_finding(vehicle, expected, index) {
            Finding::Determined { value, std } if weighed && index == 0 => Outlook {
                status: "determined",
                std: Some(vehicle.body.mass_kg / value * (std / value)),
                std_relative: Some(std / value),
                ..none
            },
            Finding::Determined { std, .. } => Outlook {
                status: "determined",
                std: Some(std),
                std_relative: Some(std / size_of(vehicle, expected, index)),
                ..none
            },
            Finding::NotDetermined { reason } => Outlook { reason: Some(reason), ..none },
            Finding::Given { .. } => Outlook { reason: Some("known beforehand".into()), ..none },
        };
    }
    match evidence.obstacle(index) {
        Some(reason) => Outlook { reason: Some(reason), ..none },
        None => Outlook { status: "possible", ..none },
    }
}

/// A parameter's size: the larger of what the vehicle file says and what the log does, as [`finding`] judges.
fn size_of(vehicle: &Vehicle, expected: &Estimated, index: usize) -> f64 {
    let stated = scale_of(&theta_of(&vehicle.body), index);
    let theta = match vehicle.anchor {
        Anchor::Mass => rescaled(expected, vehicle.body.mass_kg).theta,
        Anchor::Thrust => expected.theta,
    };
    stated.max(scale_of(&theta.map(f64::abs), index))
}

/// What `identify` will say, on the scale that the vehicle's anchor sets.
fn expected_finding(vehicle: &Vehicle, expected: &Estimated, index: usize) -> Finding {
    let nominal = Nominal::of(vehicle);
    let of_mass = finding(expected, &nominal, 0);
    match (vehicle.anchor, of_mass) {
        (Anchor::Mass, Finding::Determined { .. }) if index > 0 => {
            finding(&rescaled(expected, vehicle.body.mass_kg), &nominal, index)
        }
        (Anchor::Mass, unknown) if index > 0 => match unknown {
            Finding::NotDetermined { reason } => {
                Finding::NotDetermined { reason: format!("the thrust scale is not determined: {reason}") }
            }
            other => other,
        },
        _ => finding(expected, &nominal, index),
    }
}
