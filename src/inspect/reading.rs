//! The readers' reports as they are told.

use super::inspection::{CsvReading, Inspection, Reading, SenderSummary, TlogReading, VehicleSummary};
use super::onboard::onboard_reading;
use crate::autopilot::{Autopilot, VehicleKind};
use crate::log::csv::CsvReport;
use crate::log::{Details, ReadReport, TlogReport};
use crate::units::seconds_from_us;
use crate::wire::{ByteOrder, Sender, Source};

/// Damaged places told one by one.
const TOLD_RESYNCS: usize = 20;

impl Inspection {
    /// Whose clock says when the log began.
    #[must_use]
    pub fn start_words(&self) -> &'static str {
        if matches!(self.reading, Reading::Onboard(_)) { "UTC at its start" } else { "host's at its start" }
    }
}

/// What was met while reading.
pub(super) fn reading_of(report: &ReadReport) -> Reading {
    match &report.details {
        Details::Telemetry(telemetry) => Reading::Tlog(Box::new(tlog_reading(telemetry))),
        Details::Table(table) => Reading::Csv(csv_reading(table)),
        Details::Onboard(onboard) => Reading::Onboard(Box::new(onboard_reading(report, onboard))),
        Details::None => Reading::Other { name: report.format },
    }
}

/// A telemetry log's report.
fn tlog_reading(report: &TlogReport) -> TlogReading {
    let by_name = |list: &[(Source, u64)]| list.iter().map(|(source, n)| (source.name(), *n)).collect();
    let senders = report.senders.iter().map(|sender| SenderSummary {
        system: sender.system.0,
        component: sender.component.0,
        frames: sender.frames,
        lost: sender.lost,
        duplicates: sender.duplicates,
        messages: sender.messages.iter().collect(),
    });
    TlogReading {
        bytes: report.bytes,
        frames: report.frames,
        frames_v1: report.frames_v1,
        frames_v2: report.frames_v2,
        signed: report.signed,
        unknown_ids: report.unknown_ids.clone(),
        shared_stamps: report.shared_stamps,
        backward_stamps: report.backward_stamps,
        backward_most_s: seconds_from_us(report.backward_most_us as f64),
        doubled_stamps: report.doubled_stamps,
        leaping_stamps: report.leaping_stamps,
        odd_stamps: report.odd_stamps,
        host_steps: report.decode.host_steps,
        oddities: report.oddities().iter().map(ToString::to_string).collect(),
        little_endian_stamps: report.byte_order == ByteOrder::Little,
        bad_crc: report.bad_crc,
        resync_count: report.resync_count,
        skipped_bytes: report.skipped_bytes,
        resyncs: report
            .resyncs
            .iter()
            .take(TOLD_RESYNCS)
            .map(|resync| (resync.offset, resync.skipped_bytes))
            .collect(),
        truncated_tail_bytes: report.truncated_tail_bytes,
        sequence_lost: report.lost_frames(),
        duplicates: report.duplicates(),
        senders: senders.collect(),
        decoded: report.decode.decoded,
        stale_stamps: report.decode.stale_stamps,
        withheld_truth: report.decode.withheld_truth,
        unusable: by_name(&report.decode.unusable),
        empty: by_name(&report.decode.empty),
    }
}

/// A table's report.
fn csv_reading(report: &CsvReport) -> CsvReading {
    CsvReading {
        rows: report.rows,
        rows_rejected: report.rows_rejected,
        rejections: report.rejections.iter().map(|row| (row.line, row.reason.clone())).collect(),
        rows_out_of_order: report.rows_out_of_order,
        rows_repeating_a_time: report.rows_repeating_a_time,
        invalid_attitudes: report.invalid_attitudes,
        unused_columns: report.unused_columns.clone(),
    }
}

/// Whose log it is.
pub(super) fn vehicle_of(report: &ReadReport, autopilot: Autopilot) -> VehicleSummary {
    let speaker = report.vehicle;
    let heartbeats = |telemetry: &TlogReport| -> u64 {
        let own = |sender: &&Sender| {
            speaker.is_some_and(|own| own.system == sender.system && own.component == sender.component)
        };
        let beats = |sender: &Sender| sender.messages.get(Source::Heartbeat.message_id());
        telemetry.senders.iter().filter(own).map(beats).sum()
    };
    VehicleSummary {
        system: speaker.map(|speaker| speaker.system.0),
        component: speaker.map(|speaker| speaker.component.0),
        autopilot: autopilot.id(),
        others: report.others.iter().map(|system| system.0).collect(),
        without_heartbeat: report.telemetry().is_some_and(|telemetry| heartbeats(telemetry) == 0),
        kind: report.kind().map(VehicleKind::name),
        firmware: report.onboard().and_then(|onboard| onboard.firmware.clone()),
    }
}
