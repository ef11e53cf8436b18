//! An analyzer of a flight review service that screens each log with mavid: `cargo run --release --example flight_review -- LOG [KG]`.
//!
//! `service.rs` has the shape of the service and passes a log's messages on; `analyzer.rs` is all that the service adds. It hands the
//! messages of its topics to [`mavid::screen::screen`] as bytes. A service that has the bytes of the whole log hands over those.

#![allow(clippy::print_stdout, reason = "an example prints its result")]

mod analyzer;
pub(crate) mod service;

use analyzer::Multirotor;
use service::{Analyzer, Diagnostic, Metadata};
use std::error::Error;
use std::time::Instant;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let path =
        arguments.next().ok_or("expected a log of PX4 (.ulg), and optionally the vehicle's mass in kg")?;
    let mass_kg = arguments.next().map(|mass| mass.parse()).transpose()?;
    let log = std::fs::read(&path)?;
    let begun = Instant::now();
    let found = diagnostics(&log, mass_kg);
    println!("{} bytes, {:.0} ms", log.len(), 1e3 * begun.elapsed().as_secs_f64());
    for Diagnostic { id, summary, severity, timestamp_us, .. } in found {
        println!("{severity:?} {id} at {:.1} s: {summary}", timestamp_us as f64 / 1e6);
    }
    Ok(())
}

/// What the service shows of a log.
pub fn diagnostics(log: &[u8], mass_kg: Option<f64>) -> Vec<Diagnostic> {
    let all = |metadata: &Metadata| -> Vec<Box<dyn Analyzer>> {
        vec![Box::new(Multirotor::new(metadata, mass_kg))]
    };
    service::analyze(log, all)
}
