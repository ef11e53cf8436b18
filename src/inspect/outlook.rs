//! Which parameter can be identified, how well, and what is missing for it.

use super::assess::Assessment;
use super::inspection::Outlook;
use crate::estimate::{Finding, NAMES, THETA, UNITS, finding, scale_of, theta_of};
use crate::log::{Quantity, StreamKey, StreamStats};
use crate::vehicle::{Anchor, Vehicle};

/// Fewer samples a second blur the torque of a roll or pitch motion.
pub(super) const SLOWEST_HZ: f64 = 40.0;
/// Angular acceleration below this rms teaches no inertia, rad/s^2.
pub(super) const LEAST_ANGULAR_ACCELERATION: f64 = 0.1;
/// Less flight than this is none, s.
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

    /// Rate of what tells the thrust, Hz.
    pub(super) fn actuator_hz(&self) -> Option<f64> {
        [Quantity::RotorSpeed, Quantity::ActuatorCommand, Quantity::Wrench]
            .into_iter()
            .filter_map(|quantity| self.rate_hz(quantity))
            .reduce(f64::max)
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
        if self.actuator_hz().is_none() {
            return Some("no actuator outputs".into());
        }
        if self.assessment.flight.airborne_s < LEAST_USABLE_S {
            return Some("no flight".into());
        }
        if let Some(refusal) = &self.assessment.refusal {
            return Some(refusal.to_string());
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
        let slowest = [("body rates", Some(rate_hz)), ("actuators", self.actuator_hz())];
        for (what, hz) in slowest {
            if let Some(hz) = hz.filter(|hz| *hz < SLOWEST_HZ) {
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
    // a weighed vehicle's thrust has the mass' place: only their ratio comes out of a flight
    let weighed = index == 0 && evidence.vehicle.is_some_and(|vehicle| vehicle.anchor == Anchor::Mass);
    let (name, unit) = if weighed { ("thrust_scale", "1") } else { (NAMES[index], UNITS[index]) };
    let none = Outlook { name, status: "not_determined", std: None, unit, std_relative: None, reason: None };
    if let (Some(vehicle), Some(expected)) = (evidence.vehicle, &evidence.assessment.expected) {
        let nominal = theta_of(&vehicle.body);
        return match finding(expected, &nominal, index) {
            Finding::Determined { std, .. } => {
                let relative = std / scale_of(&nominal, index);
                let std = if weighed { relative } else { std };
                Outlook { status: "determined", std: Some(std), std_relative: Some(relative), ..none }
            }
            Finding::Given { .. } => Outlook { status: "given", ..none },
            Finding::NotDetermined { reason } => Outlook { reason: Some(reason), ..none },
        };
    }
    match evidence.obstacle(index) {
        Some(reason) => Outlook { reason: Some(reason), ..none },
        None => Outlook { status: "possible", ..none },
    }
}
