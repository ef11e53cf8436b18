//! Gives out what rows hold, on a clock that is zero at the earliest row.

use super::rows::CLOCK_RESET_S;
use crate::log::format::{Place, Sink};
use crate::recording::{Event, StreamKey};

/// Stamps and values that wait at most: a table of which more stands within the first second has its zero at the earliest
/// of these.
const WAITING_MAX: usize = 1 << 20;

/// Gives pieces of a flight to a sink. Rows out of order lie at most [`CLOCK_RESET_S`] behind another, so the earliest is
/// known once the table has gone on for that long. Until then pieces wait.
pub(super) struct Outlet<'a, 'b> {
    sink: &'a mut Sink<'b>,
    waiting: Vec<(Place, Piece)>,
    numbers: usize,
    earliest_s: f64,
    start_s: Option<f64>,
}

enum Piece {
    Sample { stream: StreamKey, time_s: f64, values: Vec<f64> },
    Reset { time_s: f64, stamp_s: f64 },
}

impl<'a, 'b> Outlet<'a, 'b> {
    pub(super) fn new(sink: &'a mut Sink<'b>) -> Self {
        Self { sink, waiting: Vec::new(), numbers: 0, earliest_s: f64::INFINITY, start_s: None }
    }

    /// A row at this time, the latest so far being `latest_s`; both s from the first row.
    pub(super) fn row(&mut self, time_s: f64, latest_s: f64) {
        self.earliest_s = self.earliest_s.min(time_s);
        if self.start_s.is_none() && (latest_s >= CLOCK_RESET_S || self.numbers > WAITING_MAX) {
            self.start();
        }
    }

    /// One sample of that row.
    pub(super) fn sample(&mut self, place: Place, stream: StreamKey, time_s: f64, values: Vec<f64>) {
        self.give(place, Piece::Sample { stream, time_s, values });
    }

    /// The table's clock started anew.
    pub(super) fn reset(&mut self, place: Place, time_s: f64, stamp_s: f64) {
        self.give(place, Piece::Reset { time_s, stamp_s });
    }

    /// Gives out what waits. Returns the time of the earliest row, s from the first row.
    pub(super) fn finish(mut self) -> f64 {
        self.start()
    }

    fn start(&mut self) -> f64 {
        if let Some(start_s) = self.start_s {
            return start_s;
        }
        let start_s = self.earliest_s;
        self.start_s = Some(start_s);
        for (place, piece) in std::mem::take(&mut self.waiting) {
            piece.give(place, start_s, self.sink);
        }
        start_s
    }

    fn give(&mut self, place: Place, piece: Piece) {
        match self.start_s {
            Some(start_s) => piece.give(place, start_s, self.sink),
            None => {
                self.numbers += 1 + if let Piece::Sample { values, .. } = &piece { values.len() } else { 0 };
                self.waiting.push((place, piece));
            }
        }
    }
}

impl Piece {
    fn give(&self, place: Place, start_s: f64, sink: &mut Sink<'_>) {
        let event = match self {
            Self::Sample { stream, time_s, values } => {
                Event::Sample { stream: *stream, time_s: time_s - start_s, values }
            }
            Self::Reset { time_s, stamp_s } => {
                Event::ClockReset { time_s: time_s - start_s, stamp_s: *stamp_s }
            }
        };
        sink(place, event);
    }
}
