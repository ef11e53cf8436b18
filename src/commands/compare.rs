//! `mavid compare BEFORE... --with AFTER...`: what changed of a vehicle between flights.

use std::path::PathBuf;

use mavid::report::{ComparisonDocument, comparison_html, comparison_markdown, comparison_text};
use mavid::study::compare;
use mavid::text;

use super::explain::{REPORT, SUMMARY, TEXT};
use super::progress::Spinner;
use super::standard_error::StandardError;
use super::{CommandError, Outcome, output};
use crate::cli::CompareArgs;

/// Name of the document that is written.
pub const DOCUMENT: &str = "comparison.json";

/// Runs the verb.
pub fn run(json: bool, stderr: &StandardError, args: &CompareArgs) -> Result<Outcome, CommandError> {
    let request = args.request();
    request.check()?;
    check_targets(args)?;
    let study = compare(&request, &Spinner::new(stderr))?;
    if let Some(folder) = &args.out {
        output::folder(folder)?;
        output::file(&folder.join(REPORT), &comparison_html(&study))?;
        output::file(&folder.join(SUMMARY), &comparison_markdown(&study))?;
        output::file(&folder.join(TEXT), &format!("{}\n", comparison_text(&study)))?;
        output::file(&folder.join(DOCUMENT), &output::json_text(&ComparisonDocument::new(&study))?)?;
    }
    if json {
        output::json(&ComparisonDocument::new(&study))?;
    } else {
        output::text(&comparison_text(&study))?;
    }
    study.notes.iter().for_each(output::note);
    // that something changed is what was asked; the output says what was lost or left out, and why nothing may have been compared
    Ok(match study.is_whole() && study.is_of_one_vehicle() {
        _ if study.has_changed() => Outcome::Changed,
        true => Outcome::Done,
        false => Outcome::DoneWithLoss,
    })
}

/// A target that cannot be written is told before the work.
fn check_targets(args: &CompareArgs) -> Result<(), CommandError> {
    let Some(folder) = &args.out else { return Ok(()) };
    if folder.exists() && !folder.is_dir() {
        return Err(CommandError::Input(format!(
            "--out: expected a folder, {} is a file",
            text::path(&folder)
        )));
    }
    let inputs: Vec<&PathBuf> = args.before.iter().chain(&args.after).chain(&args.vehicle).collect();
    let written = [REPORT, SUMMARY, TEXT, DOCUMENT].map(|name| folder.join(name));
    output::refuse_overwriting(&inputs, &written.iter().collect::<Vec<_>>())?;
    output::can_make_folder(folder)
}
