//! The file of a recording, as results name it.

use serde::Serialize;

/// One recording that went in.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct InputFile {
    /// file name as given, and which flight of it where it holds several
    pub path: String,
    /// SHA-256 of its bytes, hexadecimal
    pub sha256: String,
    /// what was lost on reading: sentence by sentence
    pub losses: Vec<String>,
    /// what else is to be known of it: whose flight it is, what of the log is no flight
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub notes: Vec<String>,
}
