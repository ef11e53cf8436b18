//! What an autopilot logs of a flight, by its parameters, and what an identification needs of it.

use super::release::Release;

/// What a parameter of logging has to be for an identification.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LogNeed {
    /// these bits are set; others stay as they are
    Bits(u32),
    /// one of these; where it is none of them it becomes the first
    OneOf(&'static [f64]),
}

/// Values of a parameter with which no log is written to a file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LogOff {
    /// none
    Never,
    /// this one
    At(f64),
    /// those without this bit
    WithoutBit(u32),
}

impl LogOff {
    /// Whether no log is written to a file with this value.
    #[must_use]
    pub fn holds(self, value: f64) -> bool {
        match self {
            Self::Never => false,
            Self::At(off) => value == off,
            Self::WithoutBit(bit) => bits(value) >> bit & 1 == 0,
        }
    }
}

/// The bits of a value; none of one that is negative or no number.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
pub(super) fn bits(value: f64) -> u32 {
    value.round() as u32
}

/// A parameter of logging.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LogSetting {
    /// its name
    pub parameter: &'static str,
    /// what an identification needs
    pub need: LogNeed,
    /// with what it is that no log is written
    pub off: LogOff,
    /// releases that lack it write to a file whatever is set
    pub optional: bool,
    /// the release that brought it, where older ones write logs without it
    pub since: Option<Release>,
    /// the autopilot takes it only when it starts
    pub restarts: bool,
    /// what it does, as the end of a sentence
    pub words: &'static str,
    /// what some of its bits log, in a word or two
    pub bits: &'static [(u32, &'static str)],
}

/// How often something is logged.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LogSpeed {
    /// its words say it
    AsSaid,
    /// each period of the main loop
    Loop,
    /// Hz
    Hz(f64),
}

/// What of a log depends on bits of a parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LogRate {
    /// the parameter
    pub parameter: &'static str,
    /// a bit, what is logged if it is set, and how often: the first one that is set counts
    pub with: &'static [(u32, &'static str, LogSpeed)],
    /// what is said where none of them is set
    pub without: &'static str,
}

/// Releases whose parameters of logging mean something else.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OldLogging {
    /// they have this parameter
    pub has: &'static str,
    /// and lack this one
    pub lacks: &'static str,
    /// what to update to
    pub update_to: &'static str,
    /// what that brings, as the end of a sentence
    pub brings: &'static str,
}

/// How an autopilot is told what to log.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Logging {
    /// parameters, the most important first
    pub settings: &'static [LogSetting],
    /// a parameter that every release has: one that has it and not the first of the settings lacks that
    pub of_all: &'static str,
    /// releases for which none of this holds
    pub old: Option<OldLogging>,
    /// what is logged at which rate
    pub rates: &'static [LogRate],
    /// the parameter with the rate of the main loop, Hz
    pub loop_rate: Option<&'static str>,
    /// the parameter with the largest rate of a message, Hz; 0 does not limit
    pub limit: Option<&'static str>,
}

/// PX4.
pub(super) const PX4: Logging = Logging {
    settings: &[
        LogSetting {
            parameter: "SDLOG_PROFILE",
            need: LogNeed::Bits(1 | 1 << 3),
            off: LogOff::Never,
            optional: false,
            since: Some(Release::new(1, 8)),
            restarts: true,
            words: "bit 0 logs what PX4 logs by default, bit 3 adds what an identification needs",
            bits: &[(0, "default"), (3, "system identification")],
        },
        LogSetting {
            parameter: "SDLOG_MODE",
            need: LogNeed::OneOf(&[0.0, 1.0, 2.0, 4.0]),
            off: LogOff::At(-1.0),
            optional: false,
            since: None,
            restarts: true,
            words: "0 logs while the vehicle is armed",
            bits: &[],
        },
        LogSetting {
            parameter: "SDLOG_BACKEND",
            need: LogNeed::Bits(1),
            off: LogOff::WithoutBit(0),
            optional: true,
            since: None,
            restarts: true,
            words: "bit 0 writes the log to a file",
            bits: &[],
        },
    ],
    of_all: "SDLOG_UTC_OFFSET",
    old: None,
    // a profile of 0 is taken for the default (src/modules/logger/logger.cpp)
    rates: &[LogRate {
        parameter: "SDLOG_PROFILE",
        with: &[(
            3,
            "motor commands, torque setpoints, gyroscope and accelerometer at their full rate",
            LogSpeed::AsSaid,
        )],
        without: "motor commands at 10 Hz, torque setpoints at 50 Hz, gyroscope and accelerometer at about 200 Hz",
    }],
    loop_rate: None,
    limit: None,
};

/// ArduPilot.
pub(super) const ARDUPILOT: Logging = Logging {
    settings: &[
        LogSetting {
            parameter: "LOG_BITMASK",
            need: LogNeed::Bits(1 | 1 << 10 | 1 << 18),
            off: LogOff::Never,
            optional: false,
            since: None,
            restarts: false,
            words: "bit 0 is the fast attitude and rate controller, 10 the outputs, 18 the fast inertial unit",
            bits: &[(0, "fast attitude"), (10, "RC output"), (18, "fast IMU")],
        },
        LogSetting {
            parameter: "LOG_BACKEND_TYPE",
            need: LogNeed::Bits(1),
            off: LogOff::WithoutBit(0),
            optional: false,
            since: None,
            restarts: true,
            words: "bit 0 writes the log to a file",
            bits: &[],
        },
        LogSetting {
            parameter: "LOG_FILE_RATEMAX",
            need: LogNeed::OneOf(&[0.0]),
            off: LogOff::Never,
            optional: false,
            since: None,
            restarts: false,
            words: "0 does not limit the rate of any message",
            bits: &[],
        },
    ],
    of_all: "LOG_BITMASK",
    // bits of LOG_BITMASK until Copter 3.1 (ArduCopter/defines.h): 10 is the motors in a message of their own, 18 does not exist
    old: Some(OldLogging {
        has: "FRAME",
        lacks: "LOG_BACKEND_TYPE",
        update_to: "ArduPilot to Copter 3.5 or later",
        brings: "whose LOG_BITMASK has bits for the outputs and the fast inertial unit",
    }),
    // ArduCopter/Copter.cpp: the fast bits go before those of 10 and 25 Hz
    rates: &[
        LogRate {
            parameter: "LOG_BITMASK",
            with: &[
                (0, "attitude and the outputs of the rate controller", LogSpeed::Loop),
                (1, "attitude and the outputs of the rate controller", LogSpeed::Hz(10.0)),
            ],
            without: "neither attitude nor the outputs of the rate controller",
        },
        LogRate {
            parameter: "LOG_BITMASK",
            with: &[
                (18, "gyroscope and accelerometer", LogSpeed::Loop),
                (7, "gyroscope and accelerometer", LogSpeed::Hz(25.0)),
            ],
            without: "neither gyroscope nor accelerometer",
        },
        LogRate {
            parameter: "LOG_BITMASK",
            with: &[(10, "outputs to the motors", LogSpeed::Hz(10.0))],
            without: "no outputs to the motors",
        },
    ],
    loop_rate: Some("SCHED_LOOP_RATE"),
    limit: Some("LOG_FILE_RATEMAX"),
};
