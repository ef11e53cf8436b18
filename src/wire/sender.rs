//! What one sender sent: frames by message, and those that are missing by the sequence number.

use std::collections::BTreeMap;

use super::frame::{ComponentId, Frame, SystemId};

/// A frame this many frames late is out of order, not the sign of a great loss.
const LATE_FRAMES: u8 = 8;
/// The same frame again within so many frames of its sender is a duplicate.
const DUPLICATE_FRAMES: u32 = 128;
const DENSE_IDS: usize = 512;

/// One (system, component) that sent frames.
#[derive(Debug, Clone, PartialEq)]
pub struct Sender {
    /// system
    pub system: SystemId,
    /// component
    pub component: ComponentId,
    /// frames
    pub frames: u64,
    /// frames missing by the sequence number
    pub lost: u64,
    /// frames that came twice
    pub duplicates: u64,
    /// frames by message id
    pub messages: MessageCounts,
    next_sequence: Option<u8>,
    recent: Box<[(u16, u32)]>,
}

/// Frames by message id.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct MessageCounts {
    dense: Vec<u64>,
    others: BTreeMap<u32, u64>,
}

impl MessageCounts {
    fn add(&mut self, message_id: u32) {
        match usize::try_from(message_id) {
            Ok(index) if index < DENSE_IDS => {
                if self.dense.len() <= index {
                    self.dense.resize(DENSE_IDS, 0);
                }
                self.dense[index] += 1;
            }
            _ => *self.others.entry(message_id).or_default() += 1,
        }
    }

    /// Message ids with their counts, in order of ids.
    pub fn iter(&self) -> impl Iterator<Item = (u32, u64)> + '_ {
        let dense = (0_u32..).zip(self.dense.iter().copied()).filter(|(_, count)| *count > 0);
        dense.chain(self.others.iter().map(|(id, count)| (*id, *count)))
    }

    /// Frames of one message.
    #[must_use]
    pub fn get(&self, message_id: u32) -> u64 {
        let dense = usize::try_from(message_id).ok().and_then(|index| self.dense.get(index));
        dense.or_else(|| self.others.get(&message_id)).copied().unwrap_or(0)
    }
}

impl Sender {
    /// A sender of which nothing was heard yet.
    #[must_use]
    pub fn new(system: SystemId, component: ComponentId) -> Self {
        Self {
            system,
            component,
            frames: 0,
            lost: 0,
            duplicates: 0,
            messages: MessageCounts::default(),
            next_sequence: None,
            recent: vec![(0, u32::MAX); 256].into_boxed_slice(),
        }
    }

    /// Counts one of its frames, given in the order of arrival.
    pub fn tally(&mut self, frame: &Frame<'_>) {
        let header = frame.header();
        let sequence = header.sequence;
        let number = u32::try_from(self.frames & u64::from(u32::MAX >> 1)).unwrap_or(0);
        self.frames += 1;
        self.messages.add(header.message_id);
        let seen = &mut self.recent[usize::from(sequence)];
        let checksum = frame.sent_checksum();
        let duplicate = seen.0 == checksum && number.wrapping_sub(seen.1) < DUPLICATE_FRAMES;
        *seen = (checksum, number);
        if duplicate {
            self.duplicates += 1;
            return;
        }
        let gap = self.next_sequence.map_or(0, |expected| sequence.wrapping_sub(expected));
        if gap > u8::MAX - LATE_FRAMES {
            self.lost = self.lost.saturating_sub(1);
        } else {
            self.lost += u64::from(gap);
            self.next_sequence = Some(sequence.wrapping_add(1));
        }
    }
}
