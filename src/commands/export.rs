//! `mavid export MODEL --to FORMAT`: the model for another simulator.

use std::path::PathBuf;

use mavid::export::{Exported, Format, export};
use mavid::study::effects_of;
use mavid::text;
use serde::Serialize;

use super::{CommandError, Outcome, output};
use crate::cli::{ExportArgs, ExportFormat};

#[derive(Debug, Serialize)]
struct Document {
    schema: u32,
    file: Option<String>,
    text: String,
    left_out: Vec<String>,
}

/// Runs the verb.
pub fn run(json: bool, args: &ExportArgs) -> Result<Outcome, CommandError> {
    let Made { exported: Exported { text, left_out }, origin, warnings } = make(args)?;
    output::warnings(&origin, &warnings);
    left_out.iter().for_each(|note| output::message(&format!("note: {note}")));
    if json {
        let file = args.out.as_ref().map(|path| text::path(&path));
        output::json(&Document { schema: 1, file, text, left_out })?;
    } else if args.out.is_none() {
        output::text(text.trim_end())?;
    }
    Ok(Outcome::Done)
}

/// A model that was exported.
#[derive(Debug)]
pub struct Made {
    exported: Exported,
    /// what messages call the model
    origin: PathBuf,
    /// what is doubtful about it
    warnings: Vec<String>,
}

/// Exports, and writes the file that is asked for.
pub fn make(args: &ExportArgs) -> Result<Made, CommandError> {
    let (loaded, origin) = args.draft.given(args.model.as_ref()).alone()?;
    let refuse =
        |error: &dyn std::fmt::Display| CommandError::Input(format!("{}: {error}", text::path(&origin)));
    let active = effects_of(&loaded.model.effects, &text::path(&origin), &loaded.vehicle)?;
    let format = match args.to {
        ExportFormat::Px4Sih => Format::Px4Sih,
        ExportFormat::ArdupilotSitl => Format::ArdupilotSitl,
        ExportFormat::Sdf => Format::Sdf,
        ExportFormat::Mjcf => Format::Mjcf,
        ExportFormat::Rotorpy => Format::Rotorpy,
    };
    let exported = export(&loaded.vehicle, &active, format).map_err(|error| refuse(&error))?;
    if let Some(path) = &args.out {
        output::file(path, &exported.text)?;
    }
    let warnings = loaded.warnings;
    Ok(Made { exported, origin, warnings })
}
