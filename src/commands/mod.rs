//! One file a verb: loads, calls the library, prints. Nothing else of the program prints.
//!
//! To add a verb: a variant in [`Verb`](crate::cli::Verb), a file here with `run(json, args)`, and an arm in [`run`].

mod after_flight;
mod demo;
mod dispatch;
mod error;
mod explain;
mod export;
mod fly;
mod identify;
mod inspect;
mod leftover;
mod live;
mod network;
mod outcome;
mod output;
mod plan;
mod progress;
mod prove;
mod record;
mod replay;
mod simulate;
mod sitl;
mod teller;
mod usage;
mod validate;
mod vehicle;

pub use dispatch::run;
pub use error::CommandError;
pub use outcome::Outcome;
pub use usage::usage;
