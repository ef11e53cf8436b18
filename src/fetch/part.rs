//! A log that is being fetched: a file beside its place, and what tells whose bytes it holds.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::fetched::{Fetched, Sum};
use super::name::local_name;
use super::remote::{Place, RemoteLog};
use crate::files::write_whole;
use crate::text;
use crate::wire::file_transfer::FileSum;

/// Bytes at the end of a part that come once more and are compared.
pub(super) const COMPARED: usize = 4096;
/// Numbers that are tried for a name that is taken.
const NUMBERS: u32 = 1000;

/// Why a log is not written.
#[derive(Debug, thiserror::Error)]
pub enum PartError {
    /// the disk, or its permissions
    #[error("cannot write {path}: {source}")]
    Write {
        /// which file
        path: String,
        /// what the system says
        source: io::Error,
    },
    /// bytes of an earlier download are not those that come
    #[error(
        "expected to go on with {path}, but its last bytes are not those of the vehicle's log: it is of another log; \
         move it away or give another folder"
    )]
    Another {
        /// which file
        path: String,
    },
    /// other bytes came than the vehicle has
    #[error(
        "expected bytes whose checksum is {stated:#010x}, as the vehicle calculates it; those that came have {came:#010x}: \
         they are thrown away, and the next download begins anew"
    )]
    Sum {
        /// by the vehicle
        stated: u32,
        /// of what came
        came: u32,
    },
    /// all names are taken
    #[error("expected a free name for {path}, {NUMBERS} of that name exist")]
    Taken {
        /// the name
        path: String,
    },
}

/// Whose bytes a part holds.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Identity {
    /// number of the vehicle's processor, or its system id
    vehicle: String,
    /// path, or number
    log: String,
    bytes: u64,
    time_s: Option<u32>,
}

/// How a log was checked.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Checked {
    /// by its length and the vehicle's checksum
    Sum(u32),
    /// by its length: the vehicle calculates no checksum
    Length,
    /// by its length: the vehicle offers a checksum but did not answer
    NoAnswer,
    /// by its length: the vehicle writes on, and has so many bytes now
    Grown(u64),
}

/// How a download begins.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Begun {
    /// from the first byte on
    Anew,
    /// after so many bytes of an earlier one
    After(u64),
}

/// A log that is being fetched.
#[derive(Debug)]
pub struct Part {
    file: File,
    path: PathBuf,
    beside: PathBuf,
    name: String,
    folder: PathBuf,
    /// bytes at the end of an earlier download that come once more
    compared: Vec<u8>,
    begun: Begun,
    length: u64,
}

fn failed(path: &Path) -> impl Fn(io::Error) -> PartError + '_ {
    move |source| PartError::Write { path: text::path(&path), source }
}

/// The name of a log in a folder.
fn name_of(log: &RemoteLog, ending: &str) -> String {
    match &log.place {
        Place::Path(path) => local_name(path),
        Place::Number(number) => format!("log_{number:05}{ending}"),
    }
}

impl Part {
    /// Whether the folder holds a part of this log, by its name.
    #[must_use]
    pub fn is_begun(folder: &Path, log: &RemoteLog, ending: &str) -> bool {
        folder.join(format!("{}.part", name_of(log, ending))).is_file()
    }

    /// Begins, or goes on with what an earlier download of the same log of the same vehicle left in the folder. `ending` is
    /// that of logs which have no name of their own.
    ///
    /// # Errors
    /// The folder cannot be written to.
    pub fn open(folder: &Path, vehicle: &str, log: &RemoteLog, ending: &str) -> Result<Self, PartError> {
        let name = name_of(log, ending);
        let path = folder.join(format!("{name}.part"));
        let beside = folder.join(format!("{name}.part.toml"));
        let identity = Identity {
            vehicle: vehicle.to_owned(),
            log: match &log.place {
                Place::Path(path) => text::clean(path),
                Place::Number(number) => number.to_string(),
            },
            bytes: log.size,
            time_s: log.time_s,
        };
        let goes_on = fs::read_to_string(&beside)
            .ok()
            .and_then(|text| toml::from_str::<Identity>(&text).ok())
            // the vehicle may have written on meanwhile
            .is_some_and(|known| {
                Identity { bytes: identity.bytes, ..known.clone() } == identity
                    && known.bytes <= identity.bytes
            });
        // nothing is followed that somebody else put there
        let is_file = fs::symlink_metadata(&path).is_ok_and(|found| found.is_file());
        if !is_file && fs::symlink_metadata(&path).is_ok() {
            return Err(PartError::Taken { path: text::path(&path) });
        }
        let mut file = OpenOptions::new()
            .read(true)
            .write(true)
            .create(true)
            .truncate(!goes_on)
            .open(&path)
            .map_err(failed(&path))?;
        let document = toml::to_string(&identity).unwrap_or_default();
        write_whole(&beside, document.as_bytes()).map_err(failed(&beside))?;
        let had = file.metadata().map_err(failed(&path))?.len();
        let length = if had > log.size { 0 } else { had.saturating_sub(COMPARED as u64) };
        let mut compared = Vec::new();
        if had <= log.size {
            file.seek(SeekFrom::Start(length)).map_err(failed(&path))?;
            file.read_to_end(&mut compared).map_err(failed(&path))?;
        }
        file.seek(SeekFrom::Start(length)).map_err(failed(&path))?;
        let begun = if length > 0 { Begun::After(length) } else { Begun::Anew };
        if begun == Begun::Anew {
            compared.clear();
        }
        Ok(Self { file, path, beside, name, folder: folder.to_owned(), compared, begun, length })
    }

    /// How it begins.
    #[must_use]
    pub fn begun(&self) -> Begun {
        self.begun
    }

    /// Bytes from the first on.
    #[must_use]
    pub fn length(&self) -> u64 {
        self.length
    }

    /// The file as it is now.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Takes the next bytes.
    ///
    /// # Errors
    /// They are not those of the earlier download, or the disk takes none.
    pub fn append(&mut self, bytes: &[u8]) -> Result<(), PartError> {
        let again = self.compared.len().min(bytes.len());
        let known: Vec<u8> = self.compared.drain(..again).collect();
        if known != bytes[..again] {
            return Err(PartError::Another { path: text::path(&self.path) });
        }
        self.file.write_all(bytes).map_err(failed(&self.path))?;
        self.length += bytes.len() as u64;
        Ok(())
    }

    /// The checksum of all bytes, as they are on the disk.
    ///
    /// # Errors
    /// The file cannot be read.
    fn sum(&mut self) -> Result<u32, PartError> {
        self.file.seek(SeekFrom::Start(0)).map_err(failed(&self.path))?;
        let (mut sum, mut buffer) = (FileSum::default(), vec![0; 1 << 16]);
        let mut left = self.length;
        while left > 0 {
            let most = usize::try_from(left).unwrap_or(usize::MAX).min(buffer.len());
            let count = self.file.read(&mut buffer[..most]).map_err(failed(&self.path))?;
            if count == 0 {
                break;
            }
            sum.update(&buffer[..count]);
            left -= count as u64;
        }
        Ok(sum.value())
    }

    /// Holds what came to what the vehicle says of it. What is not what the vehicle has is removed.
    ///
    /// # Errors
    /// It is not, or cannot be read.
    pub fn check(&mut self, fetched: &Fetched) -> Result<Checked, PartError> {
        match (fetched.grown_to, fetched.sum) {
            (Some(bytes), _) => Ok(Checked::Grown(bytes)),
            (None, Sum::NotOffered) => Ok(Checked::Length),
            (None, Sum::Unanswered) => Ok(Checked::NoAnswer),
            (None, Sum::Is(stated)) => {
                let came = self.sum()?;
                if came == stated {
                    return Ok(Checked::Sum(stated));
                }
                // one that cannot be removed is compared when it is gone on with
                let _ = fs::remove_file(&self.path);
                let _ = fs::remove_file(&self.beside);
                Err(PartError::Sum { stated, came })
            }
        }
    }

    /// Whole: it gets its name, or the next one that is free. Returns where it is.
    ///
    /// # Errors
    /// The disk does not take it, or every name is taken.
    pub fn finish(self) -> Result<PathBuf, PartError> {
        self.file.set_len(self.length).map_err(failed(&self.path))?;
        self.file.sync_all().map_err(failed(&self.path))?;
        let (stem, ending) = self
            .name
            .rsplit_once('.')
            .map_or((&*self.name, String::new()), |(stem, ending)| (stem, format!(".{ending}")));
        for number in 1..=NUMBERS {
            let numbered = if number == 1 { self.name.clone() } else { format!("{stem}-{number}{ending}") };
            let path = self.folder.join(numbered);
            match publish(&self.path, &path) {
                Ok(()) => {
                    let _ = fs::remove_file(&self.beside);
                    return Ok(path);
                }
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
                Err(source) => return Err(PartError::Write { path: text::path(&path), source }),
            }
        }
        Err(PartError::Taken { path: text::path(&self.folder.join(&self.name)) })
    }
}

/// Gives a file its name; never in the place of another.
fn publish(from: &Path, to: &Path) -> io::Result<()> {
    match fs::hard_link(from, to) {
        Ok(()) => fs::remove_file(from),
        Err(error) if error.kind() == io::ErrorKind::AlreadyExists => Err(error),
        // a file system without links
        Err(_) if fs::symlink_metadata(to).is_ok() => Err(io::ErrorKind::AlreadyExists.into()),
        Err(_) => fs::rename(from, to),
    }
}
