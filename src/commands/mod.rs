//! One file a verb: loads, calls the library, prints. Nothing else of the program prints.
//!
//! To add a verb: a variant in [`Verb`](crate::cli::Verb), a file here with `run(json, args)`, and an arm in [`run`]. A verb
//! that draws on standard error takes the handle of it as well.

mod after_flight;
mod agreement;
mod columns;
mod compare;
mod convert;
mod csv_map;
mod demo;
mod dispatch;
mod effects;
mod error;
mod error_document;
mod explain;
mod export;
mod fleet;
mod fly;
mod identify;
mod inspect;
mod installed;
mod last_word;
mod leftover;
mod live;
mod load;
mod log;
mod network;
mod outcome;
mod output;
mod plan;
mod progress;
mod prove;
mod read_once;
mod record;
mod redact;
mod replay;
mod report;
mod run;
mod said;
mod simulate;
mod sitl;
mod standard_error;
mod typed_early;
mod usage;
mod validate;
mod vehicle;
mod words;

pub use dispatch::run;
pub use error::CommandError;
pub use error_document::failed;
pub use outcome::{NOT_ALL, Outcome};
pub use standard_error::install;
pub use usage::usage;
