//! What a study tells while it works: its notes, and at a terminal how far it is.

use std::sync::{Mutex, OnceLock, PoisonError};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};
use mavid::note::Note;
use mavid::study::{Progress, Stage};

use super::output;
use super::standard_error::StandardError;
use super::words::Word;

/// Between two pictures of the line.
pub(super) const TICK: Duration = Duration::from_millis(100);

fn styled(bar: ProgressBar, template: &str) -> ProgressBar {
    match ProgressStyle::with_template(template) {
        Ok(style) => bar.with_style(style),
        Err(_) => bar,
    }
}

/// A bar of bytes that come over a link, with the time that is left.
pub fn bytes_bar(of: u64) -> ProgressBar {
    let template = "{bar:30} {bytes} of {total_bytes}, {bytes_per_sec}, about {eta} left";
    styled(ProgressBar::new(of), template)
}

/// Between two lines about a download.
const LINES: Duration = Duration::from_secs(10);

/// How far a download is, in a line now and then: for a log, or where no bar can be drawn.
#[derive(Debug)]
pub struct DownloadLines {
    /// when it began, and bytes that were there
    began: Option<(Instant, u64)>,
    told: Instant,
}

impl DownloadLines {
    /// Of a download that begins now.
    pub fn new(now: Instant) -> Self {
        Self { began: None, told: now }
    }

    /// The line, where it is time for one: so many bytes of all of them are there.
    pub fn due(&mut self, now: Instant, bytes: u64, of: u64) -> Option<String> {
        let (began, first) = *self.began.get_or_insert((now, bytes));
        if now.duration_since(self.told) < LINES {
            return None;
        }
        self.told = now;
        let [there, all] = [bytes, of].map(|bytes| bytes as f64 / 1e6);
        let bytes_s = bytes.saturating_sub(first) as f64 / now.duration_since(began).as_secs_f64();
        let left_s = of.saturating_sub(bytes) as f64 / bytes_s;
        let left =
            if left_s.is_finite() { format!("about {left_s:.0} s left") } else { "nothing comes".to_owned() };
        Some(format!("{there:.2} of {all:.2} MB, {:.1} kB/s, {left}", bytes_s / 1e3))
    }
}

/// A line that says what is done now and for how long, or with counted steps how long it will take.
#[derive(Debug)]
pub struct Spinner(ProgressBar);

/// A stage whose steps are not counted.
const STAGE: &str = "{spinner} {msg}, {elapsed}";
/// A stage of which it is known about how long it is.
const ESTIMATED: &str = "{spinner} {msg} {bar:20} {elapsed}, about {eta} left";
/// A stage of counted steps; the prefix says what they are.
const COUNTED: &str = "{spinner} {msg} {bar:20} {pos} of {len} {prefix}, about {eta} left";

impl Spinner {
    /// Empty until the first stage.
    pub fn new(stderr: &StandardError) -> Self {
        let bar = stderr.bar(styled(ProgressBar::new_spinner(), STAGE));
        if stderr.can_draw() {
            bar.enable_steady_tick(TICK);
        }
        Self(bar)
    }
}

impl Spinner {
    /// Of one piece of work, in words.
    pub fn of(stderr: &StandardError, words: impl Into<String>) -> Self {
        let spinner = Self::new(stderr);
        spinner.0.set_message(words.into());
        spinner
    }

    /// What is done from now on, in words.
    pub fn say(&self, words: impl Into<String>) {
        self.0.reset_elapsed();
        self.0.set_message(words.into());
    }

    fn restyle(&self, template: &str) {
        if let Ok(style) = ProgressStyle::with_template(template) {
            self.0.set_style(style);
        }
    }
}

impl Progress for Spinner {
    fn stage(&self, stage: Stage) {
        self.restyle(STAGE);
        self.0.reset_elapsed();
        self.0.set_message(stage.to_string());
        self.0.set_prefix(stage.counted());
    }

    fn steps(&self, count: u64) {
        self.0.set_length(count);
        self.0.reset();
        self.restyle(COUNTED);
    }

    fn step(&self) {
        self.0.inc(1);
    }

    fn about(&self, done: u64, of: u64) {
        self.0.set_length(of);
        self.0.set_position(done);
        if done > 0 {
            self.restyle(ESTIMATED);
        }
    }

    fn note(&self, note: &Note) {
        output::note(note);
    }
}

impl Drop for Spinner {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}

/// A bar of steps after a template; none before the first is to be done.
#[derive(Debug)]
pub struct Steps<'a> {
    stderr: &'a StandardError,
    template: &'static str,
    bar: OnceLock<ProgressBar>,
}

impl<'a> Steps<'a> {
    /// With indicatif's names in the template.
    pub fn new(stderr: &'a StandardError, template: &'static str) -> Self {
        Self { stderr, template, bar: OnceLock::new() }
    }
}

impl Progress for Steps<'_> {
    fn stage(&self, _: Stage) {}

    fn note(&self, note: &Note) {
        output::note(note);
    }

    fn steps(&self, count: u64) {
        self.bar.get_or_init(|| self.stderr.bar(styled(ProgressBar::new(count), self.template)));
    }

    fn step(&self) {
        self.bar.get().into_iter().for_each(|bar| bar.inc(1));
    }
}

impl Drop for Steps<'_> {
    fn drop(&mut self) {
        self.bar.get().into_iter().for_each(ProgressBar::finish_and_clear);
    }
}

/// Keeps notes for later: the terminal may take nothing, and the work does not wait for it. How far the work is goes to whoever
/// watches.
pub struct Notes<'a> {
    words: Mutex<Vec<Word>>,
    watches: &'a dyn Progress,
}

impl<'a> Notes<'a> {
    /// With no note yet.
    pub fn new(watches: &'a dyn Progress) -> Self {
        Self { words: Mutex::default(), watches }
    }

    /// What there is to say.
    pub fn words(self) -> Vec<Word> {
        self.words.into_inner().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Progress for Notes<'_> {
    fn stage(&self, stage: Stage) {
        self.watches.stage(stage);
    }

    fn steps(&self, count: u64) {
        self.watches.steps(count);
    }

    fn step(&self) {
        self.watches.step();
    }

    fn about(&self, done: u64, of: u64) {
        self.watches.about(done, of);
    }

    fn note(&self, note: &Note) {
        self.words.lock().unwrap_or_else(PoisonError::into_inner).push(note.into());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_download_is_told_each_ten_seconds() {
        let start = Instant::now();
        let mut lines = DownloadLines::new(start);
        let mut at = |seconds, bytes| lines.due(start + Duration::from_secs(seconds), bytes, 2_000_000);
        // half a megabyte of an earlier download
        assert_eq!((at(0, 500_000), at(9, 900_000)), (None, None));
        assert_eq!(at(10, 1_000_000).unwrap(), "1.00 of 2.00 MB, 50.0 kB/s, about 20 s left");
        assert_eq!(at(19, 1_400_000), None);
        assert!(at(20, 1_500_000).is_some());
        let mut none = DownloadLines::new(start);
        none.due(start, 0, 9);
        assert!(none.due(start + LINES, 0, 9).unwrap().ends_with("nothing comes"));
    }
}
