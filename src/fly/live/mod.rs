//! Identification during the flight: the paper's filtered model (38), built from the live stream by causal
//! filters, and recursive least squares (40).
//!
//! ```text
//! events -> choice of sources -> tracks -> common instants -> causal rows -> sums of (40) -> Theta +- std
//! ```
//!
//! Every signal passes the same low-pass one way, so that all are late by the same time and the regression stays
//! exact; memory does not grow with the flight. The offline methods see the whole flight at once and are better.

mod choice;
mod identification;
mod rows;
mod track;

pub use identification::{LiveEstimate, LiveIdentification, LiveParameter, LiveSettings};
