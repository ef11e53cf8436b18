//! `mavid demo`: a run with a simulated vehicle about which something is wrong. It says what, without having been told.

mod verb;

pub use verb::run;
