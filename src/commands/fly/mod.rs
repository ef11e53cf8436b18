//! `mavid fly --connect ADDRESS --trajectory T --vehicle V --out DIR`: flies, records, identifies. `--mass KG` in place of
//! `--vehicle` drafts the vehicle from its own parameters.

mod document;
mod ride;
mod typed;
mod vehicle;
mod verb;
mod watch;
mod words;

pub use document::Document;
pub use ride::ride;
pub use verb::{outcome, run};
pub use watch::fly_it;
pub use words::words;
