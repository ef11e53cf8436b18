//! What judgements of a log rest on.

use super::assess::Assessment;
use crate::autopilot::VehicleKind;
use crate::estimate::{Contradiction, Estimated};
use crate::recording::{Quantity, StreamKey, StreamStats};
use crate::signals::SignalsError;
use crate::vehicle::Vehicle;

/// Least usable time of flight, s. Five kernels of the weak form: with less there are no rows.
const LEAST_USABLE_S: f64 = 2.0;

/// What the judgement rests on.
#[derive(Debug, Clone, Copy)]
pub(super) struct Evidence<'a> {
    pub streams: &'a [(StreamKey, usize, StreamStats)],
    pub assessment: &'a Assessment,
    pub vehicle: Option<&'a Vehicle>,
    /// without a vehicle, one of assumed mass and size and what it would come out as
    pub assumed: Option<(&'a Vehicle, &'a Estimated)>,
    /// what `identify` would find far from what the vehicle file states
    pub contradictions: &'a [Contradiction],
    /// parameters of the autopilot's thrust curve that the log does not hold
    pub missing_curve: Option<&'static str>,
    /// what kind of vehicle it is of
    pub kind: Option<VehicleKind>,
    /// whether it was ever armed, where it tells
    pub armed: Option<bool>,
    /// time in the air by the autopilot's own words, s
    pub said_in_air_s: f64,
    /// steps back of the stamps, where messages stand in another order than they were written in
    pub steps_back: Option<u64>,
    /// messages that cannot be read, where they are many
    pub unreadable: Option<u64>,
    /// the log's messages carry times
    pub timed: bool,
    /// its motor outputs carry none
    pub untimed_outputs: bool,
    /// most of the log are messages that nothing in it defines
    pub undefined: bool,
    /// the log ends before its first message with a time
    pub ends_early: bool,
    /// how much of it is damaged, in words, where streams may be gone with it
    pub damage: Option<&'a str>,
    /// how to make the vehicle log more, where it wrote the log
    pub logging: Option<&'a str>,
    /// how to make it log more on board, where the log is of a link
    pub own_log: Option<&'a str>,
}

impl Evidence<'_> {
    /// Rate of the fastest stream of a quantity that moves, Hz: in the air, where something flew.
    pub(super) fn rate_hz(&self, quantity: Quantity) -> Option<f64> {
        self.streams
            .iter()
            .filter(|(key, _, stats)| {
                key.quantity == quantity && stats.count >= 10 && !stats.all_zero && !stats.is_constant()
            })
            .map(|(key, _, stats)| self.assessment.rates.of(key).unwrap_or(stats.rate_hz))
            .reduce(f64::max)
    }

    /// What a quantity's streams hold instead of a signal, where they do not move.
    pub(super) fn still(&self, quantity: Quantity) -> Option<&'static str> {
        let of = |(key, _, stats): &&(StreamKey, usize, StreamStats)| {
            key.quantity == quantity && stats.count >= 10
        };
        let (.., stats) = self.streams.iter().find(of).filter(|_| self.rate_hz(quantity).is_none())?;
        Some(if stats.all_zero { "hold nothing but zeros" } else { "never change" })
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

    /// The vehicle is no multirotor: nothing that a multirotor's owner could do helps.
    pub(super) fn is_of_other_kind(&self) -> bool {
        self.kind.is_some_and(|kind| kind != VehicleKind::Multirotor)
    }

    /// There are streams, and they have times.
    pub(super) fn holds_streams(&self) -> bool {
        self.timed && !self.undefined && !self.streams.is_empty()
    }

    /// The log shows a flight, and by the vehicle file's thrust there was none.
    pub(super) fn is_contradicted(&self) -> bool {
        matches!(self.assessment.refusal, Some(SignalsError::ThrustTooLow { .. }))
            && self.assessment.flight.airborne_s >= LEAST_USABLE_S
    }

    /// The log has actuator outputs, and they are not those of the vehicle.
    pub(super) fn has_other_actuators(&self) -> bool {
        let others = matches!(
            self.assessment.refusal,
            Some(SignalsError::NoActuators { .. } | SignalsError::OtherRotors { .. })
        );
        others && self.actuator_hz().is_some()
    }

    /// Why the log is that of a vehicle with another number of rotors than the given one has.
    pub(super) fn other_rotors(&self) -> Option<String> {
        let refusal = self.assessment.refusal.as_ref();
        refusal.filter(|refusal| matches!(refusal, SignalsError::OtherRotors { .. })).map(ToString::to_string)
    }

    /// Why it is no flight, where the vehicle tells that.
    pub(super) fn grounded(&self) -> Option<String> {
        let flown = self.assessment.flight.airborne_s >= LEAST_USABLE_S;
        match self.armed {
            Some(false) => Some("the vehicle was never armed".into()),
            Some(true) if !flown && self.said_in_air_s >= LEAST_USABLE_S => Some(format!(
                "the autopilot says that it was in the air for {:.0} s, and neither its motor outputs nor its height in \
                 this log show it",
                self.said_in_air_s
            )),
            Some(true) if !flown => Some("the vehicle was armed and never in the air".into()),
            _ => None,
        }
    }

    /// The log holds no flight, or no stream of a flight: with a vehicle file there would be no more to identify.
    pub(super) fn is_unflown(&self) -> bool {
        let flown = self.assessment.flight.airborne_s >= LEAST_USABLE_S;
        let quantities = [Quantity::RotorSpeed, Quantity::ActuatorCommand, Quantity::Wrench];
        let has_actuators = self.streams.iter().any(|(key, ..)| quantities.contains(&key.quantity));
        // outputs that are recorded and do not change: the conditioning gives the reason
        let is_still = has_actuators && self.actuator_hz().is_none();
        let unflown = self.grounded().is_some() || !has_actuators || !(flown || is_still);
        self.steps_back.is_none() && (self.streams.is_empty() || (self.holds_streams() && unflown))
    }

    /// Of a log without actuator outputs that can be used.
    pub(super) fn no_outputs(&self) -> String {
        match self.unreadable {
            Some(count) => {
                format!("no actuator outputs that can be read: {count} messages of the log cannot")
            }
            None if self.untimed_outputs => {
                "its messages of motor outputs carry no time of the vehicle's".to_owned()
            }
            None => "no actuator outputs".to_owned(),
        }
    }

    /// Why nothing at all can be identified.
    pub(super) fn nothing(&self) -> Option<String> {
        if let Some(kind) = self.kind.filter(|_| self.is_of_other_kind()) {
            return Some(format!("it is of a {}, and mavid identifies multirotors", kind.name()));
        }
        if !self.timed && !self.undefined {
            return Some("its messages carry no time of the vehicle's".into());
        }
        if self.undefined {
            return Some("its messages are not defined in it: its beginning is missing".into());
        }
        if self.streams.is_empty() && self.ends_early {
            return Some("it ends before its first sample".into());
        }
        if self.streams.is_empty() {
            return Some("it holds no stream that is known here".into());
        }
        if let Some(count) = self.steps_back {
            return Some(format!("its messages are out of order, their stamps run back {count} times"));
        }
        if let Some(grounded) = self.grounded() {
            return Some(grounded);
        }
        if self.actuator_hz().is_none() {
            return Some(self.no_outputs());
        }
        if self.assessment.flight.airborne_s < LEAST_USABLE_S {
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
}
