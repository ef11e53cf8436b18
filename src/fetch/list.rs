//! The logs that a vehicle has.

use std::time::Duration;

use mavlink::dialects::ardupilotmega::MavMessage;

use super::ftp_list::FtpList;
use super::log_list::LogList;
use super::peer::Peer;
use super::remote::{LogSelection, Protocol, RemoteLog};
use super::{Dialogue, FetchError};
use crate::wire::{Frame, Vehicle};

#[derive(Debug)]
enum Way {
    Ftp(Box<FtpList>),
    Log(LogList),
}

/// Lists the logs that a vehicle has.
#[derive(Debug)]
pub struct List(Way);

impl List {
    /// Of this vehicle.
    ///
    /// # Errors
    /// No message can name it.
    pub fn new(vehicle: Vehicle, protocol: Protocol, selection: LogSelection) -> Result<Self, FetchError> {
        let peer = Peer::of(vehicle)?;
        Ok(Self(match protocol {
            Protocol::Ftp => Way::Ftp(Box::new(FtpList::new(peer, vehicle.autopilot, selection))),
            Protocol::Log => Way::Log(LogList::new(peer)),
        }))
    }

    /// The logs that came, oldest first.
    #[must_use]
    pub fn logs(&self) -> Vec<RemoteLog> {
        match &self.0 {
            Way::Ftp(list) => list.logs(),
            Way::Log(list) => list.logs(),
        }
    }

    /// Entries whose names cannot be those of files, and are left out.
    #[must_use]
    pub fn left_out(&self) -> usize {
        match &self.0 {
            Way::Ftp(list) => list.left_out,
            Way::Log(_) => 0,
        }
    }
}

impl Dialogue for List {
    fn poll(&mut self, now: Duration) -> Result<Option<MavMessage>, FetchError> {
        match &mut self.0 {
            Way::Ftp(list) => list.poll(now),
            Way::Log(list) => list.poll(now),
        }
    }

    fn take(&mut self, now: Duration, frame: &Frame<'_>) {
        match &mut self.0 {
            Way::Ftp(list) => list.take(now, frame),
            Way::Log(list) => list.take(now, frame),
        }
    }

    fn is_done(&self) -> bool {
        match &self.0 {
            Way::Ftp(list) => list.is_done(),
            Way::Log(list) => list.is_done(),
        }
    }
}
