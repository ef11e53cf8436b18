//! The parts of a fleet's tables in a folder: `TABLE/part-ID.parquet`, or `.jsonl`. Parts merge by lying beside one another.

use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};

use super::rows::LogRows;
use super::sources::Shard;
use super::task::hexadecimal;
use crate::each_table;
use crate::files::write_whole;
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
    #[error("{}: {error}", text::path(path))]
    File {
        /// which file or folder
        path: PathBuf,
        /// why
        error: io::Error,
    },
    /// a file is damaged
    #[error("{}: {error}", text::path(path))]
    Table {
        /// which file
        path: PathBuf,
        /// why
        error: TableError,
    },
    /// parts that other settings made
    #[error(
        "{}: expected rows by the same settings and program, got part {part} of others; give another --out",
        text::path(path)
    )]
    OtherSettings {
        /// the folder
        path: PathBuf,
        /// one of its parts
        part: String,
    },
    /// nothing of a fleet is there
    #[error(
        "{}: expected a folder that `mavid fleet ... --out` wrote, got none of its parts",
        text::path(path)
    )]
    Nothing {
        /// the folder
        path: PathBuf,
    },
}

/// A folder of parts.
#[derive(Debug, Clone)]
pub struct PartsFolder {
    root: PathBuf,
}

impl PartsFolder {
    /// A folder, whether it is there or not.
    #[must_use]
    pub fn new(root: &Path) -> Self {
        Self { root: root.to_owned() }
    }

    /// The folder.
    #[must_use]
    pub fn root(&self) -> &Path {
        &self.root
    }

    fn write(path: &Path, bytes: &[u8]) -> Result<(), PartsError> {
        let failed = |error| PartsError::File { path: path.to_owned(), error };
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder).map_err(failed)?;
        }
        write_whole(path, bytes).map_err(failed)
    }

    /// The lists of all finished parts, by their names.
    ///
    /// # Errors
    /// [`PartsError::File`] where one cannot be read.
    pub fn lists(&self) -> Result<Vec<PartList>, PartsError> {
        let folder = self.root.join(LISTS);
        if !folder.is_dir() {
            return Ok(Vec::new());
        }
        let failed = |path: &Path, error| PartsError::File { path: path.to_owned(), error };
        let entries = std::fs::read_dir(&folder).map_err(|error| failed(&folder, error))?;
        let mut paths: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
        paths.retain(|path| path.extension().is_some_and(|ending| ending == "json"));
        paths.sort();
        let read = |path: &PathBuf| {
            let bytes = std::fs::read(path).map_err(|error| failed(path, error))?;
            serde_json::from_slice(&bytes).map_err(|error| failed(path, io::Error::other(error)))
        };
        paths.iter().map(read).collect()
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
                let path = self.file(<$row>::TABLE, &part, form);
                let bytes = form
                    .bytes(&rows.$field)
                    .map_err(|error| PartsError::Table { path: path.clone(), error })?;
                Self::write(&path, &bytes)?;
            };
        }
        each_table!(each);
        let list = PartList { part, form, settings: settings.to_owned(), logs };
        let path = self.root.join(LISTS).join(format!("{}.json", list.part));
        let text = text::json_line(&list)
            .map_err(|error| PartsError::File { path: path.clone(), error: io::Error::other(error) })?;
        Self::write(&path, text.as_bytes())?;
        Ok(list)
    }

    fn file(&self, table: &str, part: &str, form: PartForm) -> PathBuf {
        self.root.join(table).join(format!("{part}.{}", form.ending()))
    }

    /// Removes the files of this shard's parts that were begun and not finished.
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
                let folder = self.root.join(<$row>::TABLE);
                for entry in std::fs::read_dir(&folder).into_iter().flatten().flatten() {
                    // a part has a name of plain letters
                    let Ok(name) = entry.file_name().into_string() else { continue };
                    if is_own(&name) && !is_finished(&name) {
                        let path = entry.path();
                        std::fs::remove_file(&path).map_err(|error| PartsError::File { path, error })?;
                    }
                }
            };
        }
        each_table!(each);
        Ok(())
    }

    /// The file of rows of a log that is in no part yet.
    #[must_use]
    pub fn work_file(&self, sha256: &str, settings: &str) -> PathBuf {
        let short = settings.get(..8).unwrap_or(settings);
        self.root.join(WORK).join(format!("{sha256}-{short}.rows"))
    }

    /// Writes the rows of a log that is in no part yet.
    ///
    /// # Errors
    /// [`PartsError::File`].
    pub fn keep(&self, path: &Path, text: &str) -> Result<(), PartsError> {
        Self::write(path, text.as_bytes())
    }

    /// All rows of all finished parts. A log that several parts have, as shards that found the same bytes at two addresses write it, is
    /// taken once.
    ///
    /// # Errors
    /// [`PartsError`] where a part cannot be read, or there is none.
    pub fn read_all(&self) -> Result<LogRows, PartsError> {
        let lists = self.lists()?;
        if lists.is_empty() {
            return Err(PartsError::Nothing { path: self.root.clone() });
        }
        let mut first: BTreeMap<&str, &str> = BTreeMap::new();
        for list in &lists {
            for log in &list.logs {
                first.entry(&log.sha256).or_insert(&list.part);
            }
        }
        let mut all = LogRows::default();
        for list in &lists {
            macro_rules! each {
                ($field:ident, $row:ty) => {
                    let path = self.file(<$row>::TABLE, &list.part, list.form);
                    let bytes = std::fs::read(&path)
                        .map_err(|error| PartsError::File { path: path.clone(), error })?;
                    let rows: Vec<$row> =
                        list.form.rows(bytes).map_err(|error| PartsError::Table { path, error })?;
                    let is_first = |row: &$row| first.get(row.log.as_str()) == Some(&list.part.as_str());
                    all.$field.extend(rows.into_iter().filter(is_first));
                };
            }
            each_table!(each);
        }
        Ok(all)
    }
}
