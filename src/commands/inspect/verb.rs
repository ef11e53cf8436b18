//! The run of `mavid inspect`: a log is read, and what it holds is printed.

use mavid::config::read_vehicle;
use mavid::inspect::{self, Inspection};
use mavid::log::format_of;
use mavid::report::{InspectionDocument, inspection_text};
use mavid::study::{StudyError, draft_from_log, draft_notes, unread};
use mavid::text;
use mavid::vehicle::Vehicle;

use super::progress;
use crate::cli::InspectArgs;
use crate::commands::standard_error::StandardError;
use crate::commands::{CommandError, Outcome, output};

/// Runs the verb.
pub fn run(json: bool, stderr: &StandardError, args: &InspectArgs) -> Result<Outcome, CommandError> {
    let loaded = args.vehicle.as_deref().map(read_vehicle).transpose()?;
    if let (Some(path), Some(loaded)) = (&args.vehicle, &loaded) {
        output::warnings(path, &loaded.warnings);
    }
    let weighed = args.mass.map(|mass_kg| args.shape.given(mass_kg));
    let drafted = weighed.map(|weighed| draft_from_log(&args.log, &args.read.settings(), &weighed));
    let draft = match drafted.transpose() {
        // what the log holds is told all the same
        Err(StudyError::File { why, .. }) => {
            output::message(&format!("no vehicle can be drafted from this log: {why}"));
            None
        }
        draft => draft?,
    };
    draft.iter().flat_map(draft_notes).for_each(|note| output::note(&note));
    let of_file = loaded.as_ref().map(|loaded| &loaded.vehicle);
    let vehicle = of_file.or_else(|| draft.as_ref().map(|draft| &draft.vehicle));
    let inspection = inspect(stderr, args, vehicle)?;
    let file = text::path(&args.log);
    if let Some(why) = &inspection.other_rotors {
        let given =
            args.vehicle.as_ref().map_or_else(String::new, |path| format!(" with {}", text::path(path)));
        return Err(CommandError::Input(format!("{file}{given}: {why}")));
    }
    if json {
        output::json(&InspectionDocument::new(&file, &inspection))?;
    } else {
        output::text(&inspection_text(&file, &inspection))?;
    }
    Ok(if inspection.losses.is_empty() { Outcome::Done } else { Outcome::DoneWithLoss })
}

fn inspect(
    stderr: &StandardError,
    args: &InspectArgs,
    vehicle: Option<&Vehicle>,
) -> Result<Inspection, CommandError> {
    let path = args.log.as_path();
    let format = format_of(path).map_err(|error| unread(path, error))?;
    let refused = [
        ("--csv-map is for tables (.csv)", args.read.csv_map.is_some() && !format.takes_columns),
        ("--system-id is for telemetry logs (.tlog)", args.read.system.is_some() && !format.takes_system),
    ];
    if let Some((option, _)) = refused.into_iter().find(|(_, is_refused)| *is_refused) {
        return Err(CommandError::Input(format!("{option}; this one is a {}", format.name)));
    }
    let options = args.read.settings().open_options()?;
    let bar = stderr.bar(progress::of_file(path));
    let inspection = inspect::inspect(path, &options, vehicle, &mut |bytes| bar.set_position(bytes));
    bar.finish_and_clear();
    Ok(inspection.map_err(|error| unread(path, error))?)
}
