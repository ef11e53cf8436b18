//! A log without a flight is refused with the message of `inspect`, before any other check.

use super::vehicle_given::DRAFTED;
use super::{ReadSettings, StudyError};
use crate::inspect::{Unflown, inspect};
use crate::log::OpenOptions;
use crate::signals::SignalsError;
use crate::text;
use std::path::{Path, PathBuf};

/// Why logs cannot be used: that nothing was flown in one of them, or that its flight does not show, comes before what a vehicle
/// file or `--frame` could mend.
pub(super) fn unflown_first(error: StudyError, logs: &[PathBuf], read: &ReadSettings) -> StudyError {
    let says_expected = match &error {
        StudyError::File { .. } => false,
        // a drafted vehicle expects what the log holds
        StudyError::Flight { source, vehicle, .. } => {
            vehicle != DRAFTED && matches!(**source, SignalsError::NoActuators { .. })
        }
        _ => return error,
    };
    let Ok(options) = read.open_options() else { return error };
    logs.iter().find_map(|log| unflown(log, &options, says_expected)).unwrap_or(error)
}

/// The refusal of a log; `None` of one with a flight, and of one without actuators where `says_expected`: the error then says which
/// were expected.
fn unflown(log: &Path, options: &OpenOptions, says_expected: bool) -> Option<StudyError> {
    let found = inspect(log, options, None, &mut |_| ()).ok()?;
    let Unflown { why, .. } = found.unflown.filter(|of| !(says_expected && of.lacks_actuators))?;
    let losses = match found.losses.join("; ") {
        losses if losses.is_empty() => losses,
        losses => format!(" Not read of the log: {losses}"),
    };
    let why = format!("nothing can be identified from this log: {why}{losses}");
    Some(StudyError::File { file: text::path(&log), why })
}
