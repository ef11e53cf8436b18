//! The readers' reports as they are told, and what of them is loss.

use super::inspection::{CsvReading, SenderSummary, TlogReading};
use crate::log::csv::CsvReport;
use crate::log::{ByteOrder, ReadReport, Source};

/// Damaged places told one by one.
const TOLD_RESYNCS: usize = 20;

/// A telemetry log's report.
pub(super) fn tlog_reading(report: &ReadReport) -> TlogReading {
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

/// What of the file itself was lost. Frames that a radio lost before the file was written show as gaps in
/// the sequence; they are told, but they are not the file's loss.
pub(super) fn tlog_losses(reading: &TlogReading) -> Vec<String> {
    let mut losses = Vec::new();
    if reading.bad_crc > 0 {
        losses.push(format!("{} frames with a wrong checksum dropped", reading.bad_crc));
    }
    if reading.resync_count > 0 {
        let first = reading.resyncs.first().map_or(0, |(offset, _)| *offset);
        losses.push(format!(
            "{} bytes skipped in {} damaged places, the first at byte {first}",
            reading.skipped_bytes, reading.resync_count
        ));
    }
    if reading.truncated_tail_bytes > 0 {
        losses.push(format!("{} bytes of a record cut off at the end", reading.truncated_tail_bytes));
    }
    losses
}

/// A table's report.
pub(super) fn csv_reading(report: &CsvReport) -> CsvReading {
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

/// What of the table was left out.
pub(super) fn csv_losses(reading: &CsvReading) -> Vec<String> {
    let mut losses = Vec::new();
    if reading.rows_rejected > 0 {
        let first = reading
            .rejections
            .first()
            .map_or_else(String::new, |(line, reason)| format!(", the first in line {line}: {reason}"));
        losses.push(format!("{} of {} rows rejected{first}", reading.rows_rejected, reading.rows));
    }
    if reading.rows_repeating_a_time > 0 {
        losses.push(format!("{} rows repeat a time and were left out", reading.rows_repeating_a_time));
    }
    if reading.invalid_attitudes > 0 {
        losses.push(format!("{} attitudes are no rotations and were left out", reading.invalid_attitudes));
    }
    losses
}
