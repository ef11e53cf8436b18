//! Where the bytes of a log are.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use super::error::LogError;
use crate::text;

/// So many bytes tell a format. A telemetry log may begin with almost as many damaged ones.
const HEAD_BYTES: u64 = (1 << 20) + (1 << 12);

/// Letters of a pattern for names of files.
const PATTERN: [char; 3] = ['*', '?', '['];

/// Bytes that can be read from their start more than once: a path (`&Path`, `&str`), or bytes in memory with the name
/// that messages call them by.
#[derive(Debug, Clone, Copy)]
pub enum Input<'a> {
    /// a file
    File(&'a Path),
    /// bytes in memory
    Bytes {
        /// as messages call them
        name: &'a str,
        /// all of them
        bytes: &'a [u8],
    },
}

impl<'a, P: AsRef<Path> + ?Sized> From<&'a P> for Input<'a> {
    fn from(path: &'a P) -> Self {
        Self::File(path.as_ref())
    }
}

impl<'a> Input<'a> {
    /// As messages call it.
    #[must_use]
    pub fn name(&self) -> String {
        match self {
            Self::File(path) => text::path(path),
            Self::Bytes { name, .. } => (*name).to_owned(),
        }
    }

    /// A reader from the first byte on. It does no buffering.
    ///
    /// # Errors
    /// The file cannot be opened.
    pub fn open(&self) -> Result<Box<dyn Read + Send + 'a>, LogError> {
        match *self {
            Self::File(path) => match File::open(path) {
                Ok(file) => Ok(Box::new(file)),
                Err(source) => Err(LogError::Open { path: path.to_owned(), source }),
            },
            Self::Bytes { bytes, .. } => Ok(Box::new(bytes)),
        }
    }

    /// Its first bytes, a megabyte or all there are.
    ///
    /// # Errors
    /// The file cannot be opened or read.
    pub(super) fn head(&self) -> Result<Vec<u8>, LogError> {
        let mut head = Vec::new();
        let read = self.open()?.take(HEAD_BYTES).read_to_end(&mut head);
        read.map_err(|source| LogError::Read { offset: head.len() as u64, source })?;
        Ok(head)
    }

    /// What the path leads to, where that cannot be read as a log, and what to do about it. A log is read more than once.
    pub(super) fn no_file(&self) -> Option<(&'static str, &'static str)> {
        let Self::File(path) = self else { return None };
        match path.metadata() {
            Ok(found) if found.is_dir() => Some(("a folder", "give one of the logs in it")),
            Ok(found) if found.is_file() => None,
            Ok(_) => {
                Some(("a pipe or a device, which can be read only once", "save it as a file, and give that"))
            }
            // a shell hands on as it is what it finds no file for
            Err(_) if text::path(path).contains(PATTERN) => {
                Some(("a pattern that no file matches", "check the folder and the ending"))
            }
            Err(_) => None,
        }
    }
}
