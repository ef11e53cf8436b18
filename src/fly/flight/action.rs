//! Actions of a flight.

use mavlink::dialects::ardupilotmega::MavMessage;

use crate::fly::outcome::{Note, Outcome};

/// An action of the flight.
#[derive(Debug, Clone, PartialEq)]
pub enum Action {
    /// send it, in order
    Send(MavMessage),
    /// report it to the operator and to the log of events
    Note(Note),
    /// the flight is over
    Finished(Outcome),
}
