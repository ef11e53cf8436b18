//! What passed a link.

use std::collections::BTreeMap;

use super::signing::Distrust;
use crate::wire::{ComponentId, Frame, Sender, SplitCounts, SystemId};

/// Largest number of senders that are distinguished; noise that looks like frames must not fill the memory.
const SENDERS: usize = 256;

/// What passed a link.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LinkStats {
    /// bytes received
    pub received_bytes: u64,
    /// whole frames received, unknown and wrongly signed ones included
    pub received_frames: u64,
    /// of these, frames whose message id the dialect does not have
    pub unknown: u64,
    /// whole frames dropped for a wrong checksum
    pub bad_crc: u64,
    /// bytes that belong to no frame
    pub skipped_bytes: u64,
    /// places where bytes had to be skipped
    pub resyncs: u64,
    /// frames not believed: their signature was not made with our key; not delivered
    pub badly_signed: u64,
    /// frames not believed: signed, but heard before or too old; not delivered
    pub replayed: u64,
    /// of these, the first of a stream and signed more than a minute in the past
    pub old: u64,
    /// frames not believed: not signed, where they should be; not delivered
    pub unsigned: u64,
    /// of these, MAVLink 1, which cannot be signed
    pub downgraded: u64,
    /// frames that nobody took in time: the reader's queue was full. They are in the recording
    pub undelivered: u64,
    /// datagrams from others than the peer, dropped
    pub stranger_datagrams: u64,
    /// bytes sent
    pub sent_bytes: u64,
    /// frames sent
    pub sent_frames: u64,
    /// frames given for sending that the link's loss overtook
    pub unsent: u64,
    /// messages of the slot that were not sent: a later one took their place, or they were withdrawn
    pub replaced: u64,
    /// times that the other end was lost
    pub losses: u64,
    /// who sent what
    pub senders: BTreeMap<(SystemId, ComponentId), Sender>,
}

impl LinkStats {
    /// Frames missing by the sequence numbers of all senders.
    #[must_use]
    pub fn lost(&self) -> u64 {
        self.senders.values().map(|sender| sender.lost).sum()
    }

    pub(super) fn tally(&mut self, frame: &Frame<'_>) {
        self.received_frames += 1;
        let key = (frame.header().system, frame.header().component);
        if self.senders.len() < SENDERS || self.senders.contains_key(&key) {
            self.senders.entry(key).or_insert_with(|| Sender::new(key.0, key.1)).tally(frame);
        }
    }

    pub(super) fn count(&mut self, distrust: Distrust) {
        match distrust {
            Distrust::Unsigned | Distrust::Downgraded => self.unsigned += 1,
            Distrust::Wrong => self.badly_signed += 1,
            Distrust::Replayed | Distrust::Old { .. } => self.replayed += 1,
        }
        self.downgraded += u64::from(distrust == Distrust::Downgraded);
        self.old += u64::from(matches!(distrust, Distrust::Old { .. }));
    }

    /// Takes over what the splitter counted; bytes skipped since the last frame are one resync.
    pub(super) fn take_over(&mut self, counts: &SplitCounts) {
        self.resyncs += u64::from(counts.skipped_bytes > self.skipped_bytes);
        self.skipped_bytes = counts.skipped_bytes;
        self.unknown = counts.unknown;
        self.bad_crc = counts.bad_crc;
    }
}
