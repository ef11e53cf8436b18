//! Why signing cannot be used.

use std::path::PathBuf;

use crate::text;

/// Why signing cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum SigningError {
    /// a file cannot be read or written
    #[error("cannot {what} {}: {source}", text::path(&path))]
    File {
        /// read or write
        what: &'static str,
        /// which file
        path: PathBuf,
        /// what the system said
        source: std::io::Error,
    },
    /// the key file holds no key
    #[error("expected a key (32 bytes, 64 hexadecimal digits, or a passphrase) in {}, got {got}", text::path(&path))]
    Key {
        /// which file
        path: PathBuf,
        /// what is in it, without telling it but for a wrong letter
        got: String,
    },
    /// the file of times is damaged
    #[error(
        "expected {expected} in line {line} of {}, got `{got}`: without the times, old frames could be played \
         back; delete the file to accept that",
        text::path(&path)
    )]
    Times {
        /// which file
        path: PathBuf,
        /// counted from 1
        line: usize,
        /// what should be there
        expected: &'static str,
        /// what is there
        got: String,
    },
}
