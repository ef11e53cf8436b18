//! A message that waits to be sent.

use std::time::Duration;

use mavlink::dialects::ardupilotmega::MavMessage;
use tokio::time::Instant;

/// A message that waited for longer is not sent: what it asks for was asked of a vehicle whose mode was known then. Who
/// wants it still gives it again.
const OLD: Duration = Duration::from_millis(100);

/// A message that was given to be sent, and when.
#[derive(Debug)]
pub(super) struct Given {
    pub message: Box<MavMessage>,
    at: Instant,
}

impl Given {
    /// Given now.
    pub fn now(message: &MavMessage) -> Self {
        Self { message: Box::new(message.clone()), at: Instant::now() }
    }

    /// It has waited for too long.
    pub fn is_old(&self) -> bool {
        self.at.elapsed() > OLD
    }
}
