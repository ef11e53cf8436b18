//! Inputs of a flight.

use std::time::Duration;

use crate::autopilot::Mode;
use crate::fly::lift::Lift;
use crate::fly::safety::Feeding;
use crate::wire::Frame;

/// An input of the flight.
#[derive(Debug, Clone, PartialEq)]
pub enum Event<'a> {
    /// a frame from the link
    Frame(Frame<'a>),
    /// a step of time; expected every 10 ms
    Tick,
    /// the operator
    Key(Key),
    /// result of the checks of parameters, message rates and limits: whether the flight may continue, and how its
    /// outputs become thrust
    Cleared(Result<Box<Lift>, String>),
    /// how setpoints are made from the reference, so that the vehicle is safe if they end
    Feed(Feeding),
    /// the program is to end, with the cause
    Stop(String),
    /// the stream of setpoints, or this flight, stalled for this time, and the stream has ended
    Stalled(Duration),
    /// the link is lost (`false`) or connected again
    Link(bool),
    /// the link's own task has ended: nothing more will be received
    LinkEnded,
}

/// Orders of the operator.
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
