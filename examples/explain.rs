//! Explains a log and prints the effects that the model lacks: `cargo run --release --example explain`.

#![allow(clippy::print_stdout, reason = "an example prints its result")]

use std::error::Error;
use std::fmt::Write;
use std::path::Path;

use mavid::config::load_vehicle;
use mavid::diagnose::{ExplainSettings, clause, explain};
use mavid::log::{self, OpenOptions};
use mavid::signals::{ConditionSettings, condition};

fn main() -> Result<(), Box<dyn Error>> {
    print!("{}", effects()?);
    Ok(())
}

/// The verdict, and one sentence an effect.
pub fn effects() -> Result<String, Box<dyn Error>> {
    let fixtures = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures");
    let log = log::open(&fixtures.join("p04_identify_10_22s.tlog"), &OpenOptions::default())?;
    let vehicle = load_vehicle(&fixtures.join("p04_vehicle.toml"))?;
    let signals = condition(&log.recording, &vehicle, &ConditionSettings::default())?;

    let explanation = explain(&[signals], &vehicle, &ExplainSettings::default())?;

    let mut text = format!("{}\n", explanation.verdict.name());
    for named in &explanation.named {
        writeln!(text, "{}: {}.", named.id, clause(named, &vehicle))?;
        for other in &named.confusable_with {
            writeln!(text, "  confusable with {}", other.id)?;
        }
    }
    Ok(text)
}
