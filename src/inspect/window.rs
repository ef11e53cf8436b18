//! Recordings of bounded length, one after the other, so that memory does not grow with the log.

use crate::autopilot::Autopilot;
use crate::log::Loss;
use crate::recording::{Event, Quantity, Recording, RecordingBuilder, Stream, StreamKey};

/// s of the vehicle's clock in one window. It bounds the memory; a longer one would hold more of a flight at once.
pub(super) const WINDOW_S: f64 = 120.0;
/// Stamps and values held in one window at most: 12 MB.
pub(super) const WINDOW_NUMBERS: usize = 1_500_000;

/// Collects events into windows.
#[derive(Debug, Default)]
pub(super) struct WindowRecorder {
    autopilot: Autopilot,
    builder: RecordingBuilder,
    start_s: Option<f64>,
    numbers_max: usize,
    impossible: u64,
    /// the log is damaged, and has no checksums
    is_damaged: bool,
    /// samples that leap, left out of the windows
    leaps: u64,
    /// last word on armed and landed: the next window begins with it
    states: Vec<(StreamKey, Vec<f64>)>,
}

impl WindowRecorder {
    /// Of a log that is known to be damaged, or not.
    pub(super) fn new(is_damaged: bool) -> Self {
        Self { is_damaged, ..Self::default() }
    }

    /// Adds an event; gives the window before it where that is full. Parameters and texts are kept elsewhere.
    pub(super) fn add(&mut self, event: Event<'_>) -> Option<Recording> {
        match event {
            Event::Autopilot(autopilot) => {
                self.autopilot = autopilot;
                None
            }
            Event::Sample { stream, time_s, values } => self.sample(stream, time_s, values),
            Event::ClockReset { .. } => {
                let window = self.close();
                self.states.clear();
                self.builder.add(event);
                window
            }
            Event::EstimatorReset { .. } => {
                self.builder.add(event);
                None
            }
            Event::Parameter { .. } | Event::ParameterDefault { .. } | Event::Text { .. } => None,
        }
    }

    fn sample(&mut self, stream: StreamKey, time_s: f64, values: &[f64]) -> Option<Recording> {
        let full = self.start_s.is_some_and(|start_s| time_s - start_s >= WINDOW_S)
            || self.builder.numbers() >= WINDOW_NUMBERS;
        let window = if full { self.close() } else { None };
        if self.start_s.is_none() {
            self.start_s = Some(time_s);
            for (state, values) in &self.states {
                self.builder.add(Event::Sample { stream: *state, time_s, values });
            }
        }
        if matches!(stream.quantity, Quantity::LandedState | Quantity::Armed) {
            match self.states.iter_mut().find(|(known, _)| *known == stream) {
                Some((_, last)) => values.clone_into(last),
                None => self.states.push((stream, values.to_vec())),
            }
        }
        self.builder.add(Event::Sample { stream, time_s, values });
        self.numbers_max = self.numbers_max.max(self.builder.numbers());
        window
    }

    /// The window so far; `None` where it is empty.
    pub(super) fn close(&mut self) -> Option<Recording> {
        self.start_s.take()?;
        let mut builder = std::mem::take(&mut self.builder);
        builder.add(Event::Autopilot(self.autopilot));
        let (mut window, repairs) = builder.finish();
        self.impossible += repairs.values().map(|repair| repair.impossible).sum::<u64>();
        if self.is_damaged {
            self.leaps += window.leave_out_leaps();
        }
        Some(window)
    }

    /// Samples that were left out of the windows.
    pub(super) fn losses(&self) -> impl Iterator<Item = Loss> {
        let impossible = Loss::Impossible { count: self.impossible };
        let counted = [(self.impossible, impossible), (self.leaps, Loss::Leaps { count: self.leaps })];
        counted.into_iter().filter_map(|(count, loss)| (count > 0).then_some(loss))
    }

    /// Most numbers that were held at once.
    pub(super) fn numbers_max(&self) -> usize {
        self.numbers_max
    }
}

/// A recording that is in memory, in windows of equal length, without those in which nothing is recorded.
pub(super) fn windows_of(recording: &Recording) -> impl Iterator<Item = Recording> {
    let streams = || recording.streams.values();
    let start_s = streams().filter_map(|s| s.time_s.first()).copied().fold(f64::INFINITY, f64::min);
    let end_s = streams().filter_map(|s| s.time_s.last()).copied().fold(f64::NEG_INFINITY, f64::max);
    let count = ((end_s - start_s) / WINDOW_S).ceil().max(1.0);
    let edge = move |index: f64| match index {
        0.0 => f64::NEG_INFINITY,
        _ if index >= count => f64::INFINITY,
        _ => start_s + (end_s - start_s) * index / count,
    };
    // from the window of one sample to that of the next: there are no more than samples
    let next = move |from: f64| {
        let first =
            |stream: &Stream| stream.time_s.get(stream.time_s.partition_point(|t| *t < edge(from))).copied();
        let first_s = recording.streams.values().filter_map(first).fold(f64::INFINITY, f64::min);
        let inside = ((first_s - start_s) / (end_s - start_s) * count).floor();
        let mut index = if inside.is_finite() { inside.min(count - 1.0).max(from) } else { from };
        while index > from && edge(index) > first_s {
            index -= 1.0;
        }
        (first_s.is_finite() && from < count).then_some(index)
    };
    std::iter::successors(next(0.0), move |index| next(index + 1.0))
        .map(move |index| cut(recording, edge(index), edge(index + 1.0)))
}

fn cut(recording: &Recording, from_s: f64, to_s: f64) -> Recording {
    let inside = |time_s: &f64| (from_s..to_s).contains(time_s);
    let piece = |stream: &Stream| {
        let first = stream.time_s.partition_point(|t| *t < from_s);
        let last = stream.time_s.partition_point(|t| *t < to_s);
        Stream {
            time_s: stream.time_s[first..last].to_vec(),
            width: stream.width,
            values: stream.values[first * stream.width..last * stream.width].to_vec(),
        }
    };
    Recording {
        streams: recording.streams.iter().map(|(key, stream)| (*key, piece(stream))).collect(),
        parameters: recording.parameters.clone(),
        defaulted: recording.defaulted.clone(),
        // told of the whole log
        parameter_changes: Vec::new(),
        autopilot: recording.autopilot,
        clock_resets_s: recording.clock_resets_s.iter().copied().filter(inside).collect(),
        estimator_resets_s: recording.estimator_resets_s.iter().copied().filter(inside).collect(),
        is_damaged: recording.is_damaged,
        texts: Vec::new(),
    }
}
