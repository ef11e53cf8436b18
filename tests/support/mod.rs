//! What several tests need.

use std::path::PathBuf;

/// The folder of shared recordings; `None`, with a message, where it is not there.
pub fn shared() -> Option<PathBuf> {
    let folder = std::env::var_os("MAVID_SHARED")
        .map_or_else(|| PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../shared"), PathBuf::from);
    let found = folder.is_dir();
    if !found {
        eprintln!("skipped: no folder of shared recordings at {}", folder.display());
    }
    found.then_some(folder)
}
