//! `mavid fly --connect ADDRESS --trajectory T --vehicle V --out DIR`: flies, records, identifies. `--mass KG` in place of
//! `--vehicle` drafts the vehicle from its own parameters.

mod document;
mod flown;
mod ride;
mod typed;
mod vehicle;
mod verb;
mod watch;
mod words;

pub use flown::{Flown, Manner, flown};
pub use ride::is_attended;
pub use verb::{outcome, run};
