//! The seal on the verdicts: their files, and one hash of all of them.

use std::fmt::Write;

use super::case::CaseVerdict;
use crate::text::json_pretty;
use sha2::{Digest, Sha256};

/// The files of all verdicts, and the hash by which a change of any would be seen.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SealedVerdicts {
    /// name and text of each file; the last lists the hashes of the others, as `sha256sum -c` reads them
    pub files: Vec<(String, String)>,
    /// of that list, hexadecimal
    pub sha256: String,
}

/// Seals all verdicts.
///
/// # Errors
/// Where a verdict has no form in JSON.
pub fn seal(verdicts: &[CaseVerdict]) -> serde_json::Result<SealedVerdicts> {
    let mut files = Vec::with_capacity(verdicts.len() + 1);
    let mut list = String::new();
    for verdict in verdicts {
        let (name, text) = (format!("{}.json", verdict.case), json_pretty(verdict)?);
        let _ = writeln!(list, "{}  {name}", hash(text.as_bytes()));
        files.push((name, text));
    }
    let sha256 = hash(list.as_bytes());
    files.push(("SHA256SUMS".to_owned(), list));
    Ok(SealedVerdicts { files, sha256 })
}

fn hash(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    })
}
