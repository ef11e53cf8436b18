//! What was met while reading a log.

use std::collections::BTreeMap;

use super::csv::CsvReport;
use super::loss::{Loss, Oddity};
use super::onboard::OnboardReport;
use super::tlog::TlogReport;
use crate::autopilot::VehicleKind;
use crate::recording::{StreamKey, StreamRepair};
use crate::wire::{SystemId, Vehicle};

/// What was met while reading a log, whatever its format.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ReadReport {
    /// name of the format
    pub format: &'static str,
    /// the vehicle that was read, where the log says whose it is
    pub vehicle: Option<Vehicle>,
    /// other vehicles in the log
    pub others: Vec<SystemId>,
    /// what of the file is not in the recording
    pub losses: Vec<Loss>,
    /// what is odd about it although nothing is lost by it
    pub oddities: Vec<Oddity>,
    /// what was done to put each stream's samples in order; empty where they were streamed
    pub streams: BTreeMap<StreamKey, StreamRepair>,
    /// what only this format has
    pub details: Details,
}

/// What only one format has.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum Details {
    /// nothing beyond the common
    #[default]
    None,
    /// frames, stamps and senders
    Telemetry(Box<TlogReport>),
    /// rows and columns
    Table(CsvReport),
    /// kind of vehicle, software, and each kind of message
    Onboard(Box<OnboardReport>),
}

impl ReadReport {
    /// Frames, stamps and senders, where it is a telemetry log.
    #[must_use]
    pub fn telemetry(&self) -> Option<&TlogReport> {
        match &self.details {
            Details::Telemetry(report) => Some(report),
            _ => None,
        }
    }

    /// Kind of vehicle, software and messages, where the vehicle wrote it itself.
    #[must_use]
    pub fn onboard(&self) -> Option<&OnboardReport> {
        match &self.details {
            Details::Onboard(report) => Some(report),
            _ => None,
        }
    }

    /// Messages carry times of the vehicle's: some that ArduPilot wrote until 2013 do not.
    #[must_use]
    pub fn is_timed(&self) -> bool {
        let untimed = |oddity: &Oddity| matches!(oddity, Oddity::WithoutTime { .. });
        self.holds_times() || !self.oddities.iter().any(untimed)
    }

    /// Messages that cannot be read in a log that the vehicle wrote, if they are a tenth of all and more: damage that takes
    /// streams away.
    #[must_use]
    pub fn unreadable(&self) -> Option<u64> {
        let of = |loss: &Loss| if let Loss::Unreadable { count, .. } = loss { *count } else { 0 };
        let count = self.losses.iter().map(of).sum::<u64>();
        self.onboard().filter(|log| count > log.messages / 10).map(|_| count)
    }

    /// Most of it are messages that nothing in it defines: its beginning is missing.
    #[must_use]
    pub fn lacks_definitions(&self) -> bool {
        let passed = |loss: &Loss| match loss {
            Loss::Skipped { bytes, .. } | Loss::CutOff { bytes, .. } => *bytes,
            _ => 0,
        };
        let passed: u64 = self.losses.iter().map(passed).sum();
        self.onboard().is_some_and(|log| !self.holds_times() && passed > log.bytes / 2)
    }

    /// It ends before its first message with a time, as a log that was cut off does.
    #[must_use]
    pub fn ends_early(&self) -> bool {
        self.onboard().is_some() && !self.holds_times() && self.is_timed()
    }

    fn holds_times(&self) -> bool {
        self.onboard().is_none_or(|log| log.topics.iter().any(|topic| topic.span_s.is_some()))
    }

    /// What kind of vehicle the log is of, where it says so.
    #[must_use]
    pub fn kind(&self) -> Option<VehicleKind> {
        let heard = || self.vehicle.and_then(|vehicle| vehicle.kind);
        self.onboard().map_or_else(heard, |onboard| onboard.kind)
    }

    /// Rows and columns, where it is a table.
    #[must_use]
    pub fn table(&self) -> Option<&CsvReport> {
        match &self.details {
            Details::Table(report) => Some(report),
            _ => None,
        }
    }
}
