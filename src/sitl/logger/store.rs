//! The logs that are kept, in memory and bounded.

use std::collections::VecDeque;

use super::date::date;

/// Bytes of one log. One that would become longer ends.
const LOG_BYTES: usize = 48 << 20;
/// Bytes of all logs: the oldest make way for new ones.
const ALL_BYTES: usize = 64 << 20;
/// Logs that are kept.
const LOGS: usize = 32;

/// One log.
#[derive(Debug, Clone)]
pub(in crate::sitl) struct LogFile {
    /// counts from 1, and is never given again
    pub(in crate::sitl) number: u32,
    /// when it began, seconds since 1970
    pub(in crate::sitl) unix_s: u64,
    /// what was written so far
    pub(in crate::sitl) bytes: Vec<u8>,
    is_px4: bool,
}

impl LogFile {
    /// Folder below that of all logs, and name in it: PX4 has a folder a day.
    pub(in crate::sitl) fn place(&self) -> (Option<String>, String) {
        if !self.is_px4 {
            return (None, format!("{:08}.BIN", self.number));
        }
        let [year, month, day, hour, minute, second] = date(self.unix_s);
        (Some(format!("{year:04}-{month:02}-{day:02}")), format!("{hour:02}_{minute:02}_{second:02}.ulg"))
    }

    /// Length so far; no log is longer than a number of a message holds.
    pub(in crate::sitl) fn size(&self) -> u32 {
        u32::try_from(self.bytes.len()).unwrap_or(u32::MAX)
    }
}

/// The logs that are kept, oldest first.
#[derive(Debug)]
pub(in crate::sitl) struct LogStore {
    logs: VecDeque<LogFile>,
    is_px4: bool,
    next: u32,
    is_open: bool,
}

impl LogStore {
    pub(super) fn new(is_px4: bool) -> Self {
        Self { logs: VecDeque::new(), is_px4, next: 1, is_open: false }
    }

    /// All logs, oldest first.
    pub(in crate::sitl) fn all(&self) -> impl ExactSizeIterator<Item = &LogFile> {
        self.logs.iter()
    }

    /// Where the logs are, as MAVLink's file transfer names it.
    pub(in crate::sitl) fn root(&self) -> &'static str {
        if self.is_px4 { "/fs/microsd/log" } else { "/APM/LOGS" }
    }

    /// The log of a number.
    pub(in crate::sitl) fn get(&self, number: u32) -> Option<&LogFile> {
        self.logs.iter().find(|log| log.number == number)
    }

    /// Begins a log.
    pub(super) fn begin(&mut self, unix_s: u64) {
        let (number, is_px4) = (self.next, self.is_px4);
        self.logs.push_back(LogFile { number, unix_s, bytes: Vec::new(), is_px4 });
        self.next += 1;
        self.is_open = true;
        while self.logs.len() > LOGS {
            self.logs.pop_front();
        }
    }

    /// Ends the log that is written.
    pub(super) fn end(&mut self) {
        self.is_open = false;
    }

    /// A log is being written.
    pub(super) fn is_open(&self) -> bool {
        self.is_open
    }

    /// What the open log is written to; `None` where there is none, or it became too long.
    pub(super) fn open(&mut self) -> Option<&mut Vec<u8>> {
        if !self.is_open {
            return None;
        }
        let mut held: usize = self.logs.iter().map(|log| log.bytes.len()).sum();
        while held > ALL_BYTES && self.logs.len() > 1 {
            held -= self.logs.pop_front().map_or(0, |log| log.bytes.len());
        }
        self.is_open = self.logs.back().is_some_and(|log| log.bytes.len() < LOG_BYTES);
        self.logs.back_mut().filter(|_| self.is_open).map(|log| &mut log.bytes)
    }
}
