//! The seal on the verdicts: their files, and one hash of all of them.

use std::fmt::Write;
use std::path::Path;

use mavid::text;
use sha2::{Digest, Sha256};

use super::case::Verdict;
use crate::commands::{CommandError, output};

/// Writes every verdict and gives the hash of all of them.
pub(super) fn seal(folder: &Path, verdicts: &[Verdict]) -> Result<String, CommandError> {
    let failed = |path: &Path, error: std::io::Error| {
        CommandError::Failure(format!("cannot write {}: {error}", text::path(&path)))
    };
    std::fs::create_dir_all(folder).map_err(|error| failed(folder, error))?;
    let mut list = String::new();
    for verdict in verdicts {
        let text = output::json_text(verdict)?;
        let path = folder.join(format!("{}.json", verdict.case));
        std::fs::write(&path, &text).map_err(|error| failed(&path, error))?;
        // as `sha256sum` prints it, so that `sha256sum -c` can check the files
        let _ = writeln!(list, "{}  {}.json", hash(text.as_bytes()), verdict.case);
    }
    let path = folder.join("SHA256SUMS");
    std::fs::write(&path, &list).map_err(|error| failed(&path, error))?;
    Ok(hash(list.as_bytes()))
}

fn hash(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    })
}
