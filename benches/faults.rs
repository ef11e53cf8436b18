//! Flights on which things go wrong by lot: each law that one breaks is told, with what led to it.
//!
//! `cargo bench --bench faults -- [--flights N] [--seed S] [--first N] [--trace]`. `--first N --flights 1 --trace` flies one
//! of them again and tells all of it. Exit status 1 where a law was broken.

#![allow(clippy::print_stdout, clippy::unwrap_used, reason = "a benchmark prints and ends where it fails")]

#[path = "../tests/faults/harness/mod.rs"]
mod harness;
mod support;

use std::collections::BTreeMap;
use std::process::ExitCode;
use std::time::Instant;

use harness::laws::Law;
use rayon::prelude::*;
use support::Arguments;

/// Flights between two words of how far it is.
const BATCH: u64 = 500;

fn main() -> ExitCode {
    let arguments = Arguments::of_process();
    let (seed, first) = (arguments.number("--seed", 1), arguments.number("--first", 0));
    let (flights, whole) = (arguments.number("--flights", 1000), arguments.has("--trace"));
    let start = Instant::now();
    let mut laws: BTreeMap<Law, (u64, Vec<u64>)> = BTreeMap::new();
    let (mut bad, mut attacked, mut frames, mut flown_s) = (0_u64, 0_u64, 0_usize, 0.0);
    let mut from = first;
    while from < first + flights {
        let to = (from + BATCH).min(first + flights);
        let reports: Vec<_> =
            (from..to).into_par_iter().map(|number| harness::fly(seed, number, whole)).collect();
        for report in reports {
            attacked += u64::from(report.attacked);
            frames += report.frames;
            flown_s += report.lasted.as_secs_f64();
            if !report.broken.is_empty() {
                bad += 1;
            }
            if whole || !report.broken.is_empty() {
                println!("{}\n", report.text(seed));
            }
            for broken in &report.broken {
                let (count, numbers) = laws.entry(broken.law).or_default();
                *count += 1;
                numbers.push(report.number);
            }
        }
        from = to;
        println!("{from} flights, {bad} broke a law, {:.0} s", start.elapsed().as_secs_f64());
    }
    for (law, (count, numbers)) in &laws {
        println!("{law:?}: {count}, flights {:?}", &numbers[..numbers.len().min(20)]);
    }
    println!(
        "{bad} of {flights} flights broke a law (seed {seed}); {attacked} came to their faults, {frames} vehicle frames, \
         {:.1} h of flight in {:.0} s",
        flown_s / 3600.0,
        start.elapsed().as_secs_f64()
    );
    if bad == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
