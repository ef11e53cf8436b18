//! The flight as a state machine: messages and a clock in, messages out. It does no I/O.

mod action;
mod air;
mod checking;
mod command;
mod end;
mod event;
mod gate;
mod ground;
mod leave;
mod leaving;
mod listen;
mod phase;
mod stand;
mod start_gate;
mod state;
mod status;
mod step;
mod supervision;
mod watch;

pub use action::Action;
pub use event::{Event, Key};
pub use state::Flight;
pub use status::Status;
