//! Streams that a quantity needs and the log does not hold, and how to record them.

use super::evidence::Evidence;
use crate::diagnose::signatures::DeterminedBy;
use crate::recording::Quantity;
use crate::signals::{LEAST_FORCE_HZ, LEAST_TORQUE_HZ};

/// What is missing for a quantity.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Lack {
    pub reason: String,
    /// what to have recorded
    pub set: String,
}

/// What a quantity is told from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Need {
    /// of the motors, at this rate or more, Hz
    Commands(f64),
    /// of the body, at this rate or more, Hz
    BodyRates(f64),
    /// the same, where they are recorded
    BodyRatesIfThere(f64),
    /// along the thrust
    Force,
    /// with attitude
    Velocity,
    /// of the battery
    Voltage,
}

const COMMANDS: Need = Need::Commands(LEAST_FORCE_HZ);
const BODY_RATES: Need = Need::BodyRates(LEAST_FORCE_HZ);

/// What to do about a stream that may be gone with damage.
pub(super) const SOUND_COPY: &str = "give a sound copy of the log";

/// Rate to ask for, Hz.
pub(super) const WANTED_HZ: u32 = 100;

/// The first of the streams that a quantity needs and the log lacks.
pub(super) fn lack(evidence: &Evidence<'_>, needs: &[Need]) -> Option<Lack> {
    needs.iter().find_map(|need| need.lack(evidence))
}

/// What to have recorded for a quantity where what is recorded does not serve.
pub(super) fn remedy(evidence: &Evidence<'_>, needs: &[Need]) -> Option<String> {
    needs.last().map(|need| need.remedy(evidence))
}

impl Need {
    /// Streams that tell a parameter of the rigid body, by its place in `Theta`.
    pub(super) fn of_body(index: usize) -> &'static [Self] {
        match index {
            0 => &[COMMANDS, Self::Force, Self::BodyRatesIfThere(LEAST_FORCE_HZ)],
            _ => Self::of(DeterminedBy::Torques),
        }
    }

    /// Streams that this part of a recording is made of.
    pub(super) fn of(part: DeterminedBy) -> &'static [Self] {
        match part {
            DeterminedBy::Forces => &[COMMANDS, BODY_RATES, Self::Force],
            DeterminedBy::MeanTorques => &[COMMANDS, BODY_RATES],
            DeterminedBy::ForcesOverVelocity => &[COMMANDS, BODY_RATES, Self::Force, Self::Velocity],
            DeterminedBy::ForcesOverVoltage => &[COMMANDS, BODY_RATES, Self::Force, Self::Voltage],
            DeterminedBy::Torques => &[Self::Commands(LEAST_TORQUE_HZ), Self::BodyRates(LEAST_TORQUE_HZ)],
        }
    }

    fn lack(self, evidence: &Evidence<'_>) -> Option<Lack> {
        let has = |quantity| evidence.rate_hz(quantity).is_some();
        let reason = match self {
            Self::Commands(least_hz) => slow("motor commands", evidence.actuator_hz(), least_hz)
                .or_else(|| evidence.actuator_hz().is_none().then(|| lacking(evidence))),
            Self::BodyRates(least_hz) if has(Quantity::AngularRate) => {
                slow("body rates", evidence.rate_hz(Quantity::AngularRate), least_hz)
            }
            Self::BodyRates(_) => Some(match evidence.still(Quantity::AngularRate) {
                Some(hold) => format!("no body rates: they {hold}"),
                None => "no body rates".into(),
            }),
            Self::BodyRatesIfThere(least_hz) => {
                slow("body rates", evidence.rate_hz(Quantity::AngularRate), least_hz)
            }
            Self::Force => (!evidence.has_vertical_motion())
                .then(|| "no vertical motion: neither accelerometer nor attitude, rates and velocity".into()),
            Self::Velocity if !has(Quantity::Velocity) => Some("no velocity".into()),
            Self::Velocity => (!has(Quantity::Attitude)).then(|| "no attitude".into()),
            Self::Voltage => {
                let recorded =
                    evidence.streams.iter().any(|(key, ..)| key.quantity == Quantity::BatteryVoltage);
                (!recorded).then(|| "no battery voltage".into())
            }
        };
        Some(Lack { reason: reason?, set: self.remedy(evidence) })
    }

    /// What to have recorded.
    fn remedy(self, evidence: &Evidence<'_>) -> String {
        if evidence.damage.is_some() {
            return SOUND_COPY.to_owned();
        }
        let request = match self {
            Self::Commands(_) => "SERVO_OUTPUT_RAW or ACTUATOR_OUTPUT_STATUS",
            Self::BodyRates(_) | Self::BodyRatesIfThere(_) => {
                "ATTITUDE_QUATERNION, ATTITUDE, HIGHRES_IMU or RAW_IMU"
            }
            Self::Force => "an IMU message, or attitude and LOCAL_POSITION_NED",
            Self::Velocity => "LOCAL_POSITION_NED",
            Self::Voltage => "BATTERY_STATUS or SYS_STATUS",
        };
        match (self, evidence.logging, evidence.own_log) {
            (Self::Voltage, Some(_), _) => "fit a battery monitor to the autopilot".to_owned(),
            (Self::Velocity, Some(_), _) => {
                "give the vehicle a position estimate: GPS, or optical flow".to_owned()
            }
            (_, Some(logging), _) => logging.to_owned(),
            (Self::Velocity | Self::Voltage, None, _) | (_, None, None) => {
                format!("request {request} at {WANTED_HZ} Hz")
            }
            (_, None, Some(own)) => {
                format!("request {request} at {WANTED_HZ} Hz, or {own} and take the log on board")
            }
        }
    }
}

/// Why there are no commands: an unreadable log is told as that elsewhere.
fn lacking(evidence: &Evidence) -> String {
    if evidence.untimed_outputs { evidence.no_outputs() } else { "no actuator outputs".to_owned() }
}

fn slow(what: &str, rate_hz: Option<f64>, least_hz: f64) -> Option<String> {
    let hz = rate_hz.filter(|hz| *hz < least_hz)?;
    Some(format!("{what} at {hz:.0} Hz: too slow, {least_hz:.0} Hz are the least"))
}
