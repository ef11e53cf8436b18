//! `mavid effects [ID]`: what the program knows of the effects that it can name.

use mavid::config::{parse_vehicle, read_vehicle};
use mavid::report::{effect_text, effects_text};
use mavid::study::{KnownEffect, known_effects};
use serde::Serialize;

use super::sitl::{DEFAULT_VEHICLE, EMBEDDED};
use super::{CommandError, Outcome, output};
use crate::cli::EffectsArgs;

#[derive(Debug, Serialize)]
struct Document {
    schema: u32,
    effects: Vec<KnownEffect>,
}

/// Runs the verb.
pub fn run(json: bool, args: &EffectsArgs) -> Result<Outcome, CommandError> {
    let loaded = match &args.vehicle {
        Some(file) => read_vehicle(file)?,
        None => parse_vehicle(DEFAULT_VEHICLE, EMBEDDED)?,
    };
    let effects = known_effects(args.id.as_deref(), &loaded.vehicle)?;
    if json {
        output::json(&Document { schema: 1, effects })?;
    } else if args.table {
        let tables: Vec<&str> = effects.iter().map(|effect| effect.table.trim_end()).collect();
        output::file_text(&tables.join("\n\n"))?;
    } else if args.id.is_some() {
        output::text(&effects.iter().map(effect_text).collect::<Vec<_>>().join("\n\n"))?;
    } else {
        output::text(&effects_text(&effects))?;
    }
    Ok(Outcome::Done)
}
