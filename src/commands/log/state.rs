//! Where the program keeps what it must not forget between two runs.

use std::path::PathBuf;

use mavid::fetch::Notes;

use crate::commands::CommandError;

/// The variable that names the folder.
const FOLDER: &str = "MAVID_STATE_DIR";

/// The notes of a vehicle's logging.
pub fn notes(vehicle: &str) -> Result<Notes, CommandError> {
    Ok(Notes::of(&given_folder()?, vehicle))
}

/// The notes of what was loaded onto a vehicle.
pub fn notes_of_loaded(vehicle: &str) -> Result<Notes, CommandError> {
    Ok(Notes::of_loaded(&given_folder()?, vehicle))
}

fn given_folder() -> Result<PathBuf, CommandError> {
    folder().ok_or_else(|| {
        let expected = "expected a folder for what is to be put back on the vehicle";
        CommandError::Input(format!("{expected}: set {FOLDER}, XDG_STATE_HOME or HOME"))
    })
}

/// Whether there are notes of any vehicle.
pub fn has_notes() -> bool {
    let entries = folder().and_then(|folder| std::fs::read_dir(folder).ok());
    entries.into_iter().flatten().flatten().any(|entry| Notes::are_at(&entry.path()))
}

fn folder() -> Option<PathBuf> {
    let variable = |name: &str| std::env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
    let own = |folder: PathBuf| folder.join("mavid");
    variable(FOLDER)
        .or_else(|| variable("XDG_STATE_HOME").map(own))
        .or_else(|| variable("HOME").map(|home| home.join(".local/state/mavid")))
        .or_else(|| variable("LOCALAPPDATA").map(own))
}
