//! A log by LOG_REQUEST_DATA: pieces of ranges, and the gaps that were left.

use std::time::Duration;

use mavlink::dialects::ardupilotmega::MavMessage;

use super::fetched::{Fetched, Sum};
use super::pace::Pace;
use super::peer::{LOG_DATA_BYTES, Peer};
use super::window::Window;
use super::{Dialogue, FetchError};
use crate::wire::Frame;

/// Bytes that are asked for at once.
const CHUNK: u64 = 512 * LOG_DATA_BYTES as u64;
/// Gaps with no more between them than this are asked for together: a message costs less than a request.
const BETWEEN: u64 = 2 * LOG_DATA_BYTES as u64;
/// A gap of this many bytes at most is asked for without waiting for the answer to the one before.
const SMALL: u64 = 8 * LOG_DATA_BYTES as u64;
/// Between two requests for small gaps: so many times the spacing of a stream's messages, within these bounds. A vehicle
/// that still answers the one before drops or replaces it, and then the gap is asked for again.
const SPACINGS: u32 = 4;
const BETWEEN_REQUESTS: (Duration, Duration) = (Duration::from_millis(10), Duration::from_millis(100));
/// Requests in a row that bring nothing, at most; a round of small ones counts as one.
const BARREN: u32 = 24;
/// Words in a row that the log ends before the stated size; one may be of an earlier request.
const ENDS: u32 = 3;

/// What is asked for: one range, or a round of small gaps.
#[derive(Debug)]
struct Request {
    /// from and to of each, in order; at least one
    ranges: Vec<(u64, u64)>,
    /// of these sent
    sent: usize,
    began: Duration,
    last_sent: Duration,
    heard: Option<Duration>,
    is_over: bool,
    brought: bool,
}

impl Request {
    fn is_round(&self) -> bool {
        self.ranges.len() > 1
    }

    /// The next of a round that is to be sent.
    fn next_range(&self) -> Option<(u64, u64)> {
        self.ranges.get(self.sent).copied()
    }

    /// Its ranges begin at this byte or before.
    fn covers(&self, offset: u64) -> bool {
        self.ranges.first().is_some_and(|(from, _)| *from <= offset)
    }

    /// One of its ranges ends at this byte.
    fn ends_at(&self, end: u64) -> bool {
        self.ranges.iter().any(|(_, to)| *to == end)
    }

    fn to(&self) -> u64 {
        self.ranges.last().map_or(0, |(_, to)| *to)
    }
}

/// Reads one log.
#[derive(Debug)]
pub(super) struct LogReading {
    peer: Peer,
    pace: Pace,
    id: u16,
    window: Window,
    request: Option<Request>,
    barren: u32,
    first_barren: Duration,
    ends: u32,
    ended_at: u64,
    is_done: bool,
}

impl LogReading {
    /// Of the log of this number, of which `begin` bytes of `size` are there already.
    pub(super) fn new(peer: Peer, id: u16, begin: u64, size: u64) -> Self {
        Self {
            peer,
            pace: Pace::default(),
            id,
            window: Window::new(begin, size),
            request: None,
            barren: 0,
            first_barren: Duration::ZERO,
            ends: 0,
            ended_at: 0,
            is_done: false,
        }
    }

    pub(super) fn window(&mut self) -> &mut Window {
        &mut self.window
    }

    pub(super) fn fetched(&self) -> Option<Fetched> {
        let size = self.window.size();
        self.is_done.then_some(Fetched { size, sum: Sum::NotOffered, grown_to: None })
    }

    pub(super) fn farewell(&self) -> MavMessage {
        self.peer.request_end()
    }

    /// What is asked for next: the small gaps before the first large one, a large one, or what comes after all of them.
    fn ranges_due(&self) -> Vec<(u64, u64)> {
        let mut ranges: Vec<(u64, u64)> = Vec::new();
        for (from, to) in self.window.gaps() {
            match ranges.last_mut() {
                Some((first, last)) if from - *last <= BETWEEN && to - *first <= SMALL => *last = to,
                _ => ranges.push((from, to)),
            }
        }
        let small = ranges.iter().take_while(|(from, to)| to - from <= SMALL).count();
        match (ranges.first().copied(), small) {
            (Some((from, to)), 0) => vec![(from, to.min(from + CHUNK))],
            (Some(_), small) => {
                ranges.truncate(small);
                ranges
            }
            (None, _) => {
                let begin = self.window.begin();
                vec![(begin, self.window.size().min(begin + CHUNK))]
            }
        }
    }

    fn request_of(&self, (from, to): (u64, u64)) -> MavMessage {
        let bytes = |value: u64| u32::try_from(value).unwrap_or(u32::MAX);
        self.peer.request_data(self.id, bytes(from), bytes(to - from))
    }

    /// Whether what was asked for is still to be waited for, and counts what brought nothing.
    fn is_waited_for(&mut self, now: Duration) -> Result<bool, FetchError> {
        let Some(request) = &self.request else { return Ok(false) };
        let since =
            now.saturating_sub(request.heard.map_or(request.last_sent, |heard| heard.max(request.last_sent)));
        if !request.is_over && since < self.pace.silence(self.barren) {
            return Ok(true);
        }
        if request.brought {
            self.barren = 0;
            return Ok(false);
        }
        if self.barren == 0 {
            self.first_barren = request.began;
        }
        self.barren += 1;
        if self.barren < BARREN {
            return Ok(false);
        }
        Err(FetchError::Silent {
            expected: format!("log {} from byte {} on", self.id, self.window.begin()),
            tries: self.barren,
            seconds: now.saturating_sub(self.first_barren).as_secs(),
        })
    }
}

impl Dialogue for LogReading {
    fn poll(&mut self, now: Duration) -> Result<Option<MavMessage>, FetchError> {
        if self.is_done {
            return Ok(None);
        }
        if self.ends >= ENDS {
            return Err(FetchError::Short { stated: self.window.size(), came: self.ended_at });
        }
        if self.window.is_whole() {
            self.is_done = true;
            return Ok(Some(self.peer.request_end()));
        }
        let every = self.pace.between(SPACINGS, BETWEEN_REQUESTS);
        if let Some(request) = &mut self.request
            && let Some(range) = request.next_range()
        {
            if now.saturating_sub(request.last_sent) < every {
                return Ok(None);
            }
            request.sent += 1;
            request.last_sent = now;
            return Ok(Some(self.request_of(range)));
        }
        if self.is_waited_for(now)? {
            return Ok(None);
        }
        let ranges = self.ranges_due();
        let first = ranges.first().copied();
        self.request = Some(Request {
            ranges,
            sent: 1,
            began: now,
            last_sent: now,
            heard: None,
            is_over: false,
            brought: false,
        });
        Ok(first.map(|range| self.request_of(range)))
    }

    fn take(&mut self, now: Duration, frame: &Frame<'_>) {
        let (Some(data), Some(request)) = (self.peer.heard_data(frame), &mut self.request) else { return };
        if data.id != self.id {
            return;
        }
        match request.heard.replace(now) {
            // the answers to a round are as far apart as its requests
            Some(_) if request.is_round() => {}
            Some(before) => self.pace.spaced(now.saturating_sub(before)),
            None => self.pace.answered(now.saturating_sub(request.began)),
        }
        let offset = u64::from(data.offset);
        let mut bytes = data.data.get(..data.count.min(data.data.len())).unwrap_or(&[]).to_vec();
        bytes.resize(data.count, 0);
        request.brought |= self.window.take(offset, &bytes);
        let end = offset + data.count as u64;
        let is_of_it = request.covers(offset);
        request.is_over |= end == request.to() && is_of_it;
        if end < self.window.size()
            && data.count < LOG_DATA_BYTES
            && end < request.to()
            && is_of_it
            && !request.ends_at(end)
        {
            // it says that the log ends here
            request.is_over = true;
            self.ends = if self.ended_at == end { self.ends + 1 } else { 1 };
            self.ended_at = end;
        }
    }

    fn is_done(&self) -> bool {
        self.is_done
    }
}
