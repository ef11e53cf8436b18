//! `mavid vehicle FILE`: checks a vehicle file and says what it means.

use mavid::config::read_vehicle;
use mavid::report::vehicle_text;
use mavid::study::vehicle_summary;

use super::{CommandError, Outcome, output};
use crate::cli::VehicleArgs;

/// Runs the verb.
pub fn run(json: bool, args: &VehicleArgs) -> Result<Outcome, CommandError> {
    let summary = vehicle_summary(&read_vehicle(&args.file)?);
    output::warnings(&args.file, &summary.warnings);
    if json {
        output::json(&summary)?
    } else {
        output::text(&vehicle_text(&summary))?
    }
    Ok(Outcome::Done)
}
