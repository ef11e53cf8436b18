//! What an autopilot logs of a flight, by its parameters, and what an identification needs of it.

use super::stack::Stack;

/// What a parameter of logging has to be for an identification.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LogNeed {
    /// these bits are set; others stay as they are
    Bits(u32),
    /// one of these; where it is none of them it becomes the first
    OneOf(&'static [f64]),
}

/// A parameter of logging.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LogSetting {
    /// its name
    pub parameter: &'static str,
    /// what an identification needs
    pub need: LogNeed,
    /// the autopilot takes it only when it starts
    pub restarts: bool,
    /// what it does, as the end of a sentence
    pub words: &'static str,
}

/// What of a log depends on a bit of a parameter: what is logged with it, and without it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LogRate {
    /// the parameter
    pub parameter: &'static str,
    /// its bit
    pub bit: u32,
    /// what is logged if it is set
    pub with: &'static str,
    /// what is logged if not
    pub without: &'static str,
}

/// How an autopilot is told what to log.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Logging {
    /// parameters, the most important first
    pub settings: &'static [LogSetting],
    /// what is logged at which rate
    pub rates: &'static [LogRate],
}

/// PX4.
pub(super) const PX4: Logging = Logging {
    settings: &[
        LogSetting {
            parameter: "SDLOG_PROFILE",
            need: LogNeed::Bits(1 | 1 << 3),
            restarts: true,
            words: "bit 0 logs what PX4 logs by default, bit 3 adds what an identification needs",
        },
        LogSetting {
            parameter: "SDLOG_MODE",
            need: LogNeed::OneOf(&[0.0, 1.0, 2.0, 4.0]),
            restarts: true,
            words: "0 logs while the vehicle is armed",
        },
        LogSetting {
            parameter: "SDLOG_BACKEND",
            need: LogNeed::Bits(1),
            restarts: true,
            words: "bit 0 writes the log to a file",
        },
    ],
    rates: &[LogRate {
        parameter: "SDLOG_PROFILE",
        bit: 3,
        with: "motor commands, torque setpoints, gyroscope and accelerometer at their full rate",
        without: "motor commands at 10 Hz, torque setpoints at 50 Hz, gyroscope and accelerometer at about 200 Hz",
    }],
};

/// ArduPilot.
pub(super) const ARDUPILOT: Logging = Logging {
    settings: &[
        LogSetting {
            parameter: "LOG_BITMASK",
            need: LogNeed::Bits(1 | 1 << 10 | 1 << 18),
            restarts: false,
            words: "bit 0 is the fast attitude and rate controller, 10 the outputs, 18 the fast inertial unit",
        },
        LogSetting {
            parameter: "LOG_BACKEND_TYPE",
            need: LogNeed::Bits(1),
            restarts: true,
            words: "bit 0 writes the log to a file",
        },
        LogSetting {
            parameter: "LOG_FILE_RATEMAX",
            need: LogNeed::OneOf(&[0.0]),
            restarts: false,
            words: "0 does not limit the rate of any message",
        },
    ],
    rates: &[
        LogRate {
            parameter: "LOG_BITMASK",
            bit: 0,
            with: "attitude and the outputs of the rate controller at the rate of the main loop",
            without: "attitude and the outputs of the rate controller at 10 Hz",
        },
        LogRate {
            parameter: "LOG_BITMASK",
            bit: 18,
            with: "gyroscope and accelerometer at the rate of the main loop",
            without: "gyroscope and accelerometer at 25 Hz",
        },
        LogRate {
            parameter: "LOG_BITMASK",
            bit: 10,
            with: "outputs to the motors at 10 Hz",
            without: "no outputs to the motors",
        },
    ],
};

/// A parameter that has to be another for an identification.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LogChange {
    /// its name
    pub parameter: &'static str,
    /// what it is
    pub found: f64,
    /// what it should be
    pub wanted: f64,
    /// the autopilot takes it only when it starts
    pub restarts: bool,
}

/// What an autopilot will log, and what should be changed.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LogPlan {
    /// what it will log, in sentences without their ends
    pub logs: Vec<String>,
    /// what an identification needs
    pub changes: Vec<LogChange>,
    /// parameters that did not answer
    pub unknown: Vec<&'static str>,
}

/// The bits of a value; none of one that is negative or no number.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
fn bits(value: f64) -> u32 {
    value.round() as u32
}

impl Stack {
    /// What it will log by these values of its parameters (`None`: not known), and what an identification needs beyond.
    #[must_use]
    pub fn log_plan(&self, value: impl Fn(&str) -> Option<f64>) -> LogPlan {
        let mut plan = LogPlan::default();
        for setting in self.log_settings.settings {
            let Some(found) = value(setting.parameter) else {
                plan.unknown.push(setting.parameter);
                continue;
            };
            let wanted = match setting.need {
                LogNeed::Bits(mask) => f64::from(bits(found) | mask),
                LogNeed::OneOf(values) if values.contains(&found) => found,
                LogNeed::OneOf(values) => values.first().copied().unwrap_or(found),
            };
            if wanted != found {
                let LogSetting { parameter, restarts, .. } = *setting;
                plan.changes.push(LogChange { parameter, found, wanted, restarts });
            }
        }
        for rate in self.log_settings.rates {
            if let Some(found) = value(rate.parameter) {
                let is_set = bits(found) >> rate.bit & 1 == 1;
                plan.logs.push(if is_set { rate.with } else { rate.without }.to_owned());
            }
        }
        plan
    }
}

#[cfg(test)]
mod tests {
    use crate::autopilot::{ARDUPILOT, LogChange, PX4};

    #[test]
    fn defaults_are_too_slow_and_what_is_enough_stays() {
        let plan = PX4.log_plan(|name| match name {
            "SDLOG_PROFILE" => Some(1.0),
            "SDLOG_MODE" => Some(0.0),
            _ => None,
        });
        let change = LogChange { parameter: "SDLOG_PROFILE", found: 1.0, wanted: 9.0, restarts: true };
        assert_eq!((plan.changes, plan.unknown), (vec![change], vec!["SDLOG_BACKEND"]));
        assert!(plan.logs[0].contains("10 Hz"));
        // further bits stay
        let plan = PX4.log_plan(|name| Some(if name == "SDLOG_PROFILE" { 27.0 } else { 1.0 }));
        assert_eq!(plan.changes, []);
        let off = PX4.log_plan(|name| (name == "SDLOG_MODE").then_some(-1.0));
        assert_eq!((off.changes[0].found, off.changes[0].wanted), (-1.0, 0.0));
        let plan = ARDUPILOT.log_plan(|name| Some(if name == "LOG_BITMASK" { 176_126.0 } else { 1.0 }));
        let names: Vec<_> = plan.changes.iter().map(|change| (change.parameter, change.wanted)).collect();
        assert_eq!(names, [("LOG_BITMASK", 438_271.0), ("LOG_FILE_RATEMAX", 0.0)]);
        assert_eq!(plan.logs.len(), 3);
    }
}
