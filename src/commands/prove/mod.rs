//! `mavid prove CASES --answers FILE`: explains a folder of cases, seals the verdicts, then scores them.

mod answers;
mod case;
mod page;
mod score;

use std::fmt::Write;
use std::path::{Path, PathBuf};

use serde::Serialize;
use sha2::{Digest, Sha256};

use super::{CommandError, Outcome, output};
use crate::cli::ProveArgs;
use case::Verdict;
use score::{Scored, Summary};

/// What was found, sealed and scored.
#[derive(Debug, Serialize)]
struct Document {
    schema: u32,
    /// of the verdict files, each hashed, in the order of their names
    sealed_sha256: String,
    verdicts: PathBuf,
    summary: Option<Summary>,
    cases: Vec<Scored>,
    /// what was found where there are no answers
    unscored: Vec<Verdict>,
    notes: Vec<String>,
}

/// Runs the verb.
pub fn run(json: bool, args: &ProveArgs) -> Result<Outcome, CommandError> {
    let folders = case_folders(&args.cases)?;
    if args.out.exists() && !args.out.is_dir() {
        return Err(CommandError::Input(format!(
            "--out: expected a folder, {} is a file",
            args.out.display()
        )));
    }
    if let Some(file) = args.answers.as_ref().filter(|file| !file.is_file()) {
        return Err(CommandError::Input(format!("--answers: {} is not a file", file.display())));
    }
    let mut verdicts = Vec::with_capacity(folders.len());
    // one after another: each uses all cores, and its time is reported
    for folder in &folders {
        let verdict = case::verdict(folder);
        let failed = verdict.error.as_ref().map_or_else(String::new, |error| format!(": {error}"));
        output::message(&format!("{}: {}{failed}", verdict.case, verdict.verdict));
        verdicts.push(verdict);
    }
    let sealed_sha256 = seal(&args.out, &verdicts)?;
    output::message(&format!("{} verdicts sealed, SHA-256 {sealed_sha256}", verdicts.len()));
    let mut document = Document {
        schema: 1,
        sealed_sha256,
        verdicts: args.out.clone(),
        summary: None,
        cases: Vec::new(),
        unscored: Vec::new(),
        notes: Vec::new(),
    };
    let found = match &args.answers {
        Some(file) => answers::read(file)?,
        None => answers::Answers::default(),
    };
    document.notes = found.notes;
    if let Some(file) = args.answers.as_ref()
        && !verdicts.iter().any(|verdict| found.cases.contains_key(&verdict.case))
    {
        let cases: Vec<&str> = verdicts.iter().map(|verdict| verdict.case.as_str()).collect();
        let named: Vec<&str> = found.cases.keys().map(String::as_str).collect();
        return Err(CommandError::Input(format!(
            "{}: expected answers by the names of the cases ({}), got {}; the verdicts are sealed in {}",
            file.display(),
            cases.join(", "),
            if named.is_empty() { "none".to_owned() } else { named.join(", ") },
            args.out.display()
        )));
    }
    for verdict in verdicts {
        match found.cases.get(&verdict.case) {
            Some(answer) => document.cases.push(score::scored(&verdict, answer)),
            None => document.unscored.push(verdict),
        }
    }
    let explained: Vec<&str> = document.cases.iter().map(|case| case.case.as_str()).collect();
    let without: Vec<String> =
        found.cases.keys().filter(|case| !explained.contains(&case.as_str())).cloned().collect();
    document.notes.extend(without.iter().map(|case| format!("{case}: has an answer, but no folder")));
    if !document.cases.is_empty() {
        document.summary = Some(score::summary(&document.cases));
    }
    if json {
        output::json(&document)?;
    } else {
        output::text(page::page(&document).trim_end())?;
    }
    let failed = document.cases.iter().any(|case| case.error.is_some())
        || document.unscored.iter().any(|verdict| verdict.error.is_some());
    Ok(if failed { Outcome::DoneWithLoss } else { Outcome::Done })
}

/// Folders with a vehicle file, by name; or the folder itself.
fn case_folders(cases: &Path) -> Result<Vec<PathBuf>, CommandError> {
    let refuse = |error: &dyn std::fmt::Display| CommandError::Input(format!("{}: {error}", cases.display()));
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

/// Writes every verdict and gives the hash of all of them.
fn seal(folder: &Path, verdicts: &[Verdict]) -> Result<String, CommandError> {
    let failed = |path: &Path, error: std::io::Error| {
        CommandError::Failure(format!("cannot write {}: {error}", path.display()))
    };
    std::fs::create_dir_all(folder).map_err(|error| failed(folder, error))?;
    let mut list = String::new();
    for verdict in verdicts {
        let text = serde_json::to_string_pretty(verdict)
            .map_err(|error| CommandError::Failure(format!("cannot write JSON: {error}")))?;
        let path = folder.join(format!("{}.json", verdict.case));
        std::fs::write(&path, &text).map_err(|error| failed(&path, error))?;
        // as `sha256sum` prints it, so that `sha256sum -c` can check the files
        let _ = writeln!(list, "{}  {}.json", hash(text.as_bytes()), verdict.case);
    }
    let path = folder.join("SHA256SUMS");
    std::fs::write(&path, &list).map_err(|error| failed(&path, error))?;
    Ok(hash(list.as_bytes()))
}

fn hash(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    })
}
