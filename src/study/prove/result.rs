//! What was found in all cases, sealed and scored.

use std::path::PathBuf;

use super::case::CaseVerdict;
use super::score::{ProofSummary, ScoredCase};
use crate::note::Note;
use serde::Serialize;

/// What was found in all cases, sealed and scored; as JSON, the document of `prove`.
#[derive(Debug, Serialize)]
pub struct Proof {
    /// of the document
    pub schema: u32,
    /// of the verdict files, each hashed, in the order of their names
    pub sealed_sha256: String,
    /// folder of the verdicts
    pub verdicts: PathBuf,
    /// counts; `None` where no case has an answer
    pub summary: Option<ProofSummary>,
    /// cases with an answer
    pub cases: Vec<ScoredCase>,
    /// what was found where there are no answers
    pub unscored: Vec<CaseVerdict>,
    /// what of the answers was not used
    pub notes: Vec<Note>,
}

impl Proof {
    /// Every case could be explained.
    #[must_use]
    pub fn is_whole(&self) -> bool {
        self.cases.iter().all(|case| case.error.is_none())
            && self.unscored.iter().all(|verdict| verdict.error.is_none())
    }
}
