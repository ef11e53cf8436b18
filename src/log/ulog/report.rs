//! What was met while reading a ULog: every loss counted.

use super::schema::Subscription;
use crate::log::loss::{Loss, Oddity};
use crate::log::onboard::is_pause;
use crate::units::seconds_from_us;
use std::sync::Arc;

/// Topics of one log that are told apart; PX4 has about 250.
const MOST_TOPICS: usize = 4096;

/// What was met while reading a ULog.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct UlogReport {
    /// bytes read
    pub bytes: u64,
    /// messages read, definitions included
    pub messages: u64,
    /// each instance of a topic
    pub topics: Vec<TopicCount>,
    /// times that the vehicle could not write fast enough
    pub dropouts: u64,
    /// how long that was together, ms
    pub dropouts_ms: u64,
    /// data of topics whose subscription is not there
    pub orphans: u64,
    /// messages whose contents are not what their kind says
    pub unreadable: u64,
    /// bytes of these two
    pub unreadable_bytes: u64,
    /// byte offset of the first of these
    pub first_unreadable: Option<u64>,
    /// places where bytes were skipped
    pub skips: u64,
    /// all bytes skipped there
    pub skipped_bytes: u64,
    /// byte offset of the first of these places
    pub first_skip: Option<u64>,
    /// a message cut off at the end, or zeros there: bytes, and their offset
    pub cut_off: Option<(u64, u64)>,
    /// logs in the file, one behind the other
    pub logs: u64,
    /// where the topic of each number is in `topics`
    by_id: Vec<Option<usize>>,
}

/// The messages of one instance of a topic.
#[derive(Debug, Clone, PartialEq)]
pub struct TopicCount {
    /// name
    pub topic: Arc<str>,
    /// instance, from 0
    pub instance: u8,
    /// how many
    pub count: u64,
    /// stamps of the first and the last, microseconds; `None` without a stamp
    pub stamps_us: Option<(u64, u64)>,
    /// pauses between these, as between two flights, and how long they are together, microseconds
    pub paused_us: (u64, u64),
}

/// Shorter steps are no pauses, microseconds: most need not be looked at closer.
const LEAST_PAUSE_US: u64 = 3_000_000;

impl TopicCount {
    /// Nothing came for as long, after the messages of `before_us`.
    fn note_step(&mut self, step_us: u64, before_us: u64) {
        let (pauses, paused_us) = self.paused_us;
        let running_us = before_us.saturating_sub(paused_us);
        if is_pause(seconds_from_us(step_us as f64), seconds_from_us(running_us as f64), self.count) {
            self.paused_us = (pauses + 1, paused_us + step_us);
        }
    }
}

impl UlogReport {
    /// What of the file is gone; of topics that are read, `stale` messages were left out for their stamps.
    #[must_use]
    pub fn losses(&self, stale: u64) -> Vec<Loss> {
        let (unit, at) = ("message", |first: Option<u64>| first.unwrap_or(0));
        let unreadable = self.unreadable + self.orphans;
        let unreadable = (unreadable > 0).then(|| Loss::Unreadable {
            unit,
            count: unreadable,
            first_byte: at(self.first_unreadable),
        });
        let skipped = (self.skips > 0).then(|| Loss::Skipped {
            unit,
            bytes: self.skipped_bytes,
            places: self.skips,
            first_byte: at(self.first_skip),
        });
        let cut_off = self.cut_off.map(|(bytes, first_byte)| Loss::CutOff { bytes, first_byte });
        let stale = (stale > 0).then_some(Loss::StrayStamps { count: stale });
        [unreadable, stale, skipped, cut_off].into_iter().flatten().collect()
    }

    /// What is odd about it.
    #[must_use]
    pub fn oddities(&self) -> Vec<Oddity> {
        let dropouts = Oddity::Dropouts { count: self.dropouts, ms: self.dropouts_ms };
        (self.dropouts > 0).then_some(dropouts).into_iter().collect()
    }

    pub(super) fn note_begin(&mut self) {
        self.logs += 1;
        self.by_id.clear();
    }

    pub(super) fn note_subscription(&mut self, taken: &Subscription) {
        let same = |known: &TopicCount| known.topic == taken.topic && known.instance == taken.instance;
        let index = self.topics.iter().position(same).or_else(|| {
            let (topic, instance) = (Arc::clone(&taken.topic), taken.instance);
            self.topics.push(TopicCount { topic, instance, count: 0, stamps_us: None, paused_us: (0, 0) });
            Some(self.topics.len() - 1).filter(|index| *index < MOST_TOPICS)
        });
        self.topics.truncate(MOST_TOPICS);
        let slot = usize::from(taken.id);
        if slot >= self.by_id.len() {
            self.by_id.resize(slot + 1, None);
        }
        self.by_id[slot] = index;
    }

    #[inline]
    pub(super) fn note_data(&mut self, id: u16, stamp_us: Option<u64>) {
        let index = self.by_id.get(usize::from(id)).copied().flatten();
        let Some(topic) = index.and_then(|index| self.topics.get_mut(index)) else { return };
        if let Some(stamp_us) = stamp_us {
            let (first_us, last_us) = topic.stamps_us.unwrap_or((stamp_us, stamp_us));
            let step_us = stamp_us.saturating_sub(last_us);
            if step_us > LEAST_PAUSE_US {
                topic.note_step(step_us, last_us.saturating_sub(first_us));
            }
            topic.stamps_us = Some((first_us, stamp_us));
        }
        topic.count += 1;
    }

    pub(super) fn note_orphan(&mut self, offset: u64) {
        self.orphans += 1;
        self.first_unreadable.get_or_insert(offset);
    }

    pub(super) fn note_unreadable(&mut self, offset: u64, bytes: usize) {
        self.unreadable += 1;
        self.unreadable_bytes += bytes as u64;
        self.first_unreadable.get_or_insert(offset);
    }

    pub(super) fn note_skipped(&mut self, offset: u64, bytes: u64) {
        self.skips += 1;
        self.skipped_bytes += bytes;
        self.first_skip.get_or_insert(offset);
    }

    pub(super) fn note_cut_off(&mut self, offset: u64, bytes: u64) {
        self.cut_off = Some((bytes, offset));
    }

    pub(super) fn note_dropout(&mut self, body: &[u8]) {
        self.dropouts += 1;
        let ms = body.first_chunk().copied().map_or(0, u16::from_le_bytes);
        self.dropouts_ms += u64::from(ms);
    }
}
