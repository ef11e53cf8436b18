//! `mavid run`: from a vehicle to what its model lacks. Each step is a command that exists, and is said as it is typed.
//!
//! ```text
//! target       the vehicle: at an address, or embedded
//! taken_up     what an earlier run left unfinished
//! same_vehicle what is given does not contradict the folder
//! vehicle      its file, from its parameters and what a person knows
//! room         limits that a person confirms
//! planned      the trajectory of each flight
//! follows      the same within what the autopilot follows
//! rehearsal    the same flight on the embedded twin
//! flying       the flight
//! explained    what all flights say together, and whether a further one would bring more
//! finish       the appendix, and the model for simulators
//! page         the answer
//! ```
//!
//! What was done is told by the files in the folder: a run is taken up where it was left.

mod again;
mod altitude;
mod ask;
mod concealed;
mod context;
mod embedded;
mod explained;
mod finish;
mod flying;
mod folder;
mod follows;
mod logging;
mod page;
mod phases;
mod planned;
mod progress;
mod rehearsal;
mod room;
mod same_vehicle;
mod step;
mod taken_up;
mod target;
mod vehicle;
mod verb;

pub use concealed::{CONCEALED, kept};
pub use context::Recipe;
pub use folder::{COMMANDS, Folder};
pub use verb::{run, story};
