//! `mavid vehicle FILE`: checks a vehicle file and says what it means. `mavid vehicle init`: writes a first one.

use std::path::Path;

use mavid::config::read_vehicle;
use mavid::link::Address;
use mavid::report::vehicle_text;
use mavid::study::{draft_from_log, draft_text, vehicle_summary};

use super::{CommandError, Outcome, log, output};
use crate::cli::{InitArgs, VehicleArgs, VehicleLinkArgs, VehicleVerb};

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
    let given = args.shape.given(args.mass);
    let from = args.from.to_str().filter(|from| !args.from.exists() && from.parse::<Address>().is_ok());
    let draft = match from {
        Some(address) => log::drafted(
            &VehicleLinkArgs {
                connect: address.to_owned(),
                system_id: args.read.system,
                signing_key_file: args.signing_key_file.clone(),
            },
            &given,
        )?,
        None => draft_from_log(&args.from, &args.read.settings(), &given)?,
    };
    output::file(&args.out, &draft_text(&draft)?)?;
    check(json, &args.out)
}
