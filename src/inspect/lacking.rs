//! Streams that a quantity needs and the log lacks, and how to have them.

use super::evidence::Evidence;
use crate::recording::Quantity;
use crate::signals::REFUSED_HZ;

/// What is missing for a quantity.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Lack {
    pub reason: String,
    /// what to have recorded
    pub set: String,
}

/// What a quantity is told from.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Need {
    /// of the motors
    Commands,
    /// of the body
    Turning,
    /// along the thrust
    Force,
    /// with attitude
    Velocity,
    /// of the battery
    Voltage,
}

/// Rate to ask for, Hz.
const WANTED_HZ: u32 = 100;

fn needs(quantity: &str) -> &'static [Need] {
    match quantity {
        "mass" => &[Need::Commands, Need::Force],
        "inertia" | "motor_lag" => &[Need::Commands, Need::Turning],
        "drag" | "wind" => &[Need::Commands, Need::Turning, Need::Force, Need::Velocity],
        "voltage_sag" => &[Need::Commands, Need::Turning, Need::Force, Need::Voltage],
        _ => &[Need::Commands, Need::Turning, Need::Force],
    }
}

/// The first stream that a quantity needs and the log lacks.
pub(super) fn lack(evidence: &Evidence<'_>, quantity: &str) -> Option<Lack> {
    needs(quantity).iter().find_map(|need| need.lack(evidence))
}

/// What to have recorded for a quantity where what is recorded serves not.
pub(super) fn remedy(evidence: &Evidence<'_>, quantity: &str) -> Option<String> {
    needs(quantity).last().map(|need| need.remedy(evidence))
}

impl Need {
    fn lack(self, evidence: &Evidence<'_>) -> Option<Lack> {
        let has = |quantity| evidence.rate_hz(quantity).is_some();
        let reason = match self {
            Self::Commands => slow("motor commands", "actuator outputs", evidence.actuator_hz()),
            Self::Turning => slow("body rates", "body rates", evidence.rate_hz(Quantity::AngularRate)),
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
        let request = match self {
            Self::Commands => "SERVO_OUTPUT_RAW or ACTUATOR_OUTPUT_STATUS",
            Self::Turning => "ATTITUDE_QUATERNION, ATTITUDE, HIGHRES_IMU or RAW_IMU",
            Self::Force => "an IMU message, or attitude and LOCAL_POSITION_NED",
            Self::Velocity => "LOCAL_POSITION_NED",
            Self::Voltage => "BATTERY_STATUS or SYS_STATUS",
        };
        match (self, evidence.logging, evidence.own_log) {
            (Self::Voltage, Some(_), _) => "a battery monitor in the autopilot".to_owned(),
            (Self::Velocity, Some(_), _) => "a position estimate: GPS, or optical flow".to_owned(),
            (_, Some(logging), _) => logging.to_owned(),
            (Self::Commands | Self::Turning | Self::Force, None, Some(own)) => {
                format!("request {request} at {WANTED_HZ} Hz, or {own} and take the log on board")
            }
            (_, None, _) => format!("request {request} at {WANTED_HZ} Hz"),
        }
    }
}

fn slow(what: &str, missing: &str, rate_hz: Option<f64>) -> Option<String> {
    match rate_hz {
        None => Some(format!("no {missing}")),
        Some(hz) if hz < REFUSED_HZ => {
            Some(format!("{what} at {hz:.0} Hz: too slow, {REFUSED_HZ:.0} Hz are the least"))
        }
        Some(_) => None,
    }
}
