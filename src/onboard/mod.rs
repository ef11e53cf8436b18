//! A vehicle on a link while it does not fly: its logs are listed and fetched, the parameters of its logging are read, set
//! and put back.
//!
//! The dialogues themselves are those of [`crate::fetch`], which do no I/O; here they are held over a link. Nothing that
//! moves a vehicle is sent, and no log on it is erased. An autopilot is restarted only by [`order_restart`].
//!
//! ```text
//! Session::open -> offer -> list -> fetch        the logs
//!                        -> look -> change       the parameters of logging
//!                        -> compare -> load      the parameters of a file (is_simulator: of a simulator's)
//!                        -> order_restart        for what counts only then
//!                        -> put_back             what an earlier run changed of either
//! ```

mod download;
mod error;
mod loading;
mod logging;
mod parameter_file;
mod parameters;
mod restart;
mod session;
mod setting;

pub use download::{Download, Listed, Progress, begun, fetch, list};
pub use error::OnboardError;
pub use loading::{Loaded, Loading, ParameterComparison, compare, is_simulator, load};
pub use logging::{ChangedSince, LoggingState, PutBack, change, look, needs_restart, put_back};
pub use parameter_file::{ParameterFileError, read_parameter_file};
pub use parameters::read_as_needed;
pub use restart::order_restart;
pub use session::{Flow, Interrupt, Session, SessionRequest};
