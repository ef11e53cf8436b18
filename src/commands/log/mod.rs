//! `mavid log`: the logs that a vehicle keeps.

mod before;
mod documents;
mod flown;
mod hint;
mod link;
mod logging_needs;
mod prepare;
mod restart;
mod several;
mod state;
mod verb;

pub use before::{before_flight, link_of, put_back};
pub use flown::{Fetching, after_flight, fetched_now};
pub use hint::link_options;
pub use link::{Answered, PATIENCE, open, parameters_of_vehicle};
pub use logging_needs::{LoggingNeeds, logging_needs};
pub use prepare::{agreed, all_put_back, put_back_page};
pub use several::{put_back_now, set_and_restart};
pub use state::notes_of_loaded;
pub use verb::run;
