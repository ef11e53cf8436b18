//! How long an answer is waited for, by what the link has shown so far.

use std::time::Duration;

/// Bounds of the time for an answer, and of the silence after which a stream of messages is over.
const ANSWER: (Duration, Duration) = (Duration::from_millis(150), Duration::from_secs(3));
const SILENCE: (Duration, Duration) = (Duration::from_millis(150), Duration::from_secs(3));
/// Before anything is known.
const FIRST: Duration = Duration::from_secs(1);
/// Share of the newest observation in what is known.
const NEW: f64 = 0.2;
/// An answer is waited for so many times as long as answers take; a stream so many times its spacing.
const ANSWER_FACTOR: f64 = 4.0;
const SILENCE_FACTOR: f64 = 12.0;

/// What the link has shown.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Pace {
    answer_s: Option<f64>,
    spacing_s: Option<f64>,
}

fn mixed(known: Option<f64>, seen: Duration) -> Option<f64> {
    let seen = seen.as_secs_f64();
    Some(known.map_or(seen, |known| known + NEW * (seen - known)))
}

fn bounded(seconds: Option<f64>, factor: f64, (least, most): (Duration, Duration)) -> Duration {
    let wanted = seconds.and_then(|seconds| Duration::try_from_secs_f64(factor * seconds).ok());
    wanted.unwrap_or(FIRST).clamp(least, most)
}

impl Pace {
    /// An answer took so long.
    pub(super) fn answered(&mut self, after: Duration) {
        self.answer_s = mixed(self.answer_s, after);
    }

    /// Two messages of a stream were so far apart.
    pub(super) fn spaced(&mut self, by: Duration) {
        self.spacing_s = mixed(self.spacing_s, by);
    }

    /// How long an answer is waited for that was asked for `tries` times before.
    pub(super) fn answer(&self, tries: u32) -> Duration {
        let first = bounded(self.answer_s, ANSWER_FACTOR, ANSWER);
        first.mul_f64(1.5_f64.powi(i32::try_from(tries.min(8)).unwrap_or(8))).min(ANSWER.1)
    }

    /// So many times the spacing of a stream's messages, within bounds; the longest before anything is known.
    pub(super) fn between(&self, spacings: u32, (least, most): (Duration, Duration)) -> Duration {
        let spacing = self.spacing_s.and_then(|seconds| Duration::try_from_secs_f64(seconds).ok());
        spacing.map_or(most, |spacing| (spacing * spacings).clamp(least, most))
    }

    /// How long a stream may be silent that was begun `tries` times before without anything new.
    pub(super) fn silence(&self, tries: u32) -> Duration {
        let spacing = bounded(self.spacing_s, SILENCE_FACTOR, SILENCE);
        // the first message of a stream comes after as long as an answer
        spacing.max(self.answer(tries)).min(SILENCE.1)
    }
}
