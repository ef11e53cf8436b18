//! Messages for a terminal that may take nothing.

use std::time::Duration;

use mavid::note::Note;

use super::last_word::{LAST_WORD, PATIENCE, within};
use super::output;

/// A line for people.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Word {
    /// what happens
    Message(String),
    /// what the user should know
    Warning(String),
    /// why the work is not done
    Error(String),
}

impl From<&Note> for Word {
    fn from(note: &Note) -> Self {
        if note.is_warning() { Self::Warning(note.sentence()) } else { Self::Message(note.sentence()) }
    }
}

impl Word {
    /// Says it.
    pub fn say(&self) {
        match self {
            Self::Message(text) => output::message(text),
            Self::Warning(text) => output::warning(text),
            Self::Error(text) => output::error(text),
        }
    }
}

/// Says what there is to say until standard error takes nothing, and nothing from then on.
#[derive(Debug)]
pub struct Words {
    patience: Duration,
    heard: bool,
}

impl Words {
    /// For a terminal that takes what is said, or that is known to stand still: that one is not waited for much longer.
    pub fn new(stands_still: bool) -> Self {
        Self { patience: if stands_still { LAST_WORD } else { PATIENCE }, heard: true }
    }

    /// Says these lines.
    pub fn say(&mut self, lines: Vec<Word>) {
        if self.heard && !lines.is_empty() {
            self.heard = within(self.patience, move || lines.iter().for_each(Word::say)).is_some();
        }
    }

    /// All was said so far, and taken.
    pub fn are_heard(&self) -> bool {
        self.heard
    }
}
