//! `mavid log`: the logs that a vehicle keeps.

mod before;
mod documents;
mod fetching;
mod flown;
mod hint;
mod parameters;
mod prepare;
mod preparing;
mod session;
mod state;
mod verb;

pub use before::{before_flight, link_of, put_back};
pub use flown::{Fetching, after_flight};
pub use parameters::of_vehicle as parameters_of_vehicle;
pub use verb::run;
