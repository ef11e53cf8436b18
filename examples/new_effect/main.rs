//! An effect that the library does not know: one file for its equation, one for its signature, and two lines here.
//! A flight with it is simulated, and `explain` finds it: `cargo run --release --example new_effect`.
//!
//! Inside of the library the two files stand in `src/physics/effects` and `src/diagnose/signatures`, each declared there with
//! `mod`, and the two lines in the lists of these folders: `CONTRIBUTING.md`.

#![allow(clippy::print_stdout, reason = "an example prints its result")]

mod effect;
mod signature;

use std::error::Error;
use std::fmt::Write;

use mavid::diagnose::signature::Signature;
use mavid::diagnose::signatures::ALL;
use mavid::diagnose::{ExplainSettings, clause, explain};
use mavid::physics::ActiveEffect;
use mavid::signals::{ConditionSettings, condition};
use mavid::simulate::{FlightSettings, RandomTrajectory, Reference, Truth, random_vehicle, simulate_flight};

/// N/(m/s), concealed in the flight.
const CONCEALED: f64 = 0.25;

fn main() -> Result<(), Box<dyn Error>> {
    print!("{}", found()?);
    Ok(())
}

/// The verdict on a flight with the effect, its name and its size.
///
/// # Errors
/// The flight cannot be flown or explained, or the effect is not found in it.
pub fn found() -> Result<String, Box<dyn Error>> {
    let pair = random_vehicle(11);
    let mut truth = Truth::clean(pair.truth);
    truth.effects.push(ActiveEffect::new(&effect::SideForce, &[CONCEALED])?);
    let trajectory = RandomTrajectory::default().draw(12)?;
    let reference = Reference { trajectory, hover_s: 4.0, ramp_s: 2.0 };
    let flight = simulate_flight(truth, &pair.nominal, &reference, &FlightSettings::default())?;

    let signals = condition(&flight.recording, &pair.nominal, &ConditionSettings::default())?;
    let signatures: Vec<&'static Signature> = ALL.iter().copied().chain([&signature::SIGNATURE]).collect();
    let settings = ExplainSettings { signatures: signatures.leak(), ..ExplainSettings::default() };
    let explanation = explain(&[signals], &pair.nominal, &settings)?;

    let mut text = format!("{}\n", explanation.verdict.name());
    for named in &explanation.named {
        writeln!(text, "{}: {}.", named.id, clause(named, &pair.nominal))?;
    }
    let found = explanation.named.iter().find(|named| named.id == signature::SIGNATURE.id());
    let found = found.ok_or("the side force was not found")?;
    let (value, std) = found.get("k").map(|k| (k.value, k.std)).ok_or("it has no size")?;
    writeln!(text, "concealed {CONCEALED} N/(m/s), found {value:.3} +- {std:.3}")?;
    Ok(text)
}
