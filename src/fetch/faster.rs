//! A log by the faster of two ways: the file transfer, and log messages where that is slow.
//!
//! ArduCopter's simulator brings 40 kB/s by file transfer and 3300 kB/s by LOG_REQUEST_DATA over TCP (issue 23). The file
//! transfer is measured first. If the rest takes long by it, log messages go on where the file stands, after its last
//! bytes once more: these have to be the same. The faster way stays. The checksum is that of the file transfer in either
//! case.

use super::part::COMPARED;
use std::time::Duration;

use mavlink::dialects::ardupilotmega::MavMessage;

use super::chosen::{Chosen, OtherWay};
use super::fetched::Fetched;
use super::ftp_reading::FtpReading;
use super::gauge::{Gauge, seconds};
use super::log_list::LogList;
use super::log_reading::LogReading;
use super::peer::Peer;
use super::remote::{Place, Protocol, RemoteLog};
use super::{Dialogue, FetchError};
use crate::wire::Frame;

/// Log messages are tried where the file transfer has more than this to go. Trying takes a list and 2 s, whose bytes
/// are kept. With less the trial would cost more than it gains.
const LONG_S: f64 = 10.0;
/// The list of log messages is waited for as long. A list that comes later costs more time than the faster way saves.
const LIST: Duration = Duration::from_secs(5);

#[derive(Debug)]
enum Way {
    Ftp(Box<FtpReading>),
    /// the list is asked for, since then
    List(LogList, Duration),
    /// after bytes that are compared
    Log(Box<LogReading>, Vec<u8>),
    /// all bytes are there by log messages: the vehicle's checksum of them
    Sum(Box<FtpReading>),
}

/// Reads one file by the faster way.
#[derive(Debug)]
pub(super) struct Faster {
    peer: Peer,
    path: String,
    way: Way,
    /// bytes a second of the file transfer, where it was found to be slow
    slow_bytes_s: Option<f64>,
    /// the way under way stays
    is_chosen: bool,
    /// of the way under way
    gauge: Gauge,
    /// bytes of the file, once known
    size: Option<u64>,
    /// bytes before this place were given or are due
    at: u64,
    due: Vec<u8>,
    /// the last of those before
    tail: Vec<u8>,
    /// bytes that came once more are others
    is_another: bool,
    /// to be sent to the way that is left
    farewell: Option<MavMessage>,
    chosen: Option<Chosen>,
}

impl Faster {
    /// Of the file at `path` of which `begin` bytes are there already.
    pub(super) fn new(peer: Peer, path: &str, begin: u64) -> Self {
        Self {
            peer,
            path: path.to_owned(),
            way: Way::Ftp(Box::new(FtpReading::new(peer, path, begin))),
            slow_bytes_s: None,
            is_chosen: false,
            gauge: Gauge::default(),
            size: None,
            at: begin,
            due: Vec::new(),
            tail: Vec::new(),
            is_another: false,
            farewell: None,
            chosen: None,
        }
    }

    pub(super) fn ready(&mut self) -> Vec<u8> {
        self.collect();
        std::mem::take(&mut self.due)
    }

    pub(super) fn size(&self) -> Option<u64> {
        self.size
    }

    pub(super) fn fetched(&self) -> Option<Fetched> {
        match &self.way {
            Way::Ftp(reading) | Way::Sum(reading) => reading.fetched(),
            Way::List(..) | Way::Log(..) => None,
        }
    }

    /// The way under way.
    pub(super) fn protocol(&self) -> Protocol {
        if matches!(self.way, Way::Ftp(_)) { Protocol::Ftp } else { Protocol::Log }
    }

    /// Bytes a second of the way that stays.
    pub(super) fn bytes_s(&self) -> Option<f64> {
        self.gauge.bytes_s().filter(|_| self.is_chosen)
    }

    /// Which way stays, once; nothing where the file transfer was fast enough.
    pub(super) fn chosen(&mut self) -> Option<Chosen> {
        self.chosen.take()
    }

    pub(super) fn farewell(&mut self, now: Duration) -> MavMessage {
        match &mut self.way {
            Way::Ftp(reading) | Way::Sum(reading) => reading.farewell(now),
            Way::List(..) | Way::Log(..) => self.peer.request_end(),
        }
    }

    /// Takes what the way under way has brought.
    fn collect(&mut self) {
        let (new, compared) = match &mut self.way {
            Way::Ftp(reading) => {
                let Some(window) = reading.window() else { return };
                self.size = Some(window.size());
                (window.ready(), &mut Vec::new())
            }
            Way::Log(reading, compared) => (reading.window().ready(), compared),
            Way::List(..) | Way::Sum(_) => return,
        };
        let again = compared.len().min(new.len());
        self.is_another |= compared[..again] != new[..again];
        if self.is_another {
            return;
        }
        compared.drain(..again);
        let new = &new[again..];
        self.at += new.len() as u64;
        self.due.extend_from_slice(new);
        self.tail.extend_from_slice(new);
        self.tail.drain(..self.tail.len().saturating_sub(COMPARED));
    }

    /// The file transfer is slow: log messages are tried.
    fn try_log(&mut self, now: Duration, ftp_bytes_s: f64) {
        self.farewell = Some(self.farewell(now));
        self.slow_bytes_s = Some(ftp_bytes_s);
        self.way = Way::List(LogList::new(self.peer), now);
    }

    /// Log messages are no way for this log, or the slower one.
    fn back_to_ftp(&mut self, now: Duration, log: OtherWay) {
        self.farewell = Some(self.farewell(now));
        self.choose(Protocol::Ftp, log);
        self.gauge = Gauge::default();
        self.way = Way::Ftp(Box::new(FtpReading::new(self.peer, &self.path, self.at)));
    }

    fn choose(&mut self, protocol: Protocol, log: OtherWay) {
        self.is_chosen = true;
        self.chosen = self.slow_bytes_s.map(|ftp_bytes_s| Chosen { protocol, ftp_bytes_s, log });
    }

    /// The number of this log among the log messages: the last one of its length, or the last one if it was written on.
    fn number(&self, logs: &[RemoteLog]) -> Option<u16> {
        let size = self.size.unwrap_or(u64::MAX);
        let same = logs.iter().rev().find(|log| log.size == size);
        let grown = || logs.last().filter(|log| log.size > size && !self.tail.is_empty());
        match same.or_else(grown)?.place {
            Place::Number(number) => Some(number),
            Place::Path(_) => None,
        }
    }

    fn listed(&mut self, now: Duration, logs: &[RemoteLog]) {
        let Some(number) = self.number(logs) else {
            let why = format!("none of the {} that they list is as long", logs.len());
            return self.back_to_ftp(now, OtherWay::None(why));
        };
        let compared = self.tail.clone();
        let begin = self.at - compared.len() as u64;
        let reading = LogReading::new(self.peer, number, begin, self.size.unwrap_or(0));
        self.gauge = Gauge::default();
        self.way = Way::Log(Box::new(reading), compared);
    }

    /// Notes how fast it goes, and keeps the faster way once both are known.
    fn judge(&mut self, now: Duration) {
        let left = self.size.map_or(0, |size| size.saturating_sub(self.at));
        if self.size.is_some() {
            self.gauge.note(now, self.at);
        }
        let Some(bytes_s) = self.gauge.bytes_s().filter(|_| !self.is_chosen) else { return };
        match (self.slow_bytes_s, &self.way) {
            (None, _) if seconds(left, bytes_s) > LONG_S => self.try_log(now, bytes_s),
            (None, _) => self.is_chosen = true,
            (Some(ftp_bytes_s), Way::Log(..)) if bytes_s > ftp_bytes_s => {
                self.choose(Protocol::Log, OtherWay::Brings(bytes_s));
            }
            (Some(_), Way::Log(..)) => self.back_to_ftp(now, OtherWay::Brings(bytes_s)),
            (Some(_), _) => {}
        }
    }

    /// All bytes are there by log messages.
    fn log_is_whole(&mut self, now: Duration) {
        self.gauge.end(now, self.at);
        if let Some(bytes_s) = self.gauge.bytes_s().filter(|_| !self.is_chosen) {
            self.choose(Protocol::Log, OtherWay::Brings(bytes_s));
        }
        self.way = Way::Sum(Box::new(FtpReading::sum_of(self.peer, &self.path, self.at)));
    }
}

impl Dialogue for Faster {
    fn poll(&mut self, now: Duration) -> Result<Option<MavMessage>, FetchError> {
        self.collect();
        if std::mem::take(&mut self.is_another) {
            let why = "their bytes are not those of the file".to_owned();
            self.back_to_ftp(now, OtherWay::None(why));
        }
        self.judge(now);
        if let Some(farewell) = self.farewell.take() {
            return Ok(Some(farewell));
        }
        match &mut self.way {
            Way::Ftp(reading) | Way::Sum(reading) => reading.poll(now),
            Way::List(list, _) if list.is_done() => {
                let logs = list.logs();
                self.listed(now, &logs);
                Ok(None)
            }
            Way::List(list, since) => match list.poll(now) {
                Ok(message) if now.saturating_sub(*since) < LIST => Ok(message),
                _ => {
                    let why = format!("no list of them within {} s", LIST.as_secs());
                    self.back_to_ftp(now, OtherWay::None(why));
                    Ok(None)
                }
            },
            Way::Log(reading, _) => match reading.poll(now) {
                Ok(message) => {
                    if reading.is_done() {
                        self.log_is_whole(now);
                    }
                    Ok(message)
                }
                Err(error) => {
                    self.back_to_ftp(now, OtherWay::None(error.to_string()));
                    Ok(None)
                }
            },
        }
    }

    fn take(&mut self, now: Duration, frame: &Frame<'_>) {
        match &mut self.way {
            Way::Ftp(reading) | Way::Sum(reading) => reading.take(now, frame),
            Way::List(list, _) => list.take(now, frame),
            Way::Log(reading, _) => reading.take(now, frame),
        }
    }

    fn is_done(&self) -> bool {
        matches!(&self.way, Way::Ftp(reading) | Way::Sum(reading) if reading.is_done())
    }
}
