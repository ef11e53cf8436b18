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
/// Requests in a row that bring nothing, at most.
const BARREN: u32 = 24;
/// Words in a row that the log ends before the stated size; one may be of an earlier request.
const ENDS: u32 = 3;

#[derive(Debug)]
struct Request {
    from: u64,
    to: u64,
    began: Duration,
    heard: Option<Duration>,
    is_over: bool,
    brought: bool,
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

    /// The next range that is missing.
    fn wanted(&self) -> (u64, u64) {
        let gaps = self.window.gaps();
        let Some((from, mut to)) = gaps.first().copied() else {
            let begin = self.window.begin();
            return (begin, self.window.size().min(begin + CHUNK));
        };
        for (next, end) in &gaps[1..] {
            if next - to > BETWEEN || end - from > CHUNK {
                break;
            }
            to = *end;
        }
        (from, to.min(from + CHUNK))
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
        if let Some(request) = &self.request {
            let since = now.saturating_sub(request.heard.unwrap_or(request.began));
            let is_over = request.is_over || since >= self.pace.silence(self.barren);
            if !is_over {
                return Ok(None);
            }
            if request.brought {
                self.barren = 0;
            } else {
                if self.barren == 0 {
                    self.first_barren = request.began;
                }
                self.barren += 1;
            }
            if self.barren >= BARREN {
                return Err(FetchError::Silent {
                    expected: format!("log {} from byte {} on", self.id, self.window.begin()),
                    tries: self.barren,
                    seconds: now.saturating_sub(self.first_barren).as_secs(),
                });
            }
        }
        let (from, to) = self.wanted();
        self.request = Some(Request { from, to, began: now, heard: None, is_over: false, brought: false });
        let bytes = |value: u64| u32::try_from(value).unwrap_or(u32::MAX);
        Ok(Some(self.peer.request_data(self.id, bytes(from), bytes(to - from))))
    }

    fn take(&mut self, now: Duration, frame: &Frame<'_>) {
        let (Some(data), Some(request)) = (self.peer.heard_data(frame), &mut self.request) else { return };
        if data.id != self.id {
            return;
        }
        match request.heard.replace(now) {
            Some(before) => self.pace.spaced(now.saturating_sub(before)),
            None => self.pace.answered(now.saturating_sub(request.began)),
        }
        let offset = u64::from(data.offset);
        let mut bytes = data.data.get(..data.count.min(data.data.len())).unwrap_or(&[]).to_vec();
        bytes.resize(data.count, 0);
        request.brought |= self.window.take(offset, &bytes);
        let end = offset + data.count as u64;
        request.is_over |= end == request.to && offset >= request.from;
        if end < self.window.size()
            && data.count < LOG_DATA_BYTES
            && end < request.to
            && offset >= request.from
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
