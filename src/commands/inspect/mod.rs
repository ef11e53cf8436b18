//! `mavid inspect LOG`: what is in a log and what can be identified from it.

mod progress;
mod verb;

pub use verb::run;
