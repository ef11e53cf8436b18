//! Reads a log and identifies mass and inertia: `cargo run --release --example identify`.

#![allow(clippy::print_stdout, reason = "an example prints its result")]

use std::error::Error;
use std::fmt::Write;
use std::path::Path;

use mavid::config::load_vehicle;
use mavid::estimate::{Finding, IdentifySettings, identify};
use mavid::log::{self, OpenOptions};
use mavid::signals::{ConditionSettings, condition};

fn main() -> Result<(), Box<dyn Error>> {
    print!("{}", table()?);
    Ok(())
}

/// One line a parameter: value and standard error, or why there is none.
pub fn table() -> Result<String, Box<dyn Error>> {
    let fixtures = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures");
    let log = log::open(&fixtures.join("p01_identify_0_25s.tlog"), &OpenOptions::default())?;
    let vehicle = load_vehicle(&fixtures.join("p01_vehicle.toml"))?;

    // streams on one clock and one grid
    let signals = condition(&log.recording, &vehicle, &ConditionSettings::default())?;
    let identification = identify(&[signals], &vehicle, &IdentifySettings::default())?;

    let mut table = String::new();
    for parameter in &identification.best.result.parameters {
        let (name, unit) = (parameter.name, parameter.unit);
        match &parameter.finding {
            Finding::Determined { value, std } => writeln!(table, "{name} = {value:.5} +- {std:.5} {unit}")?,
            Finding::Given { value } => {
                writeln!(table, "{name} = {value:.5} {unit}, as the vehicle file states")?
            }
            other => writeln!(table, "{name}: {other:?}")?,
        }
    }
    Ok(table)
}
