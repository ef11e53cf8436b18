//! What a flight hears.

use std::time::Duration;

use crate::autopilot::Mode;
use crate::fly::lift::Lift;
use crate::fly::safety::Feeding;
use crate::wire::Frame;

/// What the flight hears.
#[derive(Debug, Clone, PartialEq)]
pub enum Event<'a> {
    /// a frame from the link
    Frame(Frame<'a>),
    /// time went on; wanted every 10 ms
    Tick,
    /// the operator
    Key(Key),
    /// parameters, message rates and limits are checked: whether the flight may go on, and how its outputs lift it
    Cleared(Result<Box<Lift>, String>),
    /// how setpoints are made from the reference, by what the vehicle does when they end
    Feed(Feeding),
    /// the program is told to end, by what
    Stop(String),
    /// the stream of setpoints stood still for so long, or this flight did, and it has ended
    Stalled(Duration),
    /// the link is lost (`false`) or there again
    Link(bool),
    /// the link's own task has ended: nothing will be heard any more
    LinkEnded,
}

/// What the operator wants.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Key {
    /// once: hold; twice: land; three times: return
    Abort,
    /// to hold, land or return, whatever was before
    To(Mode),
    /// motors off now, wherever the vehicle is; only after a typed word
    Kill,
    /// the word for arming, where it is waited for
    Arm,
}
