//! Where logs are: files, folders, patterns, and addresses in object stores.

use std::fs;
use std::path::{Path, PathBuf};

use super::task::hexadecimal;
use crate::log::{FORMATS, is_named_like_a_log};
use crate::store::{Address, Store, StoreError, Stored, is_remote};
use crate::text;
use glob::{MatchOptions, Pattern};
use sha2::{Digest, Sha256};

/// One log.
#[derive(Debug, Clone)]
pub struct Source {
    /// as it is named in the tables
    pub uri: String,
    /// where its bytes are
    pub at: At,
}

/// Where the bytes of a log are.
#[derive(Debug, Clone)]
pub enum At {
    /// a file of this computer
    File(PathBuf),
    /// a file in a store
    Stored(Store, Stored),
}

/// Why a source gives no logs.
#[derive(Debug, thiserror::Error)]
pub enum SourceError {
    /// nothing there, or no log
    #[error("{given}: expected {expected}, got {came}")]
    Given {
        /// as it was given
        given: String,
        /// what was expected
        expected: &'static str,
        /// what is there
        came: String,
    },
    /// a store says why
    #[error(transparent)]
    Store(#[from] StoreError),
}

/// The logs of all that was given, each once, in the order of their names. Of folders and patterns, files are taken that are named like
/// logs. A file that is named itself is always taken.
///
/// # Errors
/// [`SourceError`] of the first that is not there or holds no log.
pub fn sources(given: &[String]) -> Result<Vec<Source>, SourceError> {
    let mut all = Vec::new();
    for one in given {
        let before = all.len();
        take(one, &mut all)?;
        if all.len() == before {
            let endings: Vec<&str> = FORMATS.iter().map(|format| format.ending).collect();
            let came = format!("no file that ends in .{}", endings.join(", ."));
            return Err(refused(one, "logs", came));
        }
    }
    all.sort_by(|a, b| a.uri.cmp(&b.uri));
    all.dedup_by(|a, b| a.uri == b.uri);
    Ok(all)
}

fn refused(given: &str, expected: &'static str, came: String) -> SourceError {
    SourceError::Given { given: text::clean(given), expected, came }
}

/// Logs in a store: a file that is named, or what is named like a log in a folder or by a pattern.
fn take_stored(given: &str, all: &mut Vec<Source>) -> Result<(), SourceError> {
    let address = Address::of(given)?;
    let store = Store::open(&address)?;
    let source =
        |stored: Stored| Source { uri: address.uri_of(&stored.name), at: At::Stored(store.clone(), stored) };
    if let Some((below, pattern)) = address.pattern() {
        let pattern =
            Pattern::new(&pattern).map_err(|error| refused(given, "a pattern", error.to_string()))?;
        // as of paths: an asterisk stays within a folder, and two go through all
        let options = MatchOptions { require_literal_separator: true, ..MatchOptions::new() };
        let found = store.list(&below.name)?.into_iter();
        all.extend(found.filter(|stored| pattern.matches_with(&stored.name, options)).map(source));
        return Ok(());
    }
    let named = if address.is_folder { None } else { store.head(&address.name)? };
    match named {
        Some(stored) => all.push(source(stored)),
        // few web servers list folders: none is asked to that is not called one
        None if address.is_of_web() && !address.is_folder => {
            return Err(StoreError::Nothing { address: text::clean(given) }.into());
        }
        None => {
            let found = store.list(&address.name)?.into_iter();
            all.extend(found.filter(|stored| is_named_like_a_log(Path::new(&stored.name))).map(source));
        }
    }
    Ok(())
}

fn take(given: &str, all: &mut Vec<Source>) -> Result<(), SourceError> {
    if is_remote(given) {
        return take_stored(given, all);
    }
    let path = Path::new(given.strip_prefix("file://").unwrap_or(given));
    if path.is_dir() {
        return walk(path, all)
            .map_err(|error| refused(given, "a folder that can be read", error.to_string()));
    }
    if path.is_file() {
        all.push(source(path));
        return Ok(());
    }
    if path.exists() {
        let came = "a pipe or a device, which can be read only once";
        return Err(refused(given, "a file, a folder or a pattern", came.to_owned()));
    }
    if let Some((scheme, _)) = given.split_once("://") {
        let came = format!("an address of `{}`, which this program does not read", text::clean(scheme));
        return Err(refused(given, "a file, a folder or a pattern", came));
    }
    let found = glob::glob(given).map_err(|error| refused(given, "a pattern", error.to_string()))?;
    // what cannot be read below a pattern is no log of it
    for path in found.flatten() {
        if path.is_dir() {
            walk(&path, all)
                .map_err(|error| refused(given, "a folder that can be read", error.to_string()))?;
        } else if path.is_file() {
            all.push(source(&path));
        }
    }
    if all.is_empty() && !given.contains(['*', '?', '[']) {
        return Err(refused(given, "a file, a folder or a pattern", "nothing of that name".to_owned()));
    }
    Ok(())
}

fn source(path: &Path) -> Source {
    Source { uri: text::path(&path), at: At::File(path.to_owned()) }
}

/// All logs below a folder. Links to folders are not followed, and what is neither a file nor a link to one is left out: a pipe never
/// ends.
fn walk(folder: &Path, all: &mut Vec<Source>) -> std::io::Result<()> {
    let mut open = vec![folder.to_owned()];
    while let Some(folder) = open.pop() {
        let entries = match fs::read_dir(&folder) {
            // a folder inside that cannot be read is not the whole
            Err(_) if all.len() + open.len() > 0 => continue,
            read => read?,
        };
        for entry in entries.flatten() {
            let path = entry.path();
            match entry.file_type() {
                Ok(kind) if kind.is_dir() => open.push(path),
                Ok(_) if is_named_like_a_log(&path) && path.is_file() => all.push(source(&path)),
                _ => (),
            }
        }
    }
    Ok(())
}

/// Which part of the logs one of several runs takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shard {
    /// from 0
    pub index: u32,
    /// of so many
    pub count: u32,
}

impl Shard {
    /// All of them.
    pub const WHOLE: Self = Self { index: 0, count: 1 };

    /// A shard of a count.
    ///
    /// # Errors
    /// What was expected, where there is no such shard.
    pub fn new(index: u32, count: u32) -> Result<Self, String> {
        if index < count {
            Ok(Self { index, count })
        } else {
            Err(format!("expected a shard from 0 to {}, got {index}", i64::from(count) - 1))
        }
    }

    /// Whether a log is one of its own: by the hash of its address, so that logs that come later move no other.
    #[must_use]
    pub fn has(&self, uri: &str) -> bool {
        let hash = Sha256::digest(uri.as_bytes());
        let number = hash.iter().take(8).fold(0_u64, |number, byte| number << 8 | u64::from(*byte));
        number % u64::from(self.count.max(1)) == u64::from(self.index)
    }

    /// In the names of its parts; empty for all of them.
    #[must_use]
    pub fn label(&self) -> String {
        if *self == Self::WHOLE { String::new() } else { format!("{}of{}-", self.index, self.count) }
    }
}

impl std::str::FromStr for Shard {
    type Err = String;

    fn from_str(given: &str) -> Result<Self, String> {
        let parsed =
            given.split_once('/').and_then(|(index, count)| Some((index.parse().ok()?, count.parse().ok()?)));
        let (index, count) =
            parsed.ok_or_else(|| format!("expected I/N as 0/8, got `{}`", text::clean(given)))?;
        Self::new(index, count)
    }
}

/// The name of a log that was not read: of its address and size.
#[must_use]
pub fn unread_name(uri: &str, bytes: u64) -> String {
    hexadecimal(&Sha256::digest(format!("not read: {uri} {bytes}").as_bytes()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_folders_and_patterns_give_each_log_once() {
        let folder = std::env::temp_dir().join(format!("mavid-sources-{}", std::process::id()));
        fs::create_dir_all(folder.join("deep/er")).unwrap();
        for name in ["a.tlog", "b.BIN", "deep/er/c.ulg", "notes.txt", "deep/vehicle.toml"] {
            fs::write(folder.join(name), "x").unwrap();
        }
        let at = |name: &str| folder.join(name).display().to_string();
        let names = |given: &[String]| {
            let found = sources(given).unwrap();
            found.iter().map(|source| source.uri.rsplit('/').next().unwrap().to_owned()).collect::<Vec<_>>()
        };
        assert_eq!(names(&[at("")]), ["a.tlog", "b.BIN", "c.ulg"]);
        assert_eq!(names(&[at("**/*.ulg"), at("a.tlog"), at("a.tlog")]), ["a.tlog", "c.ulg"]);
        // a file that is named is taken whatever its ending
        assert_eq!(names(&[at("notes.txt")]), ["notes.txt"]);
        for (given, said) in [
            (at("no.tlog"), "got nothing of that name"),
            (at("*.ulg"), "no file that ends in"),
            #[cfg(unix)]
            ("/dev/null".to_owned(), "got a pipe or a device"),
            ("ftp://host/logs".to_owned(), "an address of `ftp`"),
            #[cfg(not(feature = "fleet"))]
            ("s3://bucket/logs".to_owned(), "--features fleet"),
        ] {
            let error = sources(&[given]).unwrap_err().to_string();
            assert!(error.contains(said), "{error}");
        }
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn each_log_is_of_one_shard_and_none_gets_all() {
        let shards: Vec<Shard> = (0..4).map(|index| Shard::new(index, 4).unwrap()).collect();
        let mut counts = [0; 4];
        for log in 0..400 {
            let uri = format!("logs/{log}.ulg");
            let own: Vec<usize> = (0..4).filter(|place| shards[*place].has(&uri)).collect();
            assert_eq!(own.len(), 1);
            counts[own[0]] += 1;
        }
        assert!(counts.iter().all(|count| (60..140).contains(count)), "{counts:?}");
        assert!(Shard::WHOLE.has("any") && "4/4".parse::<Shard>().is_err() && "a".parse::<Shard>().is_err());
        assert_eq!("3/4".parse::<Shard>().unwrap().label(), "3of4-");
    }
}
