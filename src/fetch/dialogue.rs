//! A conversation with a vehicle, without I/O.

use std::time::Duration;

use mavlink::dialects::ardupilotmega::MavMessage;

use super::FetchError;
use crate::wire::Frame;

/// A conversation with a vehicle.
pub trait Dialogue {
    /// The next message that is due, if any; to be called until there is none, at least every few milliseconds.
    ///
    /// # Errors
    /// The vehicle refuses, contradicts itself, or does not answer any more.
    fn poll(&mut self, now: Duration) -> Result<Option<MavMessage>, FetchError>;

    /// Takes a frame from anybody.
    fn take(&mut self, now: Duration, frame: &Frame<'_>);

    /// Nothing more is to be said.
    fn is_done(&self) -> bool;
}
