//! `mavid log`: the logs that a vehicle keeps.

mod documents;
mod fetching;
mod flown;
mod prepare;
mod preparing;
mod session;
mod state;
mod verb;

pub use flown::{Fetching, after_flight, before_flight};
pub use verb::run;
