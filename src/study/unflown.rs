//! A log without a flight is told so, whatever else it lacks: in the words of `inspect`.

use super::{ReadSettings, StudyError};
use crate::inspect::inspect;
use crate::log::OpenOptions;
use crate::text;
use std::path::{Path, PathBuf};

/// Why logs cannot be used: that nothing was flown in one of them, or that its flight does not show, comes before what a vehicle
/// file or `--frame` could mend.
pub(super) fn unflown_first(error: StudyError, logs: &[PathBuf], read: &ReadSettings) -> StudyError {
    if !matches!(error, StudyError::File { .. } | StudyError::Flight { .. }) {
        return error;
    }
    let Ok(options) = read.open_options() else { return error };
    logs.iter().find_map(|log| unflown(log, &options)).unwrap_or(error)
}

fn unflown(log: &Path, options: &OpenOptions) -> Option<StudyError> {
    let found = inspect(log, options, None, &mut |_| ()).ok()?;
    let why = format!("nothing can be identified from this log: {}", found.unflown?);
    let losses = if found.losses.is_empty() {
        String::new()
    } else {
        format!(" Not read of the log: {}", found.losses.join("; "))
    };
    Some(StudyError::File { file: text::path(&log), why: why + &losses })
}
