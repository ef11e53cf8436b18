//! Files of the arguments that can be read once only, as what comes through a pipe.

use std::fs::{self, File};
use std::io::Read;
use std::path::Path;

use mavid::text;

use super::{CommandError, output};

/// More than any file of a vehicle or a trajectory has: who reads what is kept refuses it by its own limit, which is lower.
const MOST_BYTES: u64 = 4 << 20;

/// What comes through a pipe: it can be read once.
pub fn is_read_once(file: &Path) -> bool {
    fs::metadata(file).is_ok_and(|of| !of.is_file() && !of.is_dir())
}

/// Keeps what can be read once in a file, which can be read as often as it is needed.
pub fn keep(from: &Path, to: &Path) -> Result<(), CommandError> {
    let mut content = Vec::new();
    let read = File::open(from).and_then(|file| file.take(MOST_BYTES).read_to_end(&mut content));
    read.map_err(|error| CommandError::Input(format!("cannot read {}: {error}", text::path(from))))?;
    if content.is_empty() {
        let got = "nothing: a pipe of which nothing came";
        return Err(CommandError::Input(format!("{}: expected a file, got {got}", text::path(from))));
    }
    output::bytes(to, &content)
}

#[cfg(all(test, unix))]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test ends where it fails")]
    use super::*;

    #[test]
    fn what_comes_through_a_pipe_is_kept() {
        let folder = std::env::temp_dir().join(format!("mavid-read-once-{}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).unwrap();
        let (pipe, kept) = (folder.join("pipe"), folder.join("kept.toml"));
        assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
        assert!(is_read_once(&pipe) && !is_read_once(&folder) && !is_read_once(&kept));
        for (text, is_kept) in [("name = \"x\"\n", true), ("", false)] {
            let end = pipe.clone();
            let writer = std::thread::spawn(move || fs::write(end, text).unwrap());
            let done = keep(&pipe, &kept);
            writer.join().unwrap();
            assert_eq!(done.is_ok(), is_kept, "{done:?}");
        }
        assert_eq!(fs::read_to_string(&kept).unwrap(), "name = \"x\"\n");
        fs::remove_dir_all(folder).unwrap();
    }
}
