//! Flights on which things go wrong by lot, and the laws that hold all the same. See `benches/faults.rs` for more of them.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test ends where it fails")]

mod caught;
mod harness;

use harness::fly;
use rayon::prelude::*;

const SEED: u64 = 1;
const FLIGHTS: u64 = 300;

#[test]
fn no_law_is_broken_on_three_hundred_flights() {
    let reports: Vec<_> = (0..FLIGHTS).into_par_iter().map(|number| fly(SEED, number, false)).collect();
    let broken: Vec<String> =
        reports.iter().filter(|report| !report.broken.is_empty()).map(|report| report.text(SEED)).collect();
    let attacked = reports.iter().filter(|report| report.attacked).count();
    assert!(broken.is_empty(), "{} flights broke a law:\n{}", broken.len(), broken.join("\n"));
    assert!(attacked > 250, "only {attacked} flights came to their faults");
}
