//! Logs that ArduPilot writes: binary (`.bin`) and, of old, text (`.log`). Both say themselves what their messages are made
//! of.

mod batches;
mod clock;
mod damage;
mod definition;
mod definitions;
mod format;
mod forms;
mod identity;
mod join;
mod jumps;
mod known;
mod letter;
mod message;
mod outlet;
mod reader;
mod routes;
mod special;
mod states;
mod tally;
mod text_reader;
mod topics;
mod units;
mod values;
mod walk;

pub use damage::DataflashDamage;
pub use definition::{Definition, Field};
pub use definitions::Definitions;
pub(super) use format::{BINARY, TEXT};
pub use letter::{ARRAY_VALUES, Letter};
pub use message::Message;
pub use reader::DataflashReader;
pub use text_reader::DataflashTextReader;
