//! The folders of cases, and the logs of each.

use std::path::{Path, PathBuf};

use crate::log::is_named_like_a_log;
use crate::study::StudyError;
use crate::text;

/// The vehicle file of a case.
pub(super) const VEHICLE: &str = "vehicle.toml";

fn refused(folder: &Path, why: &dyn std::fmt::Display) -> StudyError {
    StudyError::File { file: text::path(&folder), why: why.to_string() }
}

/// What is in a folder, in no order.
fn entries(folder: &Path) -> Result<Vec<PathBuf>, StudyError> {
    let failed = |error: std::io::Error| refused(folder, &error);
    let mut all = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(failed)? {
        all.push(entry.map_err(failed)?.path());
    }
    Ok(all)
}

/// Folders with a vehicle file, by name; or the folder itself.
///
/// # Errors
/// [`StudyError::File`] where there is none, or the folder cannot be read.
pub fn case_folders(cases: &Path) -> Result<Vec<PathBuf>, StudyError> {
    if cases.join(VEHICLE).is_file() {
        return Ok(vec![cases.to_owned()]);
    }
    let mut folders = entries(cases)?;
    folders.retain(|folder| folder.join(VEHICLE).is_file());
    folders.sort();
    if folders.is_empty() {
        let why = format!("expected folders with {VEHICLE} and logs, found none");
        return Err(refused(cases, &why));
    }
    Ok(folders)
}

/// Those to explain from, and those named `holdout...`.
pub(super) fn logs(folder: &Path) -> Result<(Vec<PathBuf>, Vec<PathBuf>), StudyError> {
    let mut all = entries(folder)?;
    all.retain(|path| is_named_like_a_log(path));
    all.sort();
    let (held, mut used): (Vec<PathBuf>, Vec<PathBuf>) =
        all.into_iter().partition(|path| starts(path, "holdout"));
    if used.iter().any(|path| starts(path, "identify")) {
        used.retain(|path| starts(path, "identify"));
    }
    if used.is_empty() {
        return Err(refused(folder, &"expected identify.tlog or other logs, found none"));
    }
    Ok((used, held))
}

fn starts(path: &Path, with: &str) -> bool {
    path.file_stem().and_then(|stem| stem.to_str()).is_some_and(|stem| stem.starts_with(with))
}
