//! The run of `mavid prove`: all verdicts are sealed before they are scored.

use std::path::{Path, PathBuf};

use mavid::text;

use super::case::{self, Verdict};
use super::document::Document;
use super::score::{self, Scored};
use super::seal::seal;
use super::{answers, page};
use crate::cli::ProveArgs;
use crate::commands::{CommandError, Outcome, output};

/// Runs the verb.
pub fn run(json: bool, args: &ProveArgs) -> Result<Outcome, CommandError> {
    check(args)?;
    let verdicts = verdicts(&case_folders(&args.cases)?);
    let sealed_sha256 = seal(&args.out, &verdicts)?;
    output::message(&format!("{} verdicts sealed, SHA-256 {sealed_sha256}", verdicts.len()));
    let document = scored(args, verdicts, sealed_sha256)?;
    if json {
        output::json(&document)?;
    } else {
        output::text(page::page(&document).trim_end())?;
    }
    let failed = document.cases.iter().any(|case| case.error.is_some())
        || document.unscored.iter().any(|verdict| verdict.error.is_some());
    Ok(if failed { Outcome::DoneWithLoss } else { Outcome::Done })
}

fn check(args: &ProveArgs) -> Result<(), CommandError> {
    if args.out.exists() && !args.out.is_dir() {
        return Err(CommandError::Input(format!(
            "--out: expected a folder, {} is a file",
            text::path(&args.out)
        )));
    }
    if let Some(file) = args.answers.as_ref().filter(|file| !file.is_file()) {
        return Err(CommandError::Input(format!("--answers: {} is not a file", text::path(&file))));
    }
    Ok(())
}

/// One after another: each uses all cores, and its time is reported.
fn verdicts(folders: &[PathBuf]) -> Vec<Verdict> {
    let mut verdicts = Vec::with_capacity(folders.len());
    for folder in folders {
        let verdict = case::verdict(folder);
        let failed = verdict.error.as_ref().map_or_else(String::new, |error| format!(": {error}"));
        output::message(&format!("{}: {}{failed}", verdict.case, verdict.verdict));
        verdicts.push(verdict);
    }
    verdicts
}

/// Reads the answers, if any, only now that the verdicts are sealed.
fn scored(args: &ProveArgs, verdicts: Vec<Verdict>, sealed_sha256: String) -> Result<Document, CommandError> {
    let found = match &args.answers {
        Some(file) => answers::read(file)?,
        None => answers::Answers::default(),
    };
    let (answered, unscored): (Vec<Verdict>, Vec<Verdict>) =
        verdicts.into_iter().partition(|verdict| found.cases.contains_key(&verdict.case));
    if let Some(file) = args.answers.as_ref().filter(|_| answered.is_empty()) {
        let cases: Vec<&str> = unscored.iter().map(|verdict| verdict.case.as_str()).collect();
        let named: Vec<&str> = found.cases.keys().map(String::as_str).collect();
        return Err(CommandError::Input(format!(
            "{}: expected answers by the names of the cases ({}), got {}; the verdicts are sealed in {}",
            text::path(&file),
            cases.join(", "),
            if named.is_empty() { "none".to_owned() } else { named.join(", ") },
            text::path(&args.out)
        )));
    }
    let cases: Vec<Scored> =
        answered.iter().map(|verdict| score::scored(verdict, &found.cases[&verdict.case])).collect();
    let mut notes = found.notes;
    let has_folder = |name: &str| cases.iter().any(|case| case.case == name);
    let without = found.cases.keys().filter(|name| !has_folder(name));
    notes.extend(without.map(|name| format!("{name}: has an answer, but no folder")));
    Ok(Document {
        schema: 1,
        sealed_sha256,
        verdicts: args.out.clone(),
        summary: (!cases.is_empty()).then(|| score::summary(&cases)),
        cases,
        unscored,
        notes,
    })
}

/// Folders with a vehicle file, by name; or the folder itself.
fn case_folders(cases: &Path) -> Result<Vec<PathBuf>, CommandError> {
    let refuse =
        |error: &dyn std::fmt::Display| CommandError::Input(format!("{}: {error}", text::path(&cases)));
    if cases.join(case::VEHICLE).is_file() {
        return Ok(vec![cases.to_owned()]);
    }
    let mut folders = Vec::new();
    for entry in std::fs::read_dir(cases).map_err(|error| refuse(&error))? {
        let path = entry.map_err(|error| refuse(&error))?.path();
        if path.join(case::VEHICLE).is_file() {
            folders.push(path);
        }
    }
    folders.sort();
    if folders.is_empty() {
        return Err(refuse(&format!("expected folders with {} and logs, found none", case::VEHICLE)));
    }
    Ok(folders)
}
