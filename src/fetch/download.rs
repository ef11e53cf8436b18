//! The download of one log.

use std::time::Duration;

use mavlink::dialects::ardupilotmega::MavMessage;

use super::fetched::Fetched;
use super::ftp_reading::FtpReading;
use super::log_reading::LogReading;
use super::peer::Peer;
use super::remote::{MOST_BYTES, Place, RemoteLog};
use super::{Dialogue, FetchError};
use crate::wire::{Frame, Vehicle};

#[derive(Debug)]
enum Way {
    Ftp(Box<FtpReading>),
    Log(Box<LogReading>),
}

/// The download of one log, piece by piece.
#[derive(Debug)]
pub struct Download(Way);

impl Download {
    /// Of this log of this vehicle, of which the first `begin` bytes are there already.
    ///
    /// # Errors
    /// The vehicle cannot be named, or states a length that no log has.
    pub fn new(vehicle: Vehicle, log: &RemoteLog, begin: u64) -> Result<Self, FetchError> {
        let peer = Peer::of(vehicle)?;
        if log.size > MOST_BYTES {
            return Err(FetchError::TooLong { stated: log.size });
        }
        Ok(Self(match &log.place {
            Place::Path(path) => Way::Ftp(Box::new(FtpReading::new(peer, path, begin))),
            Place::Number(id) => Way::Log(Box::new(LogReading::new(peer, *id, begin, log.size))),
        }))
    }

    /// The bytes that go on where those before ended.
    pub fn ready(&mut self) -> Vec<u8> {
        match &mut self.0 {
            Way::Ftp(reading) => reading.window().map(super::window::Window::ready).unwrap_or_default(),
            Way::Log(reading) => reading.window().ready(),
        }
    }

    /// Bytes of the log, once they are known.
    pub fn size(&mut self) -> Option<u64> {
        match &mut self.0 {
            Way::Ftp(reading) => reading.window().map(|window| window.size()),
            Way::Log(reading) => Some(reading.window().size()),
        }
    }

    /// What is known of it, once it is there.
    #[must_use]
    pub fn fetched(&self) -> Option<Fetched> {
        match &self.0 {
            Way::Ftp(reading) => reading.fetched(),
            Way::Log(reading) => reading.fetched(),
        }
    }

    /// To be sent where the download is given up: the vehicle stops sending.
    pub fn farewell(&mut self, now: Duration) -> MavMessage {
        match &mut self.0 {
            Way::Ftp(reading) => reading.farewell(now),
            Way::Log(reading) => reading.farewell(),
        }
    }
}

impl Dialogue for Download {
    fn poll(&mut self, now: Duration) -> Result<Option<MavMessage>, FetchError> {
        match &mut self.0 {
            Way::Ftp(reading) => reading.poll(now),
            Way::Log(reading) => reading.poll(now),
        }
    }

    fn take(&mut self, now: Duration, frame: &Frame<'_>) {
        match &mut self.0 {
            Way::Ftp(reading) => reading.take(now, frame),
            Way::Log(reading) => reading.take(now, frame),
        }
    }

    fn is_done(&self) -> bool {
        match &self.0 {
            Way::Ftp(reading) => reading.is_done(),
            Way::Log(reading) => reading.is_done(),
        }
    }
}
