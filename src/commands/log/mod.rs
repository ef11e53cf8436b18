//! `mavid log`: the logs that a vehicle keeps.

mod before;
mod described;
mod documents;
mod fetching;
mod flown;
mod prepare;
mod preparing;
mod session;
mod state;
mod verb;

pub use before::{before_flight, put_back};
pub use described::drafted;
pub use flown::{Fetching, after_flight};
pub use verb::run;
