//! `mavid vehicle FILE`: checks a vehicle file and says what it means. `mavid vehicle init`: writes a first one.

use std::path::Path;

use mavid::config::read_vehicle;
use mavid::report::vehicle_text;
use mavid::study::{draft_from_log, draft_text, vehicle_summary};

use super::{CommandError, Outcome, output};
use crate::cli::{InitArgs, VehicleArgs, VehicleVerb};

/// Runs the verb.
pub fn run(json: bool, args: &VehicleArgs) -> Result<Outcome, CommandError> {
    match (&args.verb, &args.file) {
        (Some(VehicleVerb::Init(init)), _) => draft(json, init),
        (None, Some(file)) => check(json, file),
        (None, None) => Ok(Outcome::Done),
    }
}

fn check(json: bool, file: &Path) -> Result<Outcome, CommandError> {
    let summary = vehicle_summary(&read_vehicle(file)?);
    output::warnings(file, &summary.warnings);
    if json {
        output::json(&summary)?
    } else {
        output::text(&vehicle_text(&summary))?
    }
    Ok(Outcome::Done)
}

/// Writes a first vehicle file, and says what it means.
fn draft(json: bool, args: &InitArgs) -> Result<Outcome, CommandError> {
    output::refuse_overwriting(&[&args.from], &[&args.out])?;
    let draft = draft_from_log(&args.from, &args.read.settings(), &args.shape.given(args.mass))?;
    output::file(&args.out, &draft_text(&draft)?)?;
    check(json, &args.out)
}
