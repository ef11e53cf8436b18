//! What an autopilot will log by its parameters, and what should be changed of them.

use super::logging::{LogNeed, LogRate, LogSetting, LogSpeed, OldLogging, bits};
use super::stack::Stack;

/// A parameter that has to be another for an identification.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LogChange {
    /// its name
    pub parameter: &'static str,
    /// what it is
    pub found: f64,
    /// what it should be
    pub needed: f64,
    /// the autopilot takes it only when it starts
    pub restarts: bool,
}

/// A parameter that was set and counts only from the next start of the autopilot on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LogAwaited {
    /// its name
    pub parameter: &'static str,
    /// what it is
    pub set: f64,
    /// what it was when the autopilot started: so it logs until it starts anew
    pub runs_by: f64,
}

/// What an autopilot will log, and what should be changed.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LogPlan {
    /// what it will log, in sentences without their ends
    pub logs: Vec<String>,
    /// what an identification needs
    pub changes: Vec<LogChange>,
    /// parameters that did not answer, but for those that not every release has
    pub unknown: Vec<&'static str>,
}

impl Stack {
    /// What it will log by these values of its parameters (`None`: not known), and what an identification needs beyond.
    #[must_use]
    pub fn log_plan(&self, value: impl Fn(&str) -> Option<f64>) -> LogPlan {
        let mut plan = LogPlan::default();
        let mut off = Vec::new();
        for setting in self.log_settings.settings {
            let Some(found) = value(setting.parameter) else {
                if !setting.optional {
                    plan.unknown.push(setting.parameter);
                }
                continue;
            };
            if setting.off.holds(found) {
                off.push(format!("{} = {found}", setting.parameter));
            }
            let needed = match setting.need {
                LogNeed::Bits(mask) => f64::from(bits(found) | mask),
                LogNeed::OneOf(values) if values.contains(&found) => found,
                LogNeed::OneOf(values) => values.first().copied().unwrap_or(found),
            };
            if needed != found {
                let LogSetting { parameter, restarts, .. } = *setting;
                plan.changes.push(LogChange { parameter, found, needed, restarts });
            }
        }
        if !off.is_empty() {
            plan.logs.push(format!("nothing: no log is written to a file ({})", off.join(", ")));
            return plan;
        }
        let rates = self.log_settings.rates.iter();
        plan.logs.extend(rates.filter_map(|rate| self.logged(rate, &value)));
        plan
    }

    /// What is logged by a parameter, and how often, in a sentence without its end; `None` where the parameter is not known.
    fn logged(&self, rate: &LogRate, value: &impl Fn(&str) -> Option<f64>) -> Option<String> {
        let found = bits(value(rate.parameter)?);
        let Some((_, what, speed)) = rate.with.iter().find(|(bit, ..)| found >> bit & 1 == 1) else {
            return Some(rate.without.to_owned());
        };
        let hz = match speed {
            LogSpeed::AsSaid => return Some((*what).to_owned()),
            LogSpeed::Loop => self.log_settings.loop_rate.and_then(value),
            LogSpeed::Hz(hz) => Some(*hz),
        };
        let limit = self.log_settings.limit.and_then(|name| Some((name, value(name)?)));
        let limited = limit.filter(|(_, most_hz)| *most_hz > 0.0 && hz.is_none_or(|hz| *most_hz < hz));
        Some(match (limited, hz) {
            (Some((name, most_hz)), _) => format!("{what} at {most_hz} Hz, the limit of {name}"),
            (None, Some(hz)) if *speed == LogSpeed::Loop => {
                format!("{what} at the rate of the main loop, {hz} Hz")
            }
            (None, Some(hz)) => format!("{what} at {hz} Hz"),
            (None, None) => format!("{what} at the rate of the main loop"),
        })
    }

    /// Parameters that tell what is logged and how often.
    #[must_use]
    pub fn log_parameters(&self) -> Vec<&'static str> {
        let settings = self.log_settings.settings.iter().map(|setting| setting.parameter);
        settings.chain(self.log_settings.loop_rate).collect()
    }

    /// What to set so that its own log holds what an identification needs, as the end of a sentence that begins with what to do: by
    /// the parameters that a log has (`None`: not in it).
    #[must_use]
    pub fn logging_by(&self, value: impl Fn(&str) -> Option<f64>) -> String {
        let is_old = |old: &OldLogging| value(old.has).is_some() && value(old.lacks).is_none();
        if let Some(old) = self.log_settings.old.filter(is_old) {
            return format!("update {}, {}, and {}", old.update_to, old.brings, self.logging);
        }
        let settings = self.log_settings.settings;
        let Some((first, found)) = settings.first().map(|first| (first, value(first.parameter))) else {
            return self.logging.to_owned();
        };
        let Some(found) = found else {
            let since = first.since.filter(|_| value(self.log_settings.of_all).is_some());
            return since.map_or_else(
                || self.logging.to_owned(),
                |since| {
                    let (name, parameter) = (self.name, first.parameter);
                    format!(
                        "update {name} to {since} or later, which brings {parameter}, and {}",
                        self.logging
                    )
                },
            );
        };
        let changes = self.log_plan(value).changes;
        if changes.is_empty() {
            return format!("have the autopilot publish it: {} = {found} logs it already", first.parameter);
        }
        let added = |change: &LogChange| {
            let of = settings.iter().find(|setting| setting.parameter == change.parameter);
            let new = bits(change.needed) & !bits(change.found);
            let names = of.into_iter().flat_map(|of| of.bits).filter(|(bit, _)| new >> bit & 1 == 1);
            names.map(|(_, name)| *name).collect::<Vec<_>>().join(", ")
        };
        let set = |change: &LogChange| match added(change) {
            names if names.is_empty() => format!("{} = {}", change.parameter, change.needed),
            names => format!("{} = {} (adds {names})", change.parameter, change.needed),
        };
        let restart =
            if changes.iter().any(|change| change.restarts) { " and restart the autopilot" } else { "" };
        format!("set {}{restart}", changes.iter().map(set).collect::<Vec<_>>().join(", "))
    }

    /// Of the parameters that did not answer, those on which the rates of the log depend: without them nothing is prepared.
    #[must_use]
    pub fn rates_unknown(&self, plan: &LogPlan) -> Vec<&'static str> {
        let sets_rates = |name: &&&str| self.log_settings.rates.iter().any(|rate| rate.parameter == **name);
        plan.unknown.iter().filter(sets_rates).copied().collect()
    }

    /// The same while some parameters still wait for a start of the autopilot: what it logs is by those that it started
    /// with, what should be changed by those that it will start with.
    #[must_use]
    pub fn log_plan_until_start(
        &self,
        value: impl Fn(&str) -> Option<f64>,
        awaited: &[LogAwaited],
    ) -> LogPlan {
        let runs_by = |name: &str| {
            let awaited = awaited.iter().find(|awaited| awaited.parameter == name);
            awaited.map_or_else(|| value(name), |awaited| Some(awaited.runs_by))
        };
        LogPlan { logs: self.log_plan(runs_by).logs, ..self.log_plan(&value) }
    }

    /// The parameter that sets the rates of its log, where it is read at a start alone.
    #[must_use]
    pub fn log_rates_from_start(&self) -> Option<&'static str> {
        let logging = self.log_settings;
        let restarts =
            |name: &str| logging.settings.iter().any(|setting| setting.restarts && setting.parameter == name);
        logging.rates.iter().map(|rate| rate.parameter).find(|name| restarts(name))
    }
}

#[cfg(test)]
mod tests {
    use crate::autopilot::{ARDUPILOT, LogAwaited, LogChange, PX4};

    #[test]
    fn defaults_are_too_slow_and_what_is_enough_stays() {
        let plan = PX4.log_plan(|name| match name {
            "SDLOG_PROFILE" => Some(1.0),
            "SDLOG_MODE" => Some(0.0),
            _ => None,
        });
        let change = LogChange { parameter: "SDLOG_PROFILE", found: 1.0, needed: 9.0, restarts: true };
        assert_eq!((plan.changes, plan.unknown), (vec![change], vec![]), "1.16 has no SDLOG_BACKEND");
        assert!(plan.logs[0].contains("10 Hz"));
        // further bits stay
        let plan = PX4.log_plan(|name| Some(if name == "SDLOG_PROFILE" { 27.0 } else { 1.0 }));
        assert_eq!(plan.changes, []);
        let off = PX4.log_plan(|name| (name == "SDLOG_MODE").then_some(-1.0));
        assert_eq!((off.changes[0].found, off.changes[0].needed), (-1.0, 0.0));
        assert_eq!(off.unknown, ["SDLOG_PROFILE"]);
        assert_eq!(PX4.rates_unknown(&off), ["SDLOG_PROFILE"]);
        let old = ARDUPILOT.log_plan(|name| (name == "LOG_BITMASK").then_some(0.0));
        assert!(!old.unknown.is_empty() && ARDUPILOT.rates_unknown(&old).is_empty(), "{old:?}");
        let plan = ARDUPILOT.log_plan(|name| Some(if name == "LOG_BITMASK" { 176_126.0 } else { 1.0 }));
        let names: Vec<_> = plan.changes.iter().map(|change| (change.parameter, change.needed)).collect();
        assert_eq!(names, [("LOG_BITMASK", 438_271.0), ("LOG_FILE_RATEMAX", 0.0)]);
        assert_eq!(plan.logs.len(), 3);
    }

    #[test]
    fn rates_are_by_the_bits_the_main_loop_and_the_limit() {
        let logs = |bitmask: f64, loop_hz: Option<f64>, most_hz: f64| {
            ARDUPILOT.log_plan(|name| match name {
                "LOG_BITMASK" => Some(bitmask),
                "SCHED_LOOP_RATE" => loop_hz,
                "LOG_FILE_RATEMAX" => Some(most_hz),
                _ => None,
            })
        };
        let nothing = logs(0.0, Some(400.0), 0.0);
        assert_eq!(
            nothing.logs,
            [
                "neither attitude nor the outputs of the rate controller",
                "neither gyroscope nor accelerometer",
                "no outputs to the motors"
            ]
        );
        assert_eq!(
            logs(176_126.0, Some(400.0), 10.0).logs[1],
            "gyroscope and accelerometer at 10 Hz, the limit of LOG_FILE_RATEMAX"
        );
        assert_eq!(logs(176_126.0, Some(400.0), 50.0).logs[1], "gyroscope and accelerometer at 25 Hz");
        let fast = |loop_hz, most_hz| logs(438_271.0, loop_hz, most_hz).logs[1].clone();
        assert_eq!(
            fast(Some(300.0), 0.0),
            "gyroscope and accelerometer at the rate of the main loop, 300 Hz"
        );
        assert_eq!(fast(None, 0.0), "gyroscope and accelerometer at the rate of the main loop");
        assert_eq!(
            fast(Some(300.0), 100.0),
            "gyroscope and accelerometer at 100 Hz, the limit of LOG_FILE_RATEMAX"
        );
    }

    #[test]
    fn advice_for_the_next_log_is_by_what_the_log_says_of_this_one() {
        let px4 = |profile: Option<f64>, of_all: Option<f64>| {
            PX4.logging_by(|name| match name {
                "SDLOG_PROFILE" => profile,
                "SDLOG_UTC_OFFSET" => of_all,
                _ => None,
            })
        };
        assert_eq!(px4(None, None), "set SDLOG_PROFILE = 9 and restart the autopilot");
        let old = px4(None, Some(0.0));
        assert!(old.starts_with("update PX4 to 1.8 or later, which brings SDLOG_PROFILE, and set"), "{old}");
        let added = "set SDLOG_PROFILE = 11 (adds system identification) and restart the autopilot";
        assert_eq!(px4(Some(3.0), Some(0.0)), added);
        assert!(px4(Some(9.0), Some(0.0)).ends_with("SDLOG_PROFILE = 9 logs it already"));
        let ardupilot = ARDUPILOT.logging_by(|name| (name == "LOG_BITMASK").then_some(176_126.0));
        assert_eq!(ardupilot, "set LOG_BITMASK = 438271 (adds fast attitude, fast IMU)");
        assert_eq!(ARDUPILOT.logging_by(|_| None), ARDUPILOT.logging);
        // until Copter 3.3 bit 18 of LOG_BITMASK did not exist, and FRAME did
        let old = ARDUPILOT.logging_by(|name| ["FRAME", "LOG_BITMASK"].contains(&name).then_some(830.0));
        assert!(old.starts_with("update ArduPilot to Copter 3.5 or later, whose LOG_BITMASK"), "{old}");
    }

    #[test]
    fn until_a_start_it_logs_by_what_it_started_with() {
        let value = |name: &str| Some(if name == "SDLOG_PROFILE" { 9.0 } else { 1.0 });
        let awaited = LogAwaited { parameter: "SDLOG_PROFILE", set: 9.0, runs_by: 1.0 };
        let plan = PX4.log_plan_until_start(value, &[awaited]);
        assert!(plan.changes.is_empty() && plan.logs[0].contains("10 Hz"), "{plan:?}");
        assert_eq!(PX4.log_plan_until_start(value, &[]), PX4.log_plan(value));
        assert_eq!(PX4.log_rates_from_start(), Some("SDLOG_PROFILE"));
        assert_eq!(ARDUPILOT.log_rates_from_start(), None);
    }

    #[test]
    fn where_logging_is_off_nothing_is_said_to_be_logged() {
        let none = "nothing: no log is written to a file";
        for (stack, off, value) in [
            (&PX4, "SDLOG_MODE", -1.0),
            (&PX4, "SDLOG_BACKEND", 2.0),
            (&ARDUPILOT, "LOG_BACKEND_TYPE", 2.0),
            (&ARDUPILOT, "LOG_BACKEND_TYPE", 0.0),
        ] {
            let plan = stack.log_plan(|name| Some(if name == off { value } else { 9.0 }));
            assert_eq!(plan.logs, [format!("{none} ({off} = {value})")]);
            assert!(plan.changes.iter().any(|change| change.parameter == off), "{off}");
        }
        let both = PX4.log_plan(|name| Some(if name == "SDLOG_MODE" { -1.0 } else { 8.0 }));
        assert_eq!(both.logs, [format!("{none} (SDLOG_MODE = -1, SDLOG_BACKEND = 8)")]);
    }
}
