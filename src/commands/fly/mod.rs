//! `mavid fly --connect ADDRESS --trajectory T --vehicle V --out DIR`: flies, records, identifies. `--mass KG` in place of
//! `--vehicle` drafts the vehicle from its own parameters.

mod busy;
mod document;
mod landed;
mod one_flight;
mod ride;
mod typed;
mod vehicle;
mod verb;
mod watch;
mod words;

pub use busy::busy;
pub use landed::Landed;
pub use one_flight::{FlightRun, LOG, Manner, one_flight};
pub use ride::{TRACKING_MOST_M, is_attended, within};
pub use verb::{outcome, run};
pub use words::lines;
