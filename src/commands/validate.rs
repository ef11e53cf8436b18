//! `mavid validate LOG... --model A --model B...`: the paper's two validations and open-loop playback.

use std::path::Path;

use mavid::report::{ValidationDocument, closed_loop_charts, svg, validation_html, validation_text};
use mavid::study::{ValidateRequest, ValidateStudy, validate};
use mavid::text;

use super::explain::REPORT;
use super::identify::tell;
use super::progress::Spinner;
use super::standard_error::StandardError;
use super::{CommandError, Outcome, output};
use crate::cli::ValidateArgs;

/// The last line of a figure, by which one of an earlier run is known.
const FIGURE: &str = "<!-- a figure of mavid validate -->\n";

/// Runs the verb.
pub fn run(json: bool, stderr: &StandardError, args: &ValidateArgs) -> Result<Outcome, CommandError> {
    let request = ValidateRequest {
        logs: args.logs.clone(),
        models: args.models.clone(),
        drafted: args.mass.map(|mass_kg| args.shape.given(mass_kg)),
        read: args.read.settings(),
        transient_s: args.transient,
    };
    request.check()?;
    // a target that cannot be written is told before the work
    if let Some(folder) = &args.out {
        output::folder(folder)?;
    }
    let study = validate(&request, &Spinner::new(stderr))?;
    if let Some(folder) = &args.out {
        write_charts(folder, &study)?;
        output::file(&folder.join(REPORT), &validation_html(&study))?;
    }
    if json {
        output::json(&ValidationDocument::new(&study))?;
    } else {
        output::text(&validation_text(&study))?;
    }
    Ok(tell(study.flights.iter().map(|flight| &flight.input)))
}

/// One file a flight. What an earlier run put there and this one did not is removed, so that nothing old passes for
/// new; files of others stay.
fn write_charts(folder: &Path, study: &ValidateStudy) -> Result<(), CommandError> {
    let mut written = Vec::new();
    for (index, flight) in study.flights.iter().enumerate() {
        let stem = text::path(Path::new(&flight.input.path).file_stem().unwrap_or_default());
        // flights of different folders may have one name
        let path = folder.join(format!("{}-{stem}.svg", index + 1));
        let charts = closed_loop_charts(&flight.flown_again);
        if charts.is_empty() {
            output::outdated(&path)?.iter().for_each(|note| output::message(note));
        } else {
            output::file(&path, &format!("{}{FIGURE}", svg(&charts)))?;
            written.push(path);
        }
    }
    let unread =
        |error| CommandError::Input(format!("--out: cannot look into {}: {error}", text::path(&folder)));
    for entry in std::fs::read_dir(folder).map_err(unread)? {
        let path = entry.map_err(unread)?.path();
        if !written.contains(&path) && is_figure(&path) {
            output::outdated(&path)?.iter().for_each(|note| output::message(note));
        }
    }
    Ok(())
}

/// Named and ended as a figure of this verb.
fn is_figure(path: &Path) -> bool {
    let name = text::path(path.file_name().unwrap_or_default());
    let numbered = name.split_once('-').is_some_and(|(number, _)| number.parse::<usize>().is_ok());
    let ended = || std::fs::read(path).is_ok_and(|bytes| bytes.ends_with(FIGURE.as_bytes()));
    numbered && name.ends_with(".svg") && ended()
}
