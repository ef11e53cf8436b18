//! `mavid explain LOG... --vehicle V`: which physics the model left out.

use std::path::{Path, PathBuf};

use mavid::config::trajectory_to_toml;
use mavid::report::{
    ExplanationDocument, explained_model, explanation_answer_line, explanation_html, explanation_markdown,
    explanation_page, explanation_text,
};
use mavid::study::{
    ExplainRequest, ExplainStudy, InputFile, Progress, draft_text, explain, lost, stored_trajectory,
};
use mavid::text;

use super::progress::Spinner;
use super::standard_error::StandardError;
use super::words::Word;
use super::{CommandError, Outcome, output};
use crate::cli::{ExplainArgs, PageFormat};

/// Names of what [`write`] writes.
const MODEL: &str = "model.toml";
pub const REPORT: &str = "report.html";
/// The summary to paste into a forum or an issue: the text of `--format md`.
pub const SUMMARY: &str = "report.md";
/// The text for the terminal.
pub const TEXT: &str = "report.txt";
pub const DOCUMENT: &str = "explanation.json";
/// The vehicle file, where it was drafted.
const VEHICLE: &str = "vehicle.toml";
/// All of them.
pub const WRITTEN: [&str; 5] = [MODEL, REPORT, SUMMARY, TEXT, DOCUMENT];

/// Runs the verb.
pub fn run(json: bool, stderr: &StandardError, args: &ExplainArgs) -> Result<Outcome, CommandError> {
    let study = make(&Spinner::new(stderr), args)?;
    let say_remarks = || remarks(&study).iter().for_each(Word::say);
    if json {
        output::json(&ExplanationDocument::new(&study))?;
        say_remarks();
    } else if args.format == PageFormat::Md {
        output::file_text(&explanation_markdown(&study))?;
        say_remarks();
    } else {
        // notes that come on the same terminal by standard error are not said twice
        let has_notes_beside = output::is_one_terminal() && !stderr.is_quiet();
        let page = if has_notes_beside { explanation_page(&study) } else { explanation_text(&study) };
        output::text(&page)?;
        say_remarks();
        output::once_more(&page, |columns| closing(&study, args, columns))?;
    }
    Ok(outcome(&study))
}

/// The answer in one line, and where the report is: the last lines on a terminal that the page does not fit into.
fn closing(study: &ExplainStudy, args: &ExplainArgs, columns: usize) -> String {
    let answer = explanation_answer_line(study, columns);
    match &args.out {
        Some(folder) => format!("{answer}\n{}", places(folder)),
        None => answer,
    }
}

/// Where the summary and the report of a folder are, line by line.
pub fn places(folder: &Path) -> String {
    let [summary, report] = [SUMMARY, REPORT].map(|name| text::path(&folder.join(name)));
    format!("summary to paste: {summary}\nreport: {report}")
}

/// Explains, and writes what is asked for. How far it is is told to `progress`.
pub fn make(progress: &dyn Progress, args: &ExplainArgs) -> Result<ExplainStudy, CommandError> {
    let request = ExplainRequest {
        logs: args.logs.clone(),
        vehicle: args.given.given(),
        holdout: args.holdout.clone(),
        read: args.read.settings(),
        transient_s: args.transient,
        design_next: args.next.is_some(),
        next_limits: args.limits.clone(),
    };
    request.check()?;
    check_targets(args)?;
    let study = explain(&request, progress)?;
    if let Some(path) = &args.next {
        write_next(&study, path)?;
    }
    if let Some(folder) = &args.out {
        write(&study, folder)?;
    }
    Ok(study)
}

/// Writes model, report, summary, text and document into a folder, which is made.
pub fn write(study: &ExplainStudy, folder: &Path) -> Result<(), CommandError> {
    output::folder(folder)?;
    output::file(&folder.join(REPORT), &explanation_html(study))?;
    output::file(&folder.join(SUMMARY), &explanation_markdown(study))?;
    output::file(&folder.join(TEXT), &format!("{}\n", explanation_text(study)))?;
    output::file(&folder.join(DOCUMENT), &output::json_text(&ExplanationDocument::new(study))?)?;
    if let Some(draft) = &study.drafted {
        output::file(&folder.join(VEHICLE), &draft_text(draft)?)?;
    }
    // last: it is refused where what was determined is no body's
    output::file(&folder.join(MODEL), &explained_model(study)?)
}

/// What is to be known about the data, line by line.
pub fn remarks(study: &ExplainStudy) -> Vec<Word> {
    let of_inputs = study.inputs().flat_map(InputFile::remarks).map(|note| Word::Message(note.sentence()));
    study.notes.iter().map(Word::from).chain(of_inputs).collect()
}

/// Whether something of the recordings was lost.
pub fn outcome(study: &ExplainStudy) -> Outcome {
    if lost(study.inputs()).is_empty() { Outcome::Done } else { Outcome::DoneWithLoss }
}

/// The trajectory of the flight that distinguishes what these cannot, or why there is none.
fn write_next(study: &ExplainStudy, path: &Path) -> Result<(), CommandError> {
    match &study.next_flight {
        Some(Ok(next)) => output::file(path, &trajectory_to_toml(&stored_trajectory(next))?),
        Some(Err(why)) => {
            output::message(&format!("--next: nothing written: {why}"));
            output::outdated(path)?.iter().for_each(|note| output::message(note));
            Ok(())
        }
        None => Ok(()),
    }
}

/// A target that cannot be written is told before the work.
fn check_targets(args: &ExplainArgs) -> Result<(), CommandError> {
    if let Some(path) = args.out.as_ref().filter(|path| path.exists() && !path.is_dir()) {
        return Err(CommandError::Input(format!(
            "--out: expected a folder, {} is a file",
            text::path(&path)
        )));
    }
    let inputs: Vec<&PathBuf> = args.logs.iter().chain(&args.holdout).chain(&args.given.vehicle).collect();
    let written: Vec<PathBuf> =
        args.out.iter().flat_map(|folder| WRITTEN.map(|name| folder.join(name))).collect();
    let drafted = args.given.vehicle.is_none();
    let vehicle_file = args.out.iter().filter(|_| drafted).map(|folder| folder.join(VEHICLE));
    let written: Vec<PathBuf> = written.into_iter().chain(vehicle_file).collect();
    output::refuse_overwriting(&inputs, &args.next.iter().chain(&written).collect::<Vec<_>>())?;
    if let Some(folder) = &args.out {
        output::can_make_folder(folder)?;
    }
    args.next.as_deref().map_or(Ok(()), output::folder_of)
}
