//! What a flight wants done.

use mavlink::dialects::ardupilotmega::MavMessage;

use crate::fly::outcome::{Note, Outcome};

/// What the flight wants done.
#[derive(Debug, Clone, PartialEq)]
pub enum Action {
    /// send it, in order
    Send(MavMessage),
    /// tell people and the log of events
    Note(Note),
    /// the flight is over
    Finished(Outcome),
}
