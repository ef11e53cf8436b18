//! What a study tells while it works: a line at a terminal, and its notes.

use std::io::IsTerminal;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use mavid::note::Note;
use mavid::study::{Progress, Stage};

use super::output;

/// Between two pictures of the line.
const TICK: Duration = Duration::from_millis(100);

/// A line on standard error that says what is done now; none where standard error is no terminal.
#[derive(Debug)]
pub struct Spinner(ProgressBar);

impl Spinner {
    /// Empty until the first stage.
    pub fn new() -> Self {
        if !std::io::stderr().is_terminal() {
            return Self(ProgressBar::hidden());
        }
        let bar = ProgressBar::new_spinner();
        if let Ok(style) = ProgressStyle::with_template("{spinner} {msg}") {
            bar.set_style(style);
        }
        bar.enable_steady_tick(TICK);
        Self(bar)
    }
}

impl Progress for Spinner {
    fn stage(&self, stage: Stage) {
        self.0.set_message(stage.to_string());
    }

    fn note(&self, note: &Note) {
        self.0.suspend(|| output::message(&note.to_string()));
    }
}

/// A bar of steps on standard error, after this template; none where standard error is no terminal.
#[derive(Debug)]
pub struct Bar(ProgressBar);

impl Bar {
    /// Shown from the first word of its steps on.
    pub fn new(template: &str) -> Self {
        let bar = ProgressBar::hidden();
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style);
        }
        Self(bar)
    }
}

impl Progress for Bar {
    fn stage(&self, _: Stage) {}

    fn note(&self, note: &Note) {
        output::message(&note.to_string());
    }

    fn steps(&self, count: u64) {
        self.0.set_length(count);
        self.0.set_draw_target(ProgressDrawTarget::stderr());
    }

    fn step(&self) {
        self.0.inc(1);
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}

impl Drop for Spinner {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}

/// Notes alone, where another display has the terminal.
#[derive(Debug)]
pub struct Quiet;

impl Progress for Quiet {
    fn stage(&self, _: Stage) {}

    fn note(&self, note: &Note) {
        output::message(&note.to_string());
    }
}
