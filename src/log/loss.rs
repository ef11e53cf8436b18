//! What of a file is not in its recording, and what is odd about it.

use std::fmt;

use crate::units::{seconds_from_ms, seconds_from_us};

/// What of a file is not in its recording: how much of what, and where first. Its text is what a user is told.
#[derive(Debug, Clone, PartialEq)]
pub enum Loss {
    /// dropped for a wrong checksum
    WrongChecksum {
        /// what a file of this format is made of: `frame`
        unit: &'static str,
        /// how many
        count: u64,
        /// byte offset of the first
        first_byte: u64,
    },
    /// bytes that had to be skipped
    Skipped {
        /// what they are no part of: `frame`
        unit: &'static str,
        /// how many
        bytes: u64,
        /// stretches of them
        places: u64,
        /// byte offset of the first
        first_byte: u64,
    },
    /// they stand whole in the file, but what they say is not what their kind says, or their definition is gone
    Unreadable {
        /// what a file of this format is made of: `message`
        unit: &'static str,
        /// how many
        count: u64,
        /// byte offset of the first
        first_byte: u64,
    },
    /// the file ends within a record, or with zeros
    CutOff {
        /// bytes at its end
        bytes: u64,
        /// byte offset of the first
        first_byte: u64,
    },
    /// rows of a table that cannot be used
    RowsRejected {
        /// how many
        count: u64,
        /// of how many
        of: u64,
        /// the first of them
        first: Option<RowRejection>,
    },
    /// a row of a table has no end: nothing is read from there on
    EndlessRow {
        /// line in which it begins, the header being 1
        line: u64,
    },
    /// rows of a table with the time of another
    RepeatedTimes {
        /// how many
        count: u64,
        /// line of the first, the header being 1
        first_line: u64,
    },
    /// attitudes that are no rotations: quaternions whose norm is not near one
    NoRotations {
        /// how many
        count: u64,
        /// line of the first, the header being 1
        first_line: u64,
    },
    /// messages with a time that fits no clock, left out
    StrayStamps {
        /// how many
        count: u64,
    },
    /// samples with a value that no vehicle has, left out
    Impossible {
        /// how many
        count: u64,
    },
    /// samples of a damaged log that leap away from those around them and back, left out
    Leaps {
        /// how many
        count: u64,
    },
    /// the log holds more flight than is kept in memory
    NotHeld {
        /// time in the air that is left out, s
        seconds: f64,
    },
}

/// Bytes of the longest message of a log that a vehicle writes: a ULog's, with its head.
const LONGEST_MESSAGE: u64 = 65_538;

impl Loss {
    /// Whether it is no more than the record that was being written when the file was read.
    #[must_use]
    pub fn is_unfinished_record(&self) -> bool {
        matches!(self, Self::CutOff { bytes, .. } if *bytes <= LONGEST_MESSAGE)
    }
}

/// Where in a file something is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Position {
    /// byte offset
    Byte(u64),
    /// line, the first being 1
    Line(u64),
}

/// A row of a table that was left out.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RowRejection {
    /// line in the file, the header being 1
    pub line: u64,
    /// what was expected and what came
    pub reason: String,
}

impl Loss {
    /// Where it was met first; `None` where it is no place in the file.
    #[must_use]
    pub fn first(&self) -> Option<Position> {
        match self {
            Self::WrongChecksum { first_byte, .. }
            | Self::Skipped { first_byte, .. }
            | Self::Unreadable { first_byte, .. }
            | Self::CutOff { first_byte, .. } => Some(Position::Byte(*first_byte)),
            Self::RowsRejected { first, .. } => first.as_ref().map(|row| Position::Line(row.line)),
            Self::EndlessRow { line } => Some(Position::Line(*line)),
            Self::RepeatedTimes { first_line, .. } | Self::NoRotations { first_line, .. } => {
                Some(Position::Line(*first_line))
            }
            Self::StrayStamps { .. }
            | Self::Impossible { .. }
            | Self::Leaps { .. }
            | Self::NotHeld { .. } => None,
        }
    }

    /// Bytes of the file are others than were written: what can still be read may be wrong as well.
    #[must_use]
    pub fn is_damage(&self) -> bool {
        matches!(self, Self::Skipped { .. } | Self::Unreadable { .. } | Self::Impossible { .. })
    }
}

impl fmt::Display for Loss {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::WrongChecksum { unit, count, .. } => {
                write!(f, "{count} {unit}s with a wrong checksum dropped")
            }
            Self::Skipped { unit, bytes, places, first_byte } => {
                write!(
                    f,
                    "{bytes} bytes of no {unit} skipped in {places} places, the first at byte {first_byte}"
                )
            }
            Self::Unreadable { unit, count, first_byte } => {
                write!(f, "{count} {unit}s cannot be read, the first at byte {first_byte}")
            }
            Self::CutOff { bytes, .. } => write!(f, "{bytes} bytes of a record cut off at the end"),
            Self::RowsRejected { count, of, first } => {
                write!(f, "{count} of {of} rows rejected")?;
                first
                    .as_ref()
                    .map_or(Ok(()), |row| write!(f, ", the first in line {}: {}", row.line, row.reason))
            }
            Self::EndlessRow { line } => {
                write!(f, "nothing is read from line {line} on, whose row has no end")
            }
            Self::RepeatedTimes { count, .. } => write!(f, "{count} rows repeat a time and were left out"),
            Self::NoRotations { count, .. } => {
                write!(f, "{count} attitudes are no rotations and were left out")
            }
            Self::StrayStamps { count } => {
                write!(f, "{count} messages with a time that fits no clock were left out")
            }
            Self::Impossible { count } => {
                write!(f, "{count} samples with a value that no vehicle has were left out")
            }
            Self::Leaps { count } => write!(
                f,
                "{count} samples that leap away from those around them and back were left out: the log is damaged"
            ),
            Self::NotHeld { seconds } => write!(
                f,
                "{seconds:.0} s of flight at the end are left out: the log holds more than is analysed at once; cut it to \
                 analyse the rest"
            ),
        }
    }
}

/// What is odd about a log although nothing is lost by it. Its text is what a user is told.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Oddity {
    /// host stamps before their predecessor
    BackwardStamps {
        /// how many
        count: u64,
        /// how many of these further than any link explains
        far: u64,
        /// the furthest, microseconds
        most_us: u64,
    },
    /// host stamps of no wall clock
    ImplausibleStamps {
        /// how many
        count: u64,
    },
    /// the vehicle could not write as fast as it measured
    Dropouts {
        /// how often
        count: u64,
        /// how long together, milliseconds
        ms: u64,
    },
    /// the recording computer's clock was set while the vehicle's went on
    HostClockSet {
        /// how often
        count: u64,
    },
    /// stamps of the vehicle run back for good: pieces of a log in another order, or two logs in one
    VehicleClockBack {
        /// how often
        count: u64,
        /// the furthest, microseconds
        most_us: u64,
    },
    /// the vehicle could not write as fast as it logged
    DroppedByVehicle {
        /// messages that it dropped, by its own count
        count: u64,
    },
    /// samples whose messages carry no time, as those of releases of before 2014: they are not read
    WithoutTime {
        /// how many
        count: u64,
        /// commands of the motors are among them
        outputs: bool,
    },
    /// samples of which the log does not say in which unit they are, and releases differ: they are not read
    UnknownUnit {
        /// how many
        count: u64,
    },
}

impl fmt::Display for Oddity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::BackwardStamps { count, most_us, .. } => {
                let most_s = seconds_from_us(*most_us as f64);
                write!(f, "{count} host stamps run backwards, by {most_s:.3} s at most")
            }
            Self::ImplausibleStamps { count } => write!(
                f,
                "{count} host time stamps are not plausible dates (before 2010 or after 2100): the recording computer's clock was \
                 not set"
            ),
            Self::Dropouts { count, ms } => {
                let seconds = seconds_from_ms(*ms as f64);
                write!(f, "the vehicle could not write fast enough {count} times: {seconds:.3} s are missing")
            }
            Self::HostClockSet { count } => {
                write!(f, "the recording computer's clock was set {count} times while the vehicle's went on")
            }
            Self::VehicleClockBack { count, most_us } => {
                let most_s = seconds_from_us(*most_us as f64);
                write!(f, "the vehicle's stamps run back {count} times, by {most_s:.1} s at most")
            }
            Self::DroppedByVehicle { count } => {
                write!(f, "the vehicle dropped {count} messages before it could write them")
            }
            Self::WithoutTime { count, outputs } => {
                let among = if *outputs { ", motor outputs among them," } else { "" };
                write!(f, "{count} samples{among} have no time stamps of the vehicle and are not read")
            }
            Self::UnknownUnit { count } => {
                write!(f, "{count} samples are in a unit that differs between releases and are not read")
            }
        }
    }
}
