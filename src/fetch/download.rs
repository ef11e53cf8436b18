//! The download of one log.

use std::time::Duration;

use mavlink::dialects::ardupilotmega::MavMessage;

use super::chosen::Chosen;
use super::faster::Faster;
use super::fetched::Fetched;
use super::ftp_reading::FtpReading;
use super::gauge::Gauge;
use super::log_reading::LogReading;
use super::peer::Peer;
use super::remote::{MOST_BYTES, Place, Protocol, RemoteLog};
use super::{Dialogue, FetchError};
use crate::wire::{Frame, Vehicle};

#[derive(Debug)]
enum Way {
    Ftp(Box<FtpReading>),
    Log(Box<LogReading>),
    Faster(Box<Faster>),
}

/// The download of one log, piece by piece.
#[derive(Debug)]
pub struct Download {
    way: Way,
    gauge: Gauge,
}

impl Download {
    /// Of this log of this vehicle, of which the first `begin` bytes are there already, by the protocol that listed it.
    ///
    /// # Errors
    /// The vehicle cannot be named, or states a length that no log has.
    pub fn new(vehicle: Vehicle, log: &RemoteLog, begin: u64) -> Result<Self, FetchError> {
        Self::of(vehicle, log, |peer| match &log.place {
            Place::Path(path) => Way::Ftp(Box::new(FtpReading::new(peer, path, begin))),
            Place::Number(id) => Way::Log(Box::new(LogReading::new(peer, *id, begin, log.size))),
        })
    }

    /// The same. A file that takes long by file transfer goes on by log messages where these are faster.
    ///
    /// # Errors
    /// The vehicle cannot be named, or states a length that no log has.
    pub fn by_the_faster(vehicle: Vehicle, log: &RemoteLog, begin: u64) -> Result<Self, FetchError> {
        match &log.place {
            Place::Path(path) => {
                Self::of(vehicle, log, |peer| Way::Faster(Box::new(Faster::new(peer, path, begin))))
            }
            Place::Number(_) => Self::new(vehicle, log, begin),
        }
    }

    fn of(vehicle: Vehicle, log: &RemoteLog, way: impl FnOnce(Peer) -> Way) -> Result<Self, FetchError> {
        let peer = Peer::of(vehicle)?;
        if log.size > MOST_BYTES {
            return Err(FetchError::TooLong { stated: log.size });
        }
        Ok(Self { way: way(peer), gauge: Gauge::default() })
    }

    /// The bytes that go on where those before ended.
    pub fn ready(&mut self) -> Vec<u8> {
        match &mut self.way {
            Way::Ftp(reading) => reading.window().map(super::window::Window::ready).unwrap_or_default(),
            Way::Log(reading) => reading.window().ready(),
            Way::Faster(reading) => reading.ready(),
        }
    }

    /// Bytes of the log, once they are known.
    pub fn size(&mut self) -> Option<u64> {
        match &mut self.way {
            Way::Ftp(reading) => reading.window().map(|window| window.size()),
            Way::Log(reading) => Some(reading.window().size()),
            Way::Faster(reading) => reading.size(),
        }
    }

    /// What is known of it, once it is there.
    #[must_use]
    pub fn fetched(&self) -> Option<Fetched> {
        match &self.way {
            Way::Ftp(reading) => reading.fetched(),
            Way::Log(reading) => reading.fetched(),
            Way::Faster(reading) => reading.fetched(),
        }
    }

    /// Bytes a second of the way that stays, once they were measured.
    #[must_use]
    pub fn bytes_s(&self) -> Option<f64> {
        match &self.way {
            Way::Ftp(_) | Way::Log(_) => self.gauge.bytes_s(),
            Way::Faster(reading) => reading.bytes_s(),
        }
    }

    /// The protocol by which it goes.
    #[must_use]
    pub fn protocol(&self) -> Protocol {
        match &self.way {
            Way::Ftp(_) => Protocol::Ftp,
            Way::Log(_) => Protocol::Log,
            Way::Faster(reading) => reading.protocol(),
        }
    }

    /// Which way stays and why, once it is settled, where there was a choice.
    pub fn chosen(&mut self) -> Option<Chosen> {
        match &mut self.way {
            Way::Ftp(_) | Way::Log(_) => None,
            Way::Faster(reading) => reading.chosen(),
        }
    }

    /// Bytes without a gap, of a log that goes one way.
    fn begin(&mut self) -> Option<u64> {
        match &mut self.way {
            Way::Ftp(reading) => reading.window().map(|window| window.begin()),
            Way::Log(reading) => Some(reading.window().begin()),
            Way::Faster(_) => None,
        }
    }

    /// To be sent where the download is given up: the vehicle stops sending.
    pub fn farewell(&mut self, now: Duration) -> MavMessage {
        match &mut self.way {
            Way::Ftp(reading) => reading.farewell(now),
            Way::Log(reading) => reading.farewell(),
            Way::Faster(reading) => reading.farewell(now),
        }
    }
}

impl Dialogue for Download {
    fn poll(&mut self, now: Duration) -> Result<Option<MavMessage>, FetchError> {
        if let Some(begin) = self.begin() {
            self.gauge.note(now, begin);
        }
        match &mut self.way {
            Way::Ftp(reading) => reading.poll(now),
            Way::Log(reading) => reading.poll(now),
            Way::Faster(reading) => reading.poll(now),
        }
    }

    fn take(&mut self, now: Duration, frame: &Frame<'_>) {
        match &mut self.way {
            Way::Ftp(reading) => reading.take(now, frame),
            Way::Log(reading) => reading.take(now, frame),
            Way::Faster(reading) => reading.take(now, frame),
        }
    }

    fn is_done(&self) -> bool {
        match &self.way {
            Way::Ftp(reading) => reading.is_done(),
            Way::Log(reading) => reading.is_done(),
            Way::Faster(reading) => reading.is_done(),
        }
    }
}
