//! A bar on standard error for files that take a while.

use std::path::Path;

use indicatif::{ProgressBar, ProgressStyle};

/// Smaller files are read before a bar could be seen.
const BAR_FROM_BYTES: u64 = 32 << 20;

/// A bar over a file's bytes; a hidden one for small files.
pub fn of_file(path: &Path) -> ProgressBar {
    let bytes = std::fs::metadata(path).map_or(0, |metadata| metadata.len());
    if bytes < BAR_FROM_BYTES {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(bytes);
    match ProgressStyle::with_template("reading {wide_bar} {bytes} of {total_bytes}, about {eta} left") {
        Ok(style) => bar.with_style(style),
        Err(_) => bar,
    }
}
