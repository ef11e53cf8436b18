//! `mavid log`: the logs that a vehicle keeps.

mod before;
mod documents;
mod flown;
mod hint;
mod link;
mod prepare;
mod state;
mod verb;
mod wanted;

pub use before::{before_flight, link_of, put_back};
pub use flown::{Fetching, after_flight};
pub use link::{Answered, parameters_of_vehicle};
pub use verb::run;
pub use wanted::wanted;
