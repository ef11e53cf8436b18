//! `mavid prove CASES --answers FILE`: explains a folder of cases, seals the verdicts, then scores them.

use std::path::PathBuf;

use mavid::files::write_whole;
use mavid::report::proof_text;
use mavid::study::{CaseVerdict, Progress, case_folders, prove, seal, verdict};
use mavid::text;

use super::progress::Steps;
use super::standard_error::StandardError;
use super::{CommandError, Outcome, output};
use crate::cli::ProveArgs;

/// Runs the verb.
pub fn run(json: bool, stderr: &StandardError, args: &ProveArgs) -> Result<Outcome, CommandError> {
    check(args)?;
    let verdicts = verdicts(stderr, &case_folders(&args.cases)?);
    let sealed_sha256 = sealed(args, &verdicts)?;
    output::message(&format!("{} verdicts sealed, SHA-256 {sealed_sha256}", verdicts.len()));
    // the answers are read only now
    let proof = prove(verdicts, args.answers.as_deref(), (&args.out, sealed_sha256))?;
    if json {
        output::json(&proof)?;
    } else {
        output::text(&proof_text(&proof))?;
    }
    Ok(if proof.is_whole() { Outcome::Done } else { Outcome::DoneWithLoss })
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
fn verdicts(stderr: &StandardError, folders: &[PathBuf]) -> Vec<CaseVerdict> {
    let progress = Steps::new(stderr, "{bar:30} {pos} of {len} cases, about {eta} left");
    progress.steps(folders.len() as u64);
    let mut verdicts = Vec::with_capacity(folders.len());
    for folder in folders {
        let verdict = verdict(folder);
        let failed = verdict.error.as_ref().map_or_else(String::new, |error| format!(": {error}"));
        output::message(&format!("{}: {}{failed}", verdict.case, verdict.verdict));
        verdicts.push(verdict);
        progress.step();
    }
    verdicts
}

/// Writes every verdict and gives the hash of all of them.
fn sealed(args: &ProveArgs, verdicts: &[CaseVerdict]) -> Result<String, CommandError> {
    let sealed =
        seal(verdicts).map_err(|error| CommandError::Failure(format!("cannot write JSON: {error}")))?;
    let failed = |path: &PathBuf, error: std::io::Error| {
        CommandError::Failure(format!("cannot write {}: {error}", text::path(path)))
    };
    output::folder(&args.out)?;
    for (name, text) in &sealed.files {
        let path = args.out.join(name);
        write_whole(&path, text.as_bytes()).map_err(|error| failed(&path, error))?;
    }
    Ok(sealed.sha256)
}
