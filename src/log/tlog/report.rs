//! What was met while reading a telemetry log: every loss counted.

use std::collections::BTreeMap;

use crate::log::loss::{Loss, Oddity};
use crate::wire::{
    ByteOrder, ComponentId, DecodeReport, HOST_LEAP_US, HOST_STEP_US, Header, Record, Sender, SystemId,
    Version, is_wall_clock,
};

/// Damaged places kept with their offsets; further ones are only counted.
const KEPT_RESYNCS: usize = 1000;
/// Stamps of several threads run back against each other by less, which is not odd.
const TOLD_BACKWARD_US: u64 = 1_000_000;

/// Bytes that had to be skipped to find the next record.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Resync {
    /// byte offset in the file where the damage begins
    pub offset: u64,
    /// bytes that belong to no record
    pub skipped_bytes: u64,
}

/// What was met while reading a telemetry log.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TlogReport {
    /// bytes read
    pub bytes: u64,
    /// frames found, unknown ones included
    pub frames: u64,
    /// of these MAVLink 1
    pub frames_v1: u64,
    /// of these MAVLink 2
    pub frames_v2: u64,
    /// of these signed
    pub signed: u64,
    /// of these with a message id that the dialect does not have, by id
    pub unknown_ids: BTreeMap<u32, u64>,
    /// frames behind a stamp that another frame used already
    pub shared_stamps: u64,
    /// whole frames dropped for a wrong checksum
    pub bad_crc: u64,
    /// byte offset of the first of these
    pub first_bad_crc: Option<u64>,
    /// places where bytes were skipped, the first thousand
    pub resyncs: Vec<Resync>,
    /// all such places
    pub resync_count: u64,
    /// all bytes skipped there
    pub skipped_bytes: u64,
    /// bytes at the file's end: a record cut off, or zeros
    pub truncated_tail_bytes: u64,
    /// host stamps before their predecessor
    pub backward_stamps: u64,
    /// the furthest that a host stamp lies before its predecessor, microseconds
    pub backward_most_us: u64,
    /// stamps further before their predecessor than any link explains
    pub backward_far: u64,
    /// host stamps equal to their predecessor, of records with a stamp of their own
    pub doubled_stamps: u64,
    /// host stamps more than an hour after their predecessor: a pause, the seam of two logs, or a clock that was set
    pub leaping_stamps: u64,
    /// host stamps of no wall clock: before 2010 or after 2100
    pub odd_stamps: u64,
    /// first host stamp, microseconds since 1970 UTC
    pub first_stamp_us: Option<u64>,
    /// last host stamp, microseconds since 1970 UTC
    pub last_stamp_us: Option<u64>,
    /// order of the host stamps' bytes
    pub byte_order: ByteOrder,
    /// who sent what
    pub senders: Vec<Sender>,
    /// what became of the chosen vehicle's messages
    pub decode: DecodeReport,
    last_sender: usize,
}

impl TlogReport {
    /// Frames missing by the sequence numbers, of all senders.
    #[must_use]
    pub fn lost_frames(&self) -> u64 {
        self.senders.iter().map(|sender| sender.lost).sum()
    }

    /// Frames that came twice, of all senders.
    #[must_use]
    pub fn duplicates(&self) -> u64 {
        self.senders.iter().map(|sender| sender.duplicates).sum()
    }

    /// Nothing was lost, skipped or cut off.
    #[must_use]
    pub fn is_undamaged(&self) -> bool {
        self.bad_crc == 0
            && self.resync_count == 0
            && self.truncated_tail_bytes == 0
            && self.lost_frames() == 0
    }

    /// What of the file itself is gone. Frames that a link lost before the file was written show as gaps in the
    /// sequence: they are no loss of the file's.
    #[must_use]
    pub fn losses(&self) -> Vec<Loss> {
        let unit = "frame";
        let checksum =
            Loss::WrongChecksum { unit, count: self.bad_crc, first_byte: self.first_bad_crc.unwrap_or(0) };
        let skipped = Loss::Skipped {
            unit,
            bytes: self.skipped_bytes,
            places: self.resync_count,
            first_byte: self.resyncs.first().map_or(0, |resync| resync.offset),
        };
        let bytes = self.truncated_tail_bytes;
        let cut_off = Loss::CutOff { bytes, first_byte: self.bytes.saturating_sub(bytes) };
        [(self.bad_crc, checksum), (self.resync_count, skipped), (bytes, cut_off)]
            .into_iter()
            .filter_map(|(count, loss)| (count > 0).then_some(loss))
            .collect()
    }

    /// What is odd about the host's stamps; no frame is lost by it. Samples are placed by the vehicle's own clock.
    #[must_use]
    pub fn oddities(&self) -> Vec<Oddity> {
        let backward = Oddity::BackwardStamps {
            count: self.backward_stamps,
            far: self.backward_far,
            most_us: self.backward_most_us,
        };
        let (ran_back, most_us) = self.decode.ran_back;
        let implausible = Oddity::ImplausibleStamps { count: self.odd_stamps };
        let set = Oddity::HostClockSet { count: self.decode.host_steps };
        [
            (self.backward_most_us > TOLD_BACKWARD_US, backward),
            (self.odd_stamps > 0, implausible),
            (self.decode.host_steps > 0, set),
            (ran_back > 0, Oddity::VehicleClockBack { count: ran_back, most_us }),
        ]
        .into_iter()
        .filter_map(|(is_told, oddity)| is_told.then_some(oddity))
        .collect()
    }

    fn tally_stamp(&mut self, stamp_us: u64, last_us: Option<u64>, shared_stamp: bool) {
        self.odd_stamps += u64::from(!is_wall_clock(stamp_us));
        let Some(last_us) = last_us else { return };
        let back_us = last_us.saturating_sub(stamp_us);
        self.backward_stamps += u64::from(back_us > 0);
        self.backward_most_us = self.backward_most_us.max(back_us);
        self.backward_far += u64::from(back_us > HOST_STEP_US);
        self.doubled_stamps += u64::from(stamp_us == last_us && !shared_stamp);
        self.leaping_stamps += u64::from(stamp_us.saturating_sub(last_us) > HOST_LEAP_US);
    }

    pub(super) fn tally(&mut self, record: &Record<'_>, last_stamp_us: Option<u64>, shared_stamp: bool) {
        let header = record.frame.header();
        self.frames += 1;
        match header.version {
            Version::V1 => self.frames_v1 += 1,
            Version::V2 => self.frames_v2 += 1,
        }
        self.signed += u64::from(header.is_signed());
        self.shared_stamps += u64::from(shared_stamp);
        if !record.known {
            *self.unknown_ids.entry(header.message_id).or_default() += 1;
        }
        self.tally_stamp(record.stamp_us, last_stamp_us, shared_stamp);
        self.first_stamp_us.get_or_insert(record.stamp_us);
        self.last_stamp_us = Some(record.stamp_us);
        self.sender(header.system, header.component).tally(&record.frame);
    }

    /// Whether a frame's sender sent others before.
    pub(super) fn knows(&self, header: &Header) -> bool {
        self.senders
            .iter()
            .any(|sender| sender.system == header.system && sender.component == header.component)
    }

    pub(super) fn note_bad_crc(&mut self, offset: u64) {
        self.bad_crc += 1;
        self.first_bad_crc.get_or_insert(offset);
    }

    pub(super) fn note_resync(&mut self, offset: u64, skipped_bytes: u64) {
        self.resync_count += 1;
        self.skipped_bytes += skipped_bytes;
        if self.resyncs.len() < KEPT_RESYNCS {
            self.resyncs.push(Resync { offset, skipped_bytes });
        }
    }

    fn sender(&mut self, system: SystemId, component: ComponentId) -> &mut Sender {
        let same = |sender: &Sender| sender.system == system && sender.component == component;
        if !self.senders.get(self.last_sender).is_some_and(same) {
            self.last_sender = self.senders.iter().position(same).unwrap_or_else(|| {
                self.senders.push(Sender::new(system, component));
                self.senders.len() - 1
            });
        }
        &mut self.senders[self.last_sender]
    }
}
