//! What was found before parameters of a vehicle were changed, in a file of the user's own: it is put back from there, also
//! by a later run.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::moment::Moment;
use super::name::local_name;
use crate::files::write_whole;
use crate::text;

/// One parameter that was changed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Noted {
    /// its name
    pub name: String,
    /// what it was
    pub found: f64,
    /// what it was set to
    pub set: f64,
    /// what the vehicle made of it by itself; `None` where it kept what was set, or this is not known
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub became: Option<f64>,
    /// when it was set; not in notes of older releases
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at: Option<Moment>,
}

#[derive(Debug, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Document {
    vehicle: String,
    #[serde(default)]
    parameter: Vec<Noted>,
}

/// Why notes are not read or written.
#[derive(Debug, thiserror::Error)]
pub enum NotesError {
    /// the file system says no
    #[error("{path}: {source}")]
    File {
        /// which file
        path: String,
        /// what it says
        source: io::Error,
    },
    /// somebody wrote something else into it
    #[error("{path}: expected the parameters that were changed on a vehicle, as mavid writes them: {why}")]
    Form {
        /// which file
        path: String,
        /// what is wrong
        why: String,
    },
}

/// Beginning and end of the name of a vehicle's file: of what was changed for its logging, and of a file that was loaded.
const PREFIX: &str = "logging-";
const LOADED: &str = "loaded-";
const SUFFIX: &str = ".toml";

/// The notes of one vehicle.
#[derive(Debug, Clone)]
pub struct Notes {
    path: PathBuf,
    vehicle: String,
    kind: Kind,
}

/// For what parameters were changed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Logging,
    Loaded,
}

impl Kind {
    fn prefix(self) -> &'static str {
        match self {
            Self::Logging => PREFIX,
            Self::Loaded => LOADED,
        }
    }

    /// What they are, and what puts them back.
    fn words(self) -> (&'static str, &'static str) {
        match self {
            Self::Logging => ("Parameters of logging", "mavid log prepare --connect ADDRESS --restore"),
            Self::Loaded => ("Parameters of a file", "mavid vehicle load --connect ADDRESS --undo"),
        }
    }
}

impl Noted {
    /// Whether a value of it is due to what was set, and not to somebody who changed it since.
    #[must_use]
    pub fn is_own(&self, value: f64) -> bool {
        value == self.set || self.became == Some(value)
    }
}

impl Notes {
    /// Of this vehicle's logging, in this folder.
    #[must_use]
    pub fn of(folder: &Path, vehicle: &str) -> Self {
        Self::named(Kind::Logging, folder, vehicle)
    }

    /// Of what was loaded onto this vehicle from a file, in this folder.
    #[must_use]
    pub fn of_loaded(folder: &Path, vehicle: &str) -> Self {
        Self::named(Kind::Loaded, folder, vehicle)
    }

    fn named(kind: Kind, folder: &Path, vehicle: &str) -> Self {
        let path = folder.join(format!("{}{}{SUFFIX}", kind.prefix(), local_name(vehicle)));
        Self { path, vehicle: vehicle.to_owned(), kind }
    }

    /// Whether a file of this name holds notes of logging.
    #[must_use]
    pub fn are_at(path: &Path) -> bool {
        let name = path.file_name().and_then(|name| name.to_str());
        name.is_some_and(|name| name.starts_with(PREFIX) && name.ends_with(SUFFIX))
    }

    /// Where they are.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    fn failed(&self, source: io::Error) -> NotesError {
        NotesError::File { path: text::path(&self.path), source }
    }

    /// What was changed and not put back; nothing where there are none.
    ///
    /// # Errors
    /// They cannot be read.
    pub fn read(&self) -> Result<Vec<Noted>, NotesError> {
        let written = match fs::read_to_string(&self.path) {
            Ok(written) => written,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Vec::new()),
            Err(error) => return Err(self.failed(error)),
        };
        let form = |why: String| NotesError::Form { path: text::path(&self.path), why };
        let document: Document = toml::from_str(&written).map_err(|error| form(error.to_string()))?;
        if document.vehicle != self.vehicle {
            return Err(form(format!("they are of vehicle {}", document.vehicle)));
        }
        Ok(document.parameter)
    }

    /// Adds what is about to be changed: what was found first stays.
    ///
    /// # Errors
    /// They cannot be written; then nothing must be changed.
    pub fn add(&self, changes: &[Noted]) -> Result<(), NotesError> {
        let mut parameter = self.read()?;
        for change in changes {
            match parameter.iter_mut().find(|known| known.name == change.name) {
                Some(known) => *known = Noted { found: known.found, ..change.clone() },
                None => parameter.push(change.clone()),
            }
        }
        self.write(parameter)
    }

    /// Keeps these alone: the others are as they were. Without any the file goes.
    ///
    /// # Errors
    /// The file cannot be written or removed.
    pub fn keep(&self, parameter: Vec<Noted>) -> Result<(), NotesError> {
        if parameter.is_empty() { self.forget() } else { self.write(parameter) }
    }

    fn write(&self, parameter: Vec<Noted>) -> Result<(), NotesError> {
        let document = Document { vehicle: self.vehicle.clone(), parameter };
        let words = toml::to_string(&document)
            .map_err(|error| NotesError::Form { path: text::path(&self.path), why: error.to_string() })?;
        if let Some(folder) = self.path.parent() {
            fs::create_dir_all(folder).map_err(|error| self.failed(error))?;
        }
        let (what, command) = self.kind.words();
        let head = format!(
            "# {what} that mavid changed on a vehicle, and what they were before.\n# `{command}` puts them back and removes \
             this file.\n"
        );
        write_whole(&self.path, format!("{head}{words}").as_bytes()).map_err(|error| self.failed(error))
    }

    fn forget(&self) -> Result<(), NotesError> {
        match fs::remove_file(&self.path) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => Err(self.failed(error)),
            _ => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_found_first_is_kept_until_it_is_put_back() {
        let folder = std::env::temp_dir().join(format!("mavid-notes-{}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        let notes = Notes::of(&folder, "ab/../cd");
        assert_eq!(notes.path(), folder.join("logging-cd.toml"));
        assert_eq!(notes.read().unwrap(), []);
        let at = |utc_s: f64| Some(Moment { utc_s, up_s: Some(60.0) });
        let noted = |found: f64, set: f64, utc_s: f64| Noted {
            name: "SDLOG_PROFILE".to_owned(),
            found,
            set,
            became: None,
            at: at(utc_s),
        };
        notes.add(&[noted(1.0, 9.0, 1e9)]).unwrap();
        notes.add(&[noted(9.0, 27.0, 2e9)]).unwrap();
        assert_eq!(notes.read().unwrap(), [noted(1.0, 27.0, 2e9)]);
        // what the vehicle makes of it by itself is nobody else's
        let became = Noted { became: Some(25.0), ..noted(1.0, 27.0, 2e9) };
        notes.add(std::slice::from_ref(&became)).unwrap();
        assert_eq!(notes.read().unwrap(), std::slice::from_ref(&became));
        assert!(
            became.is_own(27.0)
                && became.is_own(25.0)
                && !became.is_own(1.0)
                && !noted(1.0, 27.0, 0.0).is_own(25.0)
        );
        let mode = Noted { name: "SDLOG_MODE".to_owned(), at: None, ..noted(-1.0, 0.0, 0.0) };
        notes.add(std::slice::from_ref(&mode)).unwrap();
        notes.keep(vec![mode.clone()]).unwrap();
        assert_eq!(notes.read().unwrap(), [mode]);
        let other = Notes { vehicle: "other".to_owned(), ..notes.clone() };
        assert!(other.read().unwrap_err().to_string().contains("of vehicle ab/../cd"));
        notes.keep(Vec::new()).unwrap();
        notes.keep(Vec::new()).unwrap();
        assert_eq!(notes.read().unwrap(), []);
        fs::remove_dir_all(&folder).unwrap();
    }
}
