//! What was met while reading a log.

use std::collections::BTreeMap;

use super::csv::CsvReport;
use super::loss::{Loss, Oddity, Position};
use super::onboard::OnboardReport;
use super::tlog::TlogReport;
use crate::autopilot::VehicleKind;
use crate::recording::{Recording, StreamKey, StreamRepair};
use crate::wire::{SystemId, Vehicle};

/// Share of a log's bytes without which it is damaged so much that streams may be gone, and that which is most of it.
/// Only the words of the report depend on it: with less a sound log with a torn end would be called damaged.
const DAMAGED: f64 = 0.1;
/// See [`DAMAGED`].
const MOSTLY: f64 = 0.5;
/// Steps back of a log's stamps that nothing but another order explains. A single damaged stamp makes one step back;
/// five in one log are no chance.
const OUT_OF_ORDER: u64 = 5;
/// One message of so many that the vehicle wrote may run back by a damaged stamp. More would call a log sorted
/// wrongly damaged, less a damaged one sorted wrongly; both are told, and neither is used.
const DAMAGED_STAMPS: u64 = 500;

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
    /// Takes what putting the samples into streams took.
    pub(super) fn repaired(&mut self, streams: BTreeMap<StreamKey, StreamRepair>) {
        let count = streams.values().map(|repair| repair.impossible).sum();
        self.losses.extend((count > 0).then_some(Loss::Impossible { count }));
        self.streams = streams;
    }

    /// The vehicle wrote the log itself and it is damaged: it has no checksums, and what is read of it may be wrong.
    #[must_use]
    pub fn is_damaged(&self) -> bool {
        self.onboard().is_some() && self.losses.iter().any(Loss::is_damage)
    }

    /// Leaves the samples out of the recording of a damaged log that leap.
    pub(super) fn leave_out_leaps(&mut self, recording: &mut Recording) {
        if !self.is_damaged() {
            return;
        }
        let count = recording.leave_out_leaps();
        self.losses.extend((count > 0).then_some(Loss::Leaps { count }));
    }

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

    /// When it began, microseconds since 1970 UTC: by the clock of the ground station, or by that of the vehicle's satellite receiver.
    #[must_use]
    pub fn start_utc_us(&self) -> Option<u64> {
        match &self.details {
            Details::Telemetry(report) => report.first_stamp_us.filter(|_| report.odd_stamps == 0),
            Details::Onboard(report) => report.start_utc_us,
            Details::Table(_) | Details::None => None,
        }
    }

    /// Messages carry times of the vehicle's: some that ArduPilot wrote until 2013 do not.
    #[must_use]
    pub fn is_timed(&self) -> bool {
        let untimed = |oddity: &Oddity| matches!(oddity, Oddity::WithoutTime { .. });
        self.holds_times() || !self.oddities.iter().any(untimed)
    }

    /// Its motor outputs carry no time of the vehicle's, whatever its other messages do: no time, no samples of them.
    #[must_use]
    pub fn has_untimed_outputs(&self) -> bool {
        self.oddities.iter().any(|oddity| matches!(oddity, Oddity::WithoutTime { outputs: true, .. }))
    }

    /// Messages that cannot be read in a log that the vehicle wrote, if they are a tenth of all and more: damage that takes
    /// streams away.
    #[must_use]
    pub fn unreadable(&self) -> Option<u64> {
        let of = |loss: &Loss| if let Loss::Unreadable { count, .. } = loss { *count } else { 0 };
        let count = self.losses.iter().map(of).sum::<u64>();
        self.onboard().filter(|log| count > log.messages / 10).map(|_| count)
    }

    /// Most of it are messages that nothing in it defines: its beginning is missing, or damaged beyond reading.
    #[must_use]
    pub fn lacks_definitions(&self) -> bool {
        let at_once = |loss: &Loss| loss.first() == Some(Position::Byte(0));
        let is_of_beginning = !self.holds_times() || self.losses.iter().any(at_once);
        self.onboard().is_some() && is_of_beginning && self.passed_share() > MOSTLY
    }

    /// How much of a log that the vehicle wrote is damaged, in words, if it is so much that streams may be gone with it.
    #[must_use]
    pub fn damage(&self) -> Option<String> {
        let skipped = |loss: &Loss| if let Loss::Skipped { bytes, .. } = loss { *bytes } else { 0 };
        // an end that was cut off is no damage
        let share = self.share_of(skipped);
        let by_messages = || self.unreadable().map(|count| format!("{count} of its messages cannot be read"));
        let by_bytes =
            (share > DAMAGED).then(|| format!("{:.0} % of its bytes cannot be read", 100.0 * share));
        by_bytes.or_else(by_messages)
    }

    /// Share of a log that the vehicle wrote which is no message, 0 to 1.
    fn passed_share(&self) -> f64 {
        let passed = |loss: &Loss| match loss {
            Loss::Skipped { bytes, .. } => *bytes,
            Loss::CutOff { bytes, .. } if !loss.is_unfinished_record() => *bytes,
            _ => 0,
        };
        self.share_of(passed)
    }

    /// Share of a log that the vehicle wrote, 0 to 1, that its losses have of these bytes.
    fn share_of(&self, bytes: impl Fn(&Loss) -> u64) -> f64 {
        let passed: u64 = self.losses.iter().map(bytes).sum();
        self.onboard().map_or(0.0, |log| passed as f64 / log.bytes.max(1) as f64)
    }

    /// How often its stamps run back, where that is too often for clocks that were set or vehicles that started anew: its
    /// messages stand in another order than they were written in.
    #[must_use]
    pub fn out_of_order(&self) -> Option<u64> {
        let back = |oddity: &Oddity| match oddity {
            Oddity::VehicleClockBack { count, .. } => *count,
            Oddity::BackwardStamps { far, .. } => *far,
            _ => 0,
        };
        // damaged stamps run back here and there
        let least = OUT_OF_ORDER.max(self.onboard().map_or(0, |log| log.messages / DAMAGED_STAMPS));
        self.oddities.iter().map(back).max().filter(|count| *count >= least)
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
