//! The ground station's side of an identification flight.
//!
//! [`Flight`] is the whole flight as a state machine without I/O: frames, keys and the clock go in, messages,
//! notes and the outcome come out. [`Streamer`] makes the setpoints from the [`Guide`] that the flight renews
//! with every step, and stops by itself where the flight does not. Times are [`std::time::Duration`]s of the
//! host's clock since any fixed start; it continues while the computer sleeps.
//!
//! ```text
//! frames, keys, clock -> Flight -> commands, notes, outcome
//!                          | Guide
//!                          v
//!                 clock -> Streamer -> setpoints
//! ```

mod address;
mod arming;
mod commander;
mod course;
pub mod finding;
mod flight;
mod ground;
mod health;
mod law;
mod lift;
pub mod live;
mod news;
mod order;
mod outcome;
pub mod parameters;
pub mod preflight;
pub mod requests;
mod reset;
mod roster;
mod runner;
mod safety;
mod setpoint;
mod sortie;
mod state;
mod target;
mod telemetry;
pub mod view;

pub use commander::{Answer, AnswerResult, Manner, Permission};
pub use course::{Around, Course, PathClock, PathTime, Track, approach, reference_at, transfer};
pub use flight::{Action, Event, Flight, Key, Status};
pub use health::{BatteryLevel, EstimatorReport, SystemReport};
pub use law::{FollowLaw, Motion};
pub use lift::{Lift, Weighed};
pub use outcome::{Cause, Ending, FlightStatistics, Level, Note, Outcome, Response};
pub use roster::{Choice, Listed, Roster};
#[cfg(unix)]
pub use runner::HangUp;
pub use runner::{
    Console, Due, EVENTS, EVENTS_TARGET, PARAMETERS, Parking, Part, Record, Ride, RunError, StreamFigures,
    Supervisor, TLOG, event_layer, raise_priority, run, send_due,
};
pub use safety::{Feeding, FirstQuestion, Guide, Lead, SetpointBounds, Streamed, Streamer};
pub use setpoint::{Place, Setpoint};
pub use sortie::{Check, Origin, SETPOINT_HZ, Settings, Sortie};
pub use target::{MessageId, Order, OutOfRange, ParameterName, Period, TakeoffHeight, Target, heartbeat};
