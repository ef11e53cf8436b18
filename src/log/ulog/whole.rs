//! A log that is read whole: messages of topics are not decoded one after the other. They are gathered by topic, and then each
//! stream is decoded by itself, side by side with the others and with the gathering of what follows.

use std::io::Read;

use super::clock::Clock;
use super::decode::{Decoder, Places, Topic, time_s};
use super::reader::UlogReader;
use super::topics::Bound;
use crate::log::date::Date;
use crate::log::error::LogError;
use crate::recording::{Event, Growing, RecordingBuilder};

/// A topic has fewer streams.
const MOST_STREAMS: usize = 64;

/// Messages by topic, as far as they follow each other without anything else between them.
#[derive(Debug, Default)]
struct Gathered {
    /// that of all of them
    clock: Clock,
    count: usize,
    /// times at which the estimate jumped, s
    jumps_s: Vec<f64>,
    by_topic: Vec<Run>,
}

/// Messages of one topic, all of the same length.
#[derive(Debug, Default)]
struct Run {
    /// number among the gathered, and stamp, microseconds
    stamps: Vec<(usize, u64)>,
    bytes: Vec<u8>,
    /// of one message
    length: usize,
}

/// Room for the messages that are decoded, and for those that are gathered meanwhile.
#[derive(Debug, Default)]
pub(super) struct Whole {
    ready: Gathered,
    next: Gathered,
}

impl Whole {
    /// Gives what data say to `builder`, as far as they follow each other; what is next, [`UlogReader::next_message`] gives. The
    /// same comes out as of [`Decoder::decode`] of one after the other.
    ///
    /// # Errors
    /// The log cannot be read.
    pub(super) fn decode<R: Read + Send>(
        &mut self,
        reader: &mut UlogReader<R>,
        decoder: &mut Decoder,
        builder: &mut RecordingBuilder,
    ) -> Result<(), LogError> {
        if decoder.places.is_empty() {
            bind(decoder, builder);
        }
        let Self { ready, next } = self;
        loop {
            let Decoder { streams, places, clock, date, topics, leap, .. } = &mut *decoder;
            let scan = Scan { clock, date, topics, may_follow: leap.is_none() };
            let (gathered, ()) =
                rayon::join(|| scan.gather(reader, next), || ready.decode(streams, places, builder));
            gathered?;
            ready.clear();
            std::mem::swap(ready, next);
            if ready.count == 0 {
                return Ok(());
            }
        }
    }
}

/// Finds out which stream of which topic goes to which place.
fn bind(decoder: &mut Decoder, builder: &mut RecordingBuilder) {
    let mut shared = Vec::new();
    for (slot, streams) in decoder.streams.iter().enumerate() {
        for (index, bound) in streams.iter().enumerate() {
            let place = builder.place(bound.key());
            if place >= decoder.places.len() {
                decoder.places.resize(place + 1, None);
            }
            match decoder.places[place] {
                // two numbers of one topic: what comes first tells the order of both
                Some((other, _)) => shared.extend([other, slot]),
                None => decoder.places[place] = Some((slot, index)),
            }
        }
    }
    for (slot, topic) in decoder.topics.iter_mut().enumerate() {
        let is_alone = !shared.contains(&slot) && decoder.streams[slot].len() < MOST_STREAMS;
        topic.iter_mut().for_each(|topic| topic.is_alone = is_alone);
    }
}

/// What judges messages while they are gathered.
struct Scan<'a> {
    clock: &'a mut Clock,
    date: &'a mut Date,
    topics: &'a mut [Option<Topic>],
    /// no message waits
    may_follow: bool,
}

impl Scan<'_> {
    /// Gathers the data that follow each other.
    fn gather<R: Read>(mut self, reader: &mut UlogReader<R>, into: &mut Gathered) -> Result<(), LogError> {
        into.clock = self.clock.clone();
        into.by_topic.resize_with(self.topics.len().max(into.by_topic.len()), Run::default);
        reader.run(&mut |id, stamp_us, bytes| self.take(id.into(), stamp_us, bytes, into))
    }

    /// `false` for a message that has to be looked at by itself.
    #[inline]
    fn take(&mut self, slot: usize, stamp_us: Option<u64>, bytes: &[u8], into: &mut Gathered) -> bool {
        let order = into.count;
        let (Some(Some(topic)), Some(stamp_us)) = (self.topics.get_mut(slot), stamp_us) else {
            into.count += 1;
            return true;
        };
        let Some(run) = into.by_topic.get_mut(slot) else { return false };
        let follows = topic.is_alone && self.may_follow && self.clock.goes_on(stamp_us, topic.last_us);
        if !follows || !run.stamps.is_empty() && bytes.len() != run.length {
            return false;
        }
        self.clock.go_on(stamp_us);
        topic.last_us = Some(stamp_us);
        if topic.resets.jumped(bytes) {
            into.jumps_s.push(self.clock.seconds(stamp_us));
        }
        if let Some(utc) = topic.utc.filter(|_| !self.date.is_known()) {
            self.date.utc_us(utc.read(bytes), self.clock.seconds(stamp_us));
        }
        into.count += 1;
        run.length = bytes.len();
        run.stamps.push((order, stamp_us));
        run.bytes.extend_from_slice(bytes);
        true
    }
}

impl Gathered {
    fn clear(&mut self) {
        self.count = 0;
        self.jumps_s.clear();
        for run in &mut self.by_topic {
            run.stamps.clear();
            run.bytes.clear();
        }
    }

    /// Gives what the messages say to `builder`.
    fn decode(&self, streams: &[Vec<Bound>], places: &Places, builder: &mut RecordingBuilder) {
        if self.count == 0 {
            return;
        }
        self.jumps_s.iter().for_each(|time_s| builder.add(Event::EstimatorReset { time_s: *time_s }));
        builder.fill(|place, growing| {
            let (slot, index) = places.get(place).copied()??;
            let (run, bound) = (self.by_topic.get(slot)?, streams.get(slot)?.get(index)?);
            let (order, time_s) = run.decode(&self.clock, bound, growing)?;
            Some((order * MOST_STREAMS + index, time_s))
        });
    }
}

impl Run {
    /// Adds one stream's samples; the order of the message and the time, s, of the last one.
    fn decode(&self, clock: &Clock, bound: &Bound, growing: &mut Growing) -> Option<(usize, f64)> {
        let mut last = None;
        for ((order, stamp_us), bytes) in self.stamps.iter().zip(self.bytes.chunks_exact(self.length.max(1)))
        {
            let Some(time_s) = time_s(clock, bound, bytes, *stamp_us) else { continue };
            bound.sample(bytes, |values| {
                growing.push(time_s, values);
                last = Some((*order, time_s));
            });
        }
        last
    }
}
