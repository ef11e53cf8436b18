//! One log for a service that looks at every log it gets: bytes in, findings out.
//!
//! No file is read or written, no thread is begun, and the work is bounded by numbers of samples: the same bytes give the same findings
//! on every computer. What was not done within the bounds is told beside the findings.

mod balance;
mod effects;
mod finding;
mod run;
mod settings;

pub use finding::{Amount, Finding, Gravity, Screening, Where};
pub use run::screen;
pub use settings::{Bounds, ScreenSettings};
