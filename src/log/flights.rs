//! The flights of one log: stretches of recording that no long silence divides.
//!
//! A log may hold flights that are hours or days apart, hours on the ground, and more flight than memory holds. It is
//! looked at in cells of ten seconds, which exist only where something is recorded; from them follows which spans of
//! time are kept. Everything after this works on recordings whose length is bounded and whose samples fill it.

use crate::recording::landed::ON_GROUND;
use std::collections::BTreeMap;

use crate::recording::{Event, ParameterChange, Quantity, Recording, Stream};

/// Length of a cell, s.
const CELL_S: f64 = 10.0;
/// Fewer samples of body motion, or of what drives the body, than this in a cell are silence: nothing is identified from
/// 2 Hz.
const LEAST_SAMPLES: u32 = 20;
/// A longer silence of motion or actuators divides two flights; of a silence at the ends so much is kept, s.
pub const SILENCE_S: f64 = 60.0;
/// Kept before and after the time in the air where time on the ground is left out, s.
const GROUND_S: f64 = 10.0;

/// How much of one log is kept in memory.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hold {
    /// time, s
    pub seconds: f64,
    /// stamps and values; each takes eight bytes
    pub numbers: usize,
    /// s that are held in any case, with up to four times the numbers: a dense log of one flight is not long
    pub short_s: f64,
}

/// How many times more numbers a short flight may have. At 1 kHz, streams have four to eight times as many as at the usual rates.
const DENSE: usize = 4;

impl Hold {
    /// Whether so much is held.
    fn holds(&self, seconds: f64, numbers: usize) -> bool {
        let most = if seconds <= self.short_s { DENSE * self.numbers } else { self.numbers };
        seconds <= self.seconds && numbers <= most
    }
}

/// What is recorded in some seconds.
#[derive(Debug, Clone, Copy, Default)]
struct Cell {
    start_s: f64,
    numbers: usize,
    body: u32,
    driven: u32,
    /// whether it was armed at any time, where it says so
    armed: Option<bool>,
    /// whether it was off the ground at any time, where it says so
    off_ground: Option<bool>,
}

impl Cell {
    fn is_live(&self) -> bool {
        self.body >= LEAST_SAMPLES && self.driven >= LEAST_SAMPLES
    }

    /// The vehicle does not say that it stands on the ground.
    fn may_fly(&self) -> bool {
        self.armed.unwrap_or(true) && self.off_ground.unwrap_or(true)
    }

    fn end_s(&self) -> f64 {
        self.start_s + CELL_S
    }
}

/// Which spans of a log are kept, and what of it is not.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Plan {
    /// from and to, s, in order
    pub(super) spans_s: Vec<(f64, f64)>,
    /// time in the air that is left out, s, because it is more than is to be held
    pub(super) left_out_s: f64,
}

impl Plan {
    /// Whether a time (s) is kept.
    pub(super) fn keeps(&self, time_s: f64) -> bool {
        let next = self.spans_s.partition_point(|(from_s, _)| *from_s <= time_s);
        next.checked_sub(1).is_some_and(|at| time_s < self.spans_s[at].1)
    }
}

/// A log in cells, in the order of time.
#[derive(Debug, Default)]
pub(super) struct Cells(Vec<Cell>);

impl Cells {
    /// Of a recording that is in memory.
    pub(super) fn of(recording: &Recording) -> Self {
        let mut cells = Self::default();
        for (key, stream) in &recording.streams {
            for (index, time_s) in stream.time_s.iter().enumerate() {
                cells.sample(key.quantity, *time_s, stream.sample(index));
            }
        }
        cells
    }

    /// Takes an event.
    pub(super) fn add(&mut self, event: &Event<'_>) {
        if let Event::Sample { stream, time_s, values } = event {
            self.sample(stream.quantity, *time_s, values);
        }
    }

    fn sample(&mut self, quantity: Quantity, time_s: f64, values: &[f64]) {
        let value = values.first().copied().unwrap_or(0.0);
        let Some(cell) = self.cell(time_s) else { return };
        let told = |known: Option<bool>, now: bool| Some(known.unwrap_or(false) || now);
        cell.numbers += 1 + values.len();
        match quantity {
            Quantity::AngularRate | Quantity::Attitude | Quantity::WorldAcceleration => cell.body += 1,
            Quantity::ActuatorCommand | Quantity::RotorSpeed | Quantity::Wrench => cell.driven += 1,
            Quantity::Armed => cell.armed = told(cell.armed, value > 0.5),
            Quantity::LandedState => cell.off_ground = told(cell.off_ground, value > ON_GROUND + 0.5),
            _ => {}
        }
    }

    fn cell(&mut self, time_s: f64) -> Option<&mut Cell> {
        let start_s = (time_s / CELL_S).floor() * CELL_S;
        if !start_s.is_finite() {
            return None;
        }
        let at = match self.0.last() {
            Some(last) if last.start_s == start_s => self.0.len() - 1,
            _ => {
                let at = self.0.partition_point(|cell| cell.start_s < start_s);
                if self.0.get(at).is_none_or(|cell| cell.start_s > start_s) {
                    self.0.insert(at, Cell { start_s, ..Cell::default() });
                }
                at
            }
        };
        self.0.get_mut(at)
    }

    /// What is kept; `None`: all of it, as one flight.
    pub(super) fn plan(&self, most: &Hold) -> Option<Plan> {
        let whole = (self.0.first()?.start_s, self.0.last()?.end_s());
        let live = runs(self.0.iter().filter(|cell| cell.is_live()), SILENCE_S);
        let undivided = live.first().is_none_or(|span| span.0 <= whole.0 && span.1 >= whole.1);
        let spans = if undivided { vec![whole] } else { self.off_the_ground(live) };
        let (seconds, numbers) = self.held(&spans);
        match (undivided, most.holds(seconds, numbers)) {
            (true, true) => None,
            (false, true) => Some(Plan { spans_s: spans, left_out_s: 0.0 }),
            (_, false) => Some(self.bounded(&spans, most)),
        }
    }

    /// Without the spans in which the vehicle never left the ground, as long as one is left.
    fn off_the_ground(&self, mut spans: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
        let flown =
            |span: &(f64, f64)| self.within(*span).iter().any(|cell| cell.is_live() && cell.may_fly());
        if spans.iter().any(flown) {
            spans.retain(flown);
        }
        spans
    }

    /// Seconds and numbers in these spans.
    fn held(&self, spans: &[(f64, f64)]) -> (f64, usize) {
        let seconds =
            spans.iter().filter_map(|span| self.recorded(*span)).map(|(from_s, to_s)| to_s - from_s).sum();
        (seconds, spans.iter().flat_map(|span| self.within(*span)).map(|cell| cell.numbers).sum())
    }

    /// First and last of what is recorded within the span, s: the margins of a span may hold nothing.
    fn recorded(&self, (from_s, to_s): (f64, f64)) -> Option<(f64, f64)> {
        let cells = self.within((from_s, to_s));
        Some((cells.first()?.start_s.max(from_s), cells.last()?.end_s().min(to_s)))
    }

    /// As much of these spans as is to be held: without time on the ground, and then from the first flight on.
    fn bounded(&self, spans: &[(f64, f64)], most: &Hold) -> Plan {
        let all = || spans.iter().flat_map(move |span| self.within(*span));
        let mut flown = runs(all().filter(|cell| cell.is_live() && cell.may_fly()), GROUND_S);
        if flown.is_empty() {
            flown = spans.to_vec();
        }
        let mut plan = Plan::default();
        let (mut held_s, mut held) = (0.0, 0);
        for span in flown {
            let Some((from_s, to_s)) = self.recorded(span) else { continue };
            let mut kept_to_s = from_s;
            for cell in self.within(span) {
                let end_s = cell.end_s().min(to_s);
                held_s += end_s - kept_to_s;
                held += cell.numbers;
                if !most.holds(held_s, held) {
                    break;
                }
                kept_to_s = end_s;
            }
            plan.left_out_s += to_s - kept_to_s;
            if kept_to_s > from_s {
                // what is kept to its end keeps the margin that was asked for
                plan.spans_s.push((span.0, if kept_to_s < to_s { kept_to_s } else { span.1 }));
            }
        }
        plan
    }

    /// The cells of which more than half lies in the span.
    fn within(&self, (from_s, to_s): (f64, f64)) -> &[Cell] {
        let before = |edge_s: f64| self.0.partition_point(|cell| cell.start_s + 0.5 * CELL_S < edge_s);
        let first = before(from_s);
        &self.0[first..before(to_s).max(first)]
    }
}

/// Runs of cells, widened at both ends by `margin_s`; those that are no further apart than that are one.
fn runs<'a>(cells: impl Iterator<Item = &'a Cell>, margin_s: f64) -> Vec<(f64, f64)> {
    let mut runs: Vec<(f64, f64)> = Vec::new();
    for cell in cells {
        let (from_s, to_s) = (cell.start_s - margin_s, cell.end_s() + margin_s);
        match runs.last_mut() {
            Some(before) if from_s <= before.1 - margin_s => before.1 = to_s,
            // each gets half of what lies between
            Some(before) if from_s < before.1 => {
                let middle_s = 0.5 * (from_s + before.1);
                before.1 = middle_s;
                runs.push((middle_s, to_s));
            }
            _ => runs.push((from_s, to_s)),
        }
    }
    runs
}

/// One flight of a log.
#[derive(Debug, Clone, PartialEq)]
pub struct LogFlight {
    /// what is recorded of it
    pub recording: Recording,
    /// first and last sample on the log's clock, s, where it is a part of the log: its own clock begins there
    pub part_s: Option<(f64, f64)>,
}

/// The flights of a log.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Flights {
    /// in the order of time, at least one
    pub flights: Vec<LogFlight>,
    /// time in the air that is left out, s: the log holds more than is kept in memory
    pub left_out_s: f64,
}

impl Flights {
    /// The flights of a recording that is in memory: divided by silences of motion or actuators of more than a minute. A
    /// recording of one flight stays as it is. Of more than `most`, time on the ground is left out, and then what follows.
    #[must_use]
    pub fn of(recording: Recording, most: &Hold) -> Self {
        let plan = Cells::of(&recording).plan(most);
        Self::by_plan(recording, plan.as_ref())
    }

    pub(super) fn by_plan(recording: Recording, plan: Option<&Plan>) -> Self {
        let whole = |recording| vec![LogFlight { recording, part_s: None }];
        let Some(plan) = plan else { return Self { flights: whole(recording), left_out_s: 0.0 } };
        let mut flights: Vec<LogFlight> =
            plan.spans_s.iter().filter_map(|span| cut(&recording, *span)).collect();
        if flights.is_empty() {
            flights = whole(Recording { streams: BTreeMap::new(), ..recording });
        }
        Self { flights, left_out_s: plan.left_out_s }
    }
}

/// States hold until the next word: the last one before a span is part of it.
pub(super) fn is_state(quantity: Quantity) -> bool {
    matches!(quantity, Quantity::Armed | Quantity::LandedState | Quantity::Mode)
}

/// What a recording holds from `from_s` on and before `to_s`, on a clock of its own; `None` where it holds nothing.
fn cut(recording: &Recording, (from_s, to_s): (f64, f64)) -> Option<LogFlight> {
    let range = |stream: &Stream| {
        let before = |edge_s: f64| stream.time_s.partition_point(|time_s| *time_s < edge_s);
        before(from_s)..before(to_s)
    };
    let sensed =
        || recording.streams.iter().filter(|(key, _)| !is_state(key.quantity)).map(|(_, stream)| stream);
    let start_s = sensed().filter_map(|stream| stream.time_s[range(stream)].first()).copied();
    let start_s = start_s.reduce(f64::min)?;
    let end_s = sensed().filter_map(|stream| stream.time_s[range(stream)].last()).copied();
    let end_s = end_s.fold(start_s, f64::max);
    let piece = |quantity: Quantity, stream: &Stream| {
        let mut range = range(stream);
        if is_state(quantity) {
            range.start = range.start.saturating_sub(1);
        }
        Stream {
            time_s: stream.time_s[range.clone()].iter().map(|time_s| time_s - start_s).collect(),
            width: stream.width,
            values: stream.values[range.start * stream.width..range.end * stream.width].to_vec(),
        }
    };
    let pieces = recording.streams.iter().map(|(key, stream)| (*key, piece(key.quantity, stream)));
    let inside = |time_s: &&f64| (from_s..to_s).contains(*time_s);
    let events = |times_s: &[f64]| times_s.iter().filter(inside).map(|time_s| time_s - start_s).collect();
    let texts = recording.texts.iter().filter(|(time_s, _)| (from_s..to_s).contains(time_s));
    let changes = recording.parameter_changes.iter().filter(|change| inside(&&change.time_s));
    let recording = Recording {
        streams: pieces.filter(|(_, stream)| !stream.is_empty()).collect(),
        parameters: parameters_at(recording, to_s),
        defaulted: recording.defaulted.clone(),
        parameter_changes: changes
            .map(|change| ParameterChange { time_s: change.time_s - start_s, ..change.clone() })
            .collect(),
        autopilot: recording.autopilot,
        clock_resets_s: events(&recording.clock_resets_s),
        estimator_resets_s: events(&recording.estimator_resets_s),
        is_damaged: recording.is_damaged,
        texts: texts.map(|(time_s, text)| (time_s - start_s, text.clone())).collect(),
    };
    Some(LogFlight { recording, part_s: Some((start_s, end_s)) })
}

/// The parameters as they stood at a time, s. The throttle of hover is learned in flight and told after it: its last value is
/// the best.
fn parameters_at(recording: &Recording, time_s: f64) -> BTreeMap<String, f64> {
    let mut parameters = recording.parameters.clone();
    let learned = recording.autopilot.stack().map(|stack| stack.outputs.hover);
    let later = recording.parameter_changes.iter().rev().take_while(|change| change.time_s >= time_s);
    for change in later.filter(|change| learned != Some(change.name.as_str())) {
        parameters.insert(change.name.clone(), change.before);
    }
    parameters
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::autopilot::Autopilot;

    #[test]
    fn a_flight_has_the_parameters_that_stood_at_its_end() {
        let change = |time_s: f64, name: &str, before: f64, after: f64| ParameterChange {
            time_s,
            name: name.to_owned(),
            before,
            after,
        };
        let recording = Recording {
            autopilot: Autopilot::ArduPilot,
            parameters: [("A".to_owned(), 3.0), ("B".to_owned(), 5.0), ("MOT_THST_HOVER".to_owned(), 0.3)]
                .into(),
            parameter_changes: vec![
                change(10.0, "A", 1.0, 2.0),
                change(50.0, "A", 2.0, 3.0),
                change(60.0, "MOT_THST_HOVER", 0.2, 0.3),
            ],
            ..Recording::default()
        };
        let at = |time_s: f64| parameters_at(&recording, time_s).into_values().collect::<Vec<_>>();
        assert_eq!(at(5.0), [1.0, 5.0, 0.3]);
        assert_eq!(at(20.0), [2.0, 5.0, 0.3]);
        assert_eq!(at(f64::INFINITY), [3.0, 5.0, 0.3]);
    }
}
