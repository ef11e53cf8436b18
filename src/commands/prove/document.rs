//! The JSON document of `prove`.

use std::path::PathBuf;

use serde::Serialize;

use super::case::Verdict;
use super::score::{Scored, Summary};

/// What was found, sealed and scored.
#[derive(Debug, Serialize)]
pub(super) struct Document {
    pub(super) schema: u32,
    /// of the verdict files, each hashed, in the order of their names
    pub(super) sealed_sha256: String,
    pub(super) verdicts: PathBuf,
    pub(super) summary: Option<Summary>,
    pub(super) cases: Vec<Scored>,
    /// what was found where there are no answers
    pub(super) unscored: Vec<Verdict>,
    pub(super) notes: Vec<String>,
}
