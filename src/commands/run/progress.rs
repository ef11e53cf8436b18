//! How far a flight is: one bar, or lines where nothing can be drawn.

use std::sync::mpsc::Receiver;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};
use mavid::fly::view::ViewModel;

use crate::commands::output;
use crate::commands::progress::TICK;
use crate::commands::standard_error::StandardError;

/// Hundredths of the whole at which the stages end.
const READY: u64 = 20;
const FLOWN: u64 = 85;
const LANDED: u64 = 99;

/// Phases that get a line where nothing can be drawn: few, because they stand before the answer.
const TOLD: [&str; 3] = ["take off", "trajectory", "land"];

/// The display.
#[derive(Debug, Clone)]
pub struct Progress(Option<ProgressBar>);

impl Progress {
    /// An empty bar, or a line for each of the longest phases.
    pub fn new(stderr: &StandardError, drawn: bool) -> Self {
        Self(drawn.then(|| {
            let bar = stderr.bar(ProgressBar::new(100));
            if let Ok(style) = ProgressStyle::with_template("{spinner} {bar:30} {elapsed:>4} {msg}") {
                bar.set_style(style);
            }
            bar.enable_steady_tick(TICK);
            bar
        }))
    }

    /// Follows a flight until it is over.
    pub fn follow(&self, pictures: &Receiver<ViewModel>) {
        let mut last = String::new();
        for model in pictures {
            let text = words(&model);
            if let Some(bar) = &self.0 {
                bar.set_position(hundredths(&model).max(bar.position()));
                bar.set_message(text);
            } else if model.state != last {
                if TOLD.contains(&model.state.as_str()) {
                    output::message(&format!("[{:5.1} s] {text}", model.elapsed_s));
                }
                last = model.state;
            }
        }
    }

    /// Takes the bar away.
    pub fn end(&self) {
        self.0.iter().for_each(ProgressBar::finish_and_clear);
    }
}

fn words(model: &ViewModel) -> String {
    let along = model.progress_s.map(|(done_s, all_s)| format!(", {done_s:.0} of {all_s:.0} s"));
    let mode = if model.mode.is_empty() { String::new() } else { format!(", {}", model.mode) };
    format!("{}{mode}{}", model.state, along.unwrap_or_default())
}

fn hundredths(model: &ViewModel) -> u64 {
    let seconds = Duration::try_from_secs_f64(model.elapsed_s).map_or(0, |elapsed| elapsed.as_secs());
    match model.progress_s {
        Some((done_s, all_s)) if all_s > 0.0 => {
            let share = (done_s / all_s).clamp(0.0, 1.0);
            let steps = u64::try_from(mavid::units::whole(share * 1000.0)).unwrap_or(0);
            READY + (FLOWN - READY) * steps / 1000
        }
        _ if model.state == "land" => LANDED.min(FLOWN + seconds % (LANDED - FLOWN)),
        _ => READY.min(seconds),
    }
}
