//! What a log is known by: the hash of its bytes.

use std::fs::{self, File};
use std::path::Path;

use super::limits::Bounds;
use mavid::fleet::hexadecimal;
use sha2::{Digest, Sha256};

/// SHA-256 of the bytes of a log; or why it is not read.
pub fn identity(path: &Path, bounds: &Bounds) -> Result<String, String> {
    let metadata = fs::metadata(path).map_err(|error| format!("expected the file of a log: {error}"))?;
    if !metadata.is_file() {
        return Err("expected the file of a log, got a folder or a device".to_owned());
    }
    match bounds.refused(metadata.len()) {
        Some(why) => Err(why),
        None => hash(path).map_err(|error| format!("expected a log that can be read: {error}")),
    }
}

/// SHA-256 of a file, hexadecimal.
pub fn hash(path: &Path) -> std::io::Result<String> {
    let mut hasher = Sha256::new();
    std::io::copy(&mut File::open(path)?, &mut hasher)?;
    Ok(hexadecimal(&hasher.finalize()))
}
