//! `mavid log`: the logs that a vehicle keeps.

mod documents;
mod fetching;
mod session;
mod verb;

pub use verb::run;
