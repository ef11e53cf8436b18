//! The command that takes a run up where it was left.

use std::ffi::{OsStr, OsString};
use std::path::Path;

use mavid::text::{self, shell_word};

/// The program as it is typed.
const PROGRAM: &str = "mavid";
/// The option that names the folder.
const OUT: &str = "--out";

/// The command with these words after the program's name, for the folder of the run: without a folder the same words may mean another.
pub fn again(words: impl Iterator<Item = OsString>, folder: &Path) -> String {
    let mut words: Vec<OsString> = words.collect();
    if !words.iter().any(|word| names_folder(word)) {
        words.extend([OsString::from(OUT), folder.as_os_str().to_owned()]);
    }
    let words = words.iter().map(|word| shell_word(&text::path(word)));
    std::iter::once(PROGRAM.to_owned()).chain(words).collect::<Vec<_>>().join(" ")
}

fn names_folder(word: &OsStr) -> bool {
    let rest = word.as_encoded_bytes().strip_prefix(OUT.as_bytes());
    rest.is_some_and(|rest| rest.is_empty() || rest.starts_with(b"="))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_folder_that_was_made_is_named() {
        let said = |words: &[&str]| again(words.iter().map(OsString::from), Path::new("mavid-demo-2"));
        assert_eq!(said(&["demo"]), "mavid demo --out mavid-demo-2");
        assert_eq!(said(&["run", "--sitl", "--out", "my run"]), "mavid run --sitl --out 'my run'");
        assert_eq!(said(&["run", "--sitl", "--out=here", "--yes"]), "mavid run --sitl --out=here --yes");
    }
}
