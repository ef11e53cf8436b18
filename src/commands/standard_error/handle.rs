//! Standard error, as the verbs use it.

use std::io::{self, IsTerminal};
use std::path::PathBuf;
use std::sync::Arc;

use indicatif::ProgressBar;
use mavid::text;

use super::color::Tone;
use super::lines::Lines;
use super::teller::Teller;
use crate::commands::CommandError;
use crate::commands::last_word::last_word;

/// Standard error. Clones share it.
#[derive(Debug, Clone)]
pub struct StandardError {
    lines: Arc<Lines>,
    /// of a verb that talks to vehicles
    teller: Option<Arc<Teller>>,
    is_quiet: bool,
    has_colors: bool,
}

impl StandardError {
    /// Of a verb that talks to vehicles, or of another; a quiet one shows errors and nothing else.
    pub(super) fn new(is_live: bool, is_quiet: bool, has_colors: bool) -> Result<Self, CommandError> {
        let lines = Arc::new(Lines::default());
        let teller = is_live.then(|| Teller::start(lines.clone()).map(Arc::new)).transpose();
        let teller =
            teller.map_err(|error| CommandError::Failure(format!("cannot start a thread: {error}")))?;
        Ok(Self { lines, teller, is_quiet, has_colors })
    }

    /// It shows errors and nothing else.
    pub fn is_quiet(&self) -> bool {
        self.is_quiet
    }

    /// Something can be drawn on it, and may be.
    pub fn can_draw(&self) -> bool {
        !self.is_quiet && io::stderr().is_terminal()
    }

    /// The bar, drawn where that is possible and wanted.
    pub fn bar(&self, bar: ProgressBar) -> ProgressBar {
        if self.can_draw() { self.lines.bar(bar) } else { ProgressBar::hidden() }
    }

    /// A message, written when this returns.
    pub(super) fn message(&self, text: &str, tone: Tone) {
        let tone = if self.has_colors { tone } else { Tone::Plain };
        self.lines.write_in(tone, &text::clean(text));
    }

    /// A log line. A verb that talks to vehicles does not wait for it.
    pub(super) fn log(&self, text: &str) {
        let line = text::clean(text);
        match &self.teller {
            Some(teller) => teller.line(line),
            None => self.lines.write(&line),
        }
    }

    /// A message for which a verb that talks to vehicles does not wait.
    pub fn tell(&self, text: &str) {
        if !self.is_quiet {
            self.log(text);
        }
    }

    /// How things stand, in place of what was said so last; nothing where there is no terminal.
    pub fn status(&self, text: &str) {
        if let (true, Some(teller)) = (self.can_draw(), &self.teller) {
            teller.status(text);
        }
    }

    /// Waits until all is told.
    pub fn flush(&self) {
        if let Some(teller) = &self.teller {
            teller.flush();
        }
    }

    /// The same, at the end of the program: not for long, where standard error takes nothing.
    pub fn finish(&self) {
        if let Some(teller) = self.teller.clone() {
            last_word(move || teller.flush());
        }
    }

    /// For as long as what this returns lives, lines go to the end of a file: the terminal shows a picture.
    pub fn away(&self, path: PathBuf) -> Away<'_> {
        self.lines.go_away(path);
        Away(&self.lines)
    }
}

/// Lines go to a file for as long as this lives.
#[derive(Debug)]
pub struct Away<'a>(&'a Lines);

impl Drop for Away<'_> {
    fn drop(&mut self) {
        self.0.come_back();
    }
}
