//! The lines of standard error, beside the progress bars that are drawn there.

use std::fs::{File, OpenOptions};
use std::io::{self, IsTerminal, StderrLock, Write};
use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard, PoisonError};

use indicatif::{MultiProgress, ProgressBar};
use mavid::text::{self, to_width};

use super::color::Tone;
use crate::commands::columns::of_terminal;

/// Where lines for people go: standard error, or a file while the terminal shows a picture.
#[derive(Debug, Default)]
pub(super) struct Lines {
    bars: MultiProgress,
    away: Mutex<Option<Away>>,
}

impl Lines {
    /// A line, which is clean already, broken between words where a terminal is narrower. Where standard error is closed there is nobody to tell.
    pub(super) fn write(&self, line: &str) {
        self.write_in(Tone::Plain, line);
    }

    /// The same in a tone, but in a file.
    pub(super) fn write_in(&self, tone: Tone, line: &str) {
        match self.away().as_mut() {
            Some(away) => away.write(line),
            None => self.bars.suspend(|| {
                let columns = of_terminal().filter(|_| io::stderr().is_terminal());
                let lines = columns.map_or_else(|| vec![line.to_owned()], |columns| to_width(line, columns));
                let lines: Vec<String> = lines.iter().map(|line| tone.colored(line)).collect();
                let _ = writeln!(io::stderr().lock(), "{}", lines.join("\n"));
            }),
        }
    }

    /// Draws on standard error, unless a picture is shown there.
    pub(super) fn draw(&self, draw: impl FnOnce(&mut StderrLock<'_>) -> io::Result<()>) {
        let away = self.away();
        if away.is_none() {
            let _ = draw(&mut io::stderr().lock());
        }
    }

    /// A bar among those that lines keep clear of.
    pub(super) fn bar(&self, bar: ProgressBar) -> ProgressBar {
        self.bars.add(bar)
    }

    /// Lines go to the end of this file from now on; it is made with the first.
    pub(super) fn go_away(&self, path: PathBuf) {
        *self.away() = Some(Away { path, file: None, failure: None, missing: 0 });
    }

    /// Lines go to standard error again.
    pub(super) fn come_back(&self) {
        let missing = self.away().take().and_then(|away| away.trouble());
        if let Some(trouble) = missing {
            self.write(&trouble);
        }
    }

    /// A destination is whole at every moment.
    fn away(&self) -> MutexGuard<'_, Option<Away>> {
        self.away.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// A file that takes the lines.
#[derive(Debug)]
struct Away {
    path: PathBuf,
    file: Option<File>,
    failure: Option<io::Error>,
    /// lines that it did not take
    missing: u64,
}

impl Away {
    fn write(&mut self, line: &str) {
        if let Err(error) = self.try_write(line) {
            self.missing += 1;
            self.failure = Some(error);
        }
    }

    fn try_write(&mut self, line: &str) -> io::Result<()> {
        let mut file = match self.file.take() {
            Some(file) => file,
            None => OpenOptions::new().create(true).append(true).open(&self.path)?,
        };
        let written = file.write_all(format!("{line}\n").as_bytes());
        self.file = Some(file);
        written
    }

    fn trouble(&self) -> Option<String> {
        let (path, failure) = (text::path(&self.path), self.failure.as_ref()?);
        Some(format!("warning: {} lines are missing in {path}: {failure}", self.missing))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn while_a_picture_is_shown_lines_go_to_a_file_and_what_it_does_not_take_is_counted() {
        let folder = std::env::temp_dir().join(format!("mavid_lines_{}", std::process::id()));
        let _ = std::fs::remove_dir_all(&folder);
        std::fs::create_dir_all(&folder).unwrap();
        let (lines, path) = (Lines::default(), folder.join("log.txt"));
        lines.go_away(path.clone());
        assert!(!path.exists(), "no line, no file");
        ["one", "two"].iter().for_each(|line| lines.write(line));
        lines.draw(|_| panic!("a status would tear the picture"));
        lines.come_back();
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "one\ntwo\n");
        let mut nowhere = Away { path: folder.join("none").join("x"), file: None, failure: None, missing: 0 };
        ["one", "two"].iter().for_each(|line| nowhere.write(line));
        let trouble = nowhere.trouble().unwrap();
        assert!(trouble.contains("2 lines are missing in"), "{trouble}");
        std::fs::remove_dir_all(&folder).unwrap();
    }
}
