//! The parts of a fleet's tables in a folder, here or in a store: `TABLE/part-ID.parquet`, or `.jsonl`. Parts merge by lying beside one another.

use std::collections::{BTreeMap, HashSet};
use std::io;
use std::path::Path;

use super::place::Place;
use super::rows::LogRows;
use super::sources::Shard;
use super::task::hexadecimal;
use crate::each_table;
use crate::store::StoreError;
use crate::table::{Row, TableError};
use crate::text;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

/// Folder of the lists of finished parts: a part is finished once its list is there.
const LISTS: &str = "_parts";
/// Folder of rows of logs that are in no part yet.
const WORK: &str = "_work";

/// The form of the files.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum PartForm {
    /// one JSON object a line
    Jsonl,
    /// Parquet
    #[cfg(feature = "fleet")]
    Parquet,
}

impl PartForm {
    /// What this program writes unless it is asked for another.
    #[cfg(feature = "fleet")]
    pub const USUAL: Self = Self::Parquet;
    /// What this program writes unless it is asked for another.
    #[cfg(not(feature = "fleet"))]
    pub const USUAL: Self = Self::Jsonl;

    /// Ending of its files.
    #[must_use]
    pub fn ending(self) -> &'static str {
        match self {
            Self::Jsonl => "jsonl",
            #[cfg(feature = "fleet")]
            Self::Parquet => "parquet",
        }
    }

    /// By the ending of a file; `None` of what this program does not read.
    fn of_name(name: &str) -> Option<Self> {
        match name.rsplit_once('.')?.1 {
            "jsonl" => Some(Self::Jsonl),
            #[cfg(feature = "fleet")]
            "parquet" => Some(Self::Parquet),
            _ => None,
        }
    }

    fn bytes<R: Row>(self, rows: &[R]) -> Result<Vec<u8>, TableError> {
        match self {
            Self::Jsonl => crate::table::to_json_lines(rows).map(String::into_bytes),
            #[cfg(feature = "fleet")]
            Self::Parquet => crate::table::to_parquet(rows, super::rows::SCHEMA),
        }
    }

    fn rows<R: Row>(self, bytes: Vec<u8>) -> Result<Vec<R>, TableError> {
        let refused = |why: String| TableError::File { table: R::TABLE, why };
        match self {
            Self::Jsonl => crate::table::from_json_lines(
                &String::from_utf8(bytes).map_err(|error| refused(error.to_string()))?,
            ),
            #[cfg(feature = "fleet")]
            Self::Parquet => crate::table::from_parquet(bytes),
        }
    }
}

/// A log of a part.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Listed {
    /// SHA-256 of its bytes
    pub sha256: String,
    /// its address
    pub uri: String,
    /// its size
    pub bytes: u64,
    /// when it was changed last, nanoseconds since 1970 UTC
    pub modified_ns: u64,
    /// its rows are those of another log of the part, which has the same bytes
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub twin: bool,
}

/// The list of a part.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct PartList {
    /// name of the part
    pub part: String,
    /// form of its files
    pub form: PartForm,
    /// SHA-256 of the settings by which it was made
    pub settings: String,
    /// its logs
    pub logs: Vec<Listed>,
}

/// Why parts cannot be read or written.
#[derive(Debug, thiserror::Error)]
pub enum PartsError {
    /// the system says so
    #[error("{file}: {error}")]
    File {
        /// which file or folder
        file: String,
        /// why
        error: io::Error,
    },
    /// a file is damaged
    #[error("{file}: {error}")]
    Table {
        /// which file
        file: String,
        /// why
        error: TableError,
    },
    /// parts that other settings made
    #[error(
        "{folder}: expected rows by the same settings and program, got part {part} of others; give another --out"
    )]
    OtherSettings {
        /// the folder
        folder: String,
        /// one of its parts
        part: String,
    },
    /// nothing of a fleet is there
    #[error("{folder}: expected a folder that `mavid fleet ... --out` wrote, got none of its parts")]
    Nothing {
        /// the folder
        folder: String,
    },
    /// the store cannot be spoken with
    #[error(transparent)]
    Store(#[from] StoreError),
}

/// A folder of parts.
#[derive(Debug, Clone)]
pub struct PartsFolder {
    place: Place,
}

impl PartsFolder {
    /// The folder of a path or of an address in a store, whether anything is in it or not.
    ///
    /// # Errors
    /// [`PartsError::Store`] where it is an address and its store cannot be opened.
    pub fn open(given: &Path) -> Result<Self, PartsError> {
        Ok(Self { place: Place::open(given)? })
    }

    /// The folder as messages call it.
    #[must_use]
    pub fn name(&self) -> String {
        self.place.name()
    }

    /// Writes a file beside the tables.
    ///
    /// # Errors
    /// [`PartsError::File`].
    pub fn write(&self, name: &str, bytes: Vec<u8>) -> Result<(), PartsError> {
        self.place.write(name, bytes).map_err(|error| self.failed(name, error))
    }

    fn failed(&self, name: &str, error: io::Error) -> PartsError {
        PartsError::File { file: self.place.name_of(name), error }
    }

    /// The lists of all finished parts, by their names.
    ///
    /// # Errors
    /// [`PartsError::File`] where one cannot be read.
    pub fn lists(&self) -> Result<Vec<PartList>, PartsError> {
        let mut names = self.place.names(LISTS).map_err(|error| self.failed(LISTS, error))?;
        names.retain(|name| name.ends_with(".json"));
        let read = |name: &String| {
            let name = format!("{LISTS}/{name}");
            let bytes = self.place.read(&name).map_err(|error| self.failed(&name, error))?;
            serde_json::from_slice(&bytes).map_err(|error| self.failed(&name, io::Error::other(error)))
        };
        names.iter().map(read).collect()
    }

    /// Writes a part: its tables, then its list. The rows are in the order of `logs`.
    ///
    /// # Errors
    /// [`PartsError`] where a file cannot be written.
    pub fn write_part(
        &self,
        (rows, logs): (&LogRows, Vec<Listed>),
        (form, settings, shard): (PartForm, &str, Shard),
    ) -> Result<PartList, PartsError> {
        let mut hasher = Sha256::new();
        hasher.update(settings.as_bytes());
        logs.iter().for_each(|log| hasher.update(log.sha256.as_bytes()));
        let hash = hexadecimal(&hasher.finalize());
        let part = format!("part-{}{}", shard.label(), &hash[..16]);
        macro_rules! each {
            ($field:ident, $row:ty) => {
                // an empty file of a table is still one of its parts: a reader then knows the columns
                let name = file(<$row>::TABLE, &part, form);
                let bytes = form
                    .bytes(&rows.$field)
                    .map_err(|error| PartsError::Table { file: self.place.name_of(&name), error })?;
                self.write(&name, bytes)?;
            };
        }
        each_table!(each);
        let list = PartList { part, form, settings: settings.to_owned(), logs };
        let name = format!("{LISTS}/{}.json", list.part);
        let text = text::json_line(&list).map_err(|error| self.failed(&name, io::Error::other(error)))?;
        self.write(&name, text.into_bytes())?;
        Ok(list)
    }

    /// Removes the files of this shard's parts that were begun and not finished, and what was kept of logs that are in a part since.
    ///
    /// # Errors
    /// [`PartsError::File`] where one cannot be removed.
    pub fn remove_unfinished(&self, lists: &[PartList], shard: Shard) -> Result<(), PartsError> {
        let head = format!("part-{}", shard.label());
        // a part of all logs has a hash behind its head, and none of a shard's
        let is_own = |name: &str| {
            name.strip_prefix(&head)
                .is_some_and(|rest| rest.chars().take(16).all(|letter| letter.is_ascii_hexdigit()))
        };
        let is_finished = |name: &str| lists.iter().any(|list| name.starts_with(&list.part));
        macro_rules! each {
            ($field:ident, $row:ty) => {
                let table = <$row>::TABLE;
                for name in self.place.names(table).map_err(|error| self.failed(table, error))? {
                    if is_own(&name) && !is_finished(&name) {
                        let name = format!("{table}/{name}");
                        self.place.remove(&name).map_err(|error| self.failed(&name, error))?;
                    }
                }
            };
        }
        each_table!(each);
        let listed: HashSet<&str> =
            lists.iter().flat_map(|list| &list.logs).map(|log| log.sha256.as_str()).collect();
        for name in self.place.names(WORK).map_err(|error| self.failed(WORK, error))? {
            if name.split_once('-').is_some_and(|(key, _)| listed.contains(key)) {
                let name = format!("{WORK}/{name}");
                self.place.remove(&name).map_err(|error| self.failed(&name, error))?;
            }
        }
        Ok(())
    }

    /// The rows of a log that is in no part yet, as an earlier run left them.
    #[must_use]
    pub fn kept(&self, key: &str, settings: &str) -> Option<String> {
        self.place.read(&work_file(key, settings)).ok().and_then(|bytes| String::from_utf8(bytes).ok())
    }

    /// Keeps the rows of a log that is in no part yet.
    ///
    /// # Errors
    /// [`PartsError::File`].
    pub fn keep(&self, (key, settings): (&str, &str), text: String) -> Result<(), PartsError> {
        self.write(&work_file(key, settings), text.into_bytes())
    }

    /// Removes what was kept of a log. What stays is not read again once its log is in a part.
    pub fn forget(&self, key: &str, settings: &str) {
        drop(self.place.remove(&work_file(key, settings)));
    }

    /// All rows of all finished parts. A log that several parts have, as shards that found the same bytes at two addresses write it, is
    /// taken once: by the first of its addresses.
    ///
    /// # Errors
    /// [`PartsError`] where a part cannot be read, or there is none.
    pub fn read_all(&self) -> Result<LogRows, PartsError> {
        let lists = self.lists()?;
        if lists.is_empty() {
            return self.read_unlisted();
        }
        let mut first: BTreeMap<&str, (&str, &str)> = BTreeMap::new();
        for list in &lists {
            for log in list.logs.iter().filter(|log| !log.twin) {
                let own = (log.uri.as_str(), list.part.as_str());
                first.entry(&log.sha256).and_modify(|found| *found = own.min(*found)).or_insert(own);
            }
        }
        let mut all = LogRows::default();
        for list in &lists {
            macro_rules! each {
                ($field:ident, $row:ty) => {
                    let name = file(<$row>::TABLE, &list.part, list.form);
                    let bytes = self.place.read(&name).map_err(|error| self.failed(&name, error))?;
                    let rows: Vec<$row> = list
                        .form
                        .rows(bytes)
                        .map_err(|error| PartsError::Table { file: self.place.name_of(&name), error })?;
                    let is_first =
                        |row: &$row| first.get(row.log.as_str()).is_some_and(|(_, part)| *part == list.part);
                    all.$field.extend(rows.into_iter().filter(is_first));
                };
            }
            each_table!(each);
        }
        Ok(all)
    }
}

impl PartsFolder {
    /// All rows of tables that an engine wrote with the function for one log: files without lists, each log once.
    fn read_unlisted(&self) -> Result<LogRows, PartsError> {
        let mut all = LogRows::default();
        macro_rules! each {
            ($field:ident, $row:ty) => {
                let table = <$row>::TABLE;
                for name in self.place.names(table).map_err(|error| self.failed(table, error))? {
                    let Some(form) = PartForm::of_name(&name) else { continue };
                    let name = format!("{table}/{name}");
                    let bytes = self.place.read(&name).map_err(|error| self.failed(&name, error))?;
                    let rows: Vec<$row> = form
                        .rows(bytes)
                        .map_err(|error| PartsError::Table { file: self.place.name_of(&name), error })?;
                    all.$field.extend(rows);
                }
            };
        }
        each_table!(each);
        if all.logs.is_empty() { Err(PartsError::Nothing { folder: self.name() }) } else { Ok(all) }
    }
}

/// Name of a table's file of a part.
fn file(table: &str, part: &str, form: PartForm) -> String {
    format!("{table}/{part}.{}", form.ending())
}

/// Name of the file of rows of a log that is in no part yet.
fn work_file(key: &str, settings: &str) -> String {
    format!("{WORK}/{key}-{}.rows", settings.get(..8).unwrap_or(settings))
}
