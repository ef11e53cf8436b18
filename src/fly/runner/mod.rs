//! A flight over a real link: sockets, threads and the clock around [`Flight`](super::Flight).
//!
//! ```text
//! link -> frames -> Flight -> commands -> link -> recording
//!                    | guide
//!                    v
//!            thread of setpoints ------> link
//! ```
//!
//! The live identification hears what the flight hears, on a thread of its own. The checks before arming are computed on another one.

mod clearance;
mod clock;
mod drive;
mod error;
mod estimating;
mod event_layer;
mod feed;
mod files;
mod journal;
mod judging;
mod link_kind;
mod parking;
mod priority;
mod question;
mod ride;
mod stream;
mod supervisor;
mod termination;

pub use error::RunError;
pub use event_layer::{EVENTS_TARGET, event_layer};
pub use files::{EVENTS, PARAMETERS, TLOG};
pub use parking::{Parking, Part};
pub use priority::raise_priority;
pub use ride::{Console, Record, Ride, run};
pub use stream::{Due, StreamFigures, send_due};
pub use supervisor::Supervisor;
#[cfg(unix)]
pub use termination::HangUp;
