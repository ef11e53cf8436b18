//! `mavid fleet report DIR`: which vehicles changed.

use super::work::failed;
use crate::cli::FleetReportArgs;
use crate::commands::{CommandError, Outcome, output};
use mavid::fleet::{FleetReport, PartsFolder, ReportSettings};
use mavid::report::{FleetDocument, fleet_html, fleet_text};
use mavid::store::is_remote;
use mavid::text;

/// Names of what is written.
const REPORT: &str = "report.html";
const DOCUMENT: &str = "fleet.json";

/// Runs the verb.
pub fn run(json: bool, args: &FleetReportArgs) -> Result<Outcome, CommandError> {
    if !(args.false_alarms > 0.0 && args.false_alarms < 1.0) {
        return Err(CommandError::Input(format!(
            "--false-alarms: expected a share between 0 and 1, got {}",
            args.false_alarms
        )));
    }
    let out = args.out.as_ref().unwrap_or(&args.folder);
    let is_here = !out.to_str().is_some_and(is_remote);
    if is_here && out.exists() && !out.is_dir() {
        return Err(CommandError::Input(format!("--out: expected a folder, {} is a file", text::path(out))));
    }
    let rows = PartsFolder::open(&args.folder).map_err(failed)?.read_all().map_err(failed)?;
    let settings = ReportSettings { false_alarms: args.false_alarms, shuffles: args.shuffles };
    let report = FleetReport::of(&rows, &settings);
    let document = FleetDocument::new(&report);
    let (page, words) = (fleet_html(&report), output::json_text(&document)?);
    let out = PartsFolder::open(out).map_err(failed)?;
    out.write(REPORT, page.into_bytes()).map_err(failed)?;
    out.write(DOCUMENT, words.into_bytes()).map_err(failed)?;
    if json {
        output::json(&document)?;
    } else {
        output::text(&fleet_text(&report))?;
        output::message(&format!("report: {}/{REPORT}", out.name()));
    }
    // that something changed is what was asked; the output says what could not be read
    Ok(match (report.changed().next().is_some(), report.errors.is_empty()) {
        (true, _) => Outcome::Changed,
        (false, true) => Outcome::Done,
        (false, false) => Outcome::DoneWithLoss,
    })
}
