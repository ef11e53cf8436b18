//! `mavid fly --connect ADDRESS --trajectory T --vehicle V --out DIR`: flies, records, identifies.

mod document;
mod ride;
mod typed;
mod verb;
mod watch;
mod words;

pub use document::Document;
pub use ride::ride;
pub use verb::{outcome, run};
pub use watch::fly_it;
pub use words::words;
