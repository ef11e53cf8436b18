//! One stream of a topic: which fields become what.

use super::turns::{MOST_CELLS, Turn, half_turn};
use crate::log::ulog::schema::{Cell, Layout, NumberType};
use crate::recording::{Quantity, StreamKey};
use crate::units::seconds_from_us;

/// Elements of an array that are looked at: `control[*]`.
const MOST_ELEMENTS: usize = 16;
/// Numbers that most samples are made of, at most; a turn has room for so many.
const FEW_CELLS: usize = 4;
/// Numbers of one array, at most.
const SOME_CELLS: usize = MOST_ELEMENTS;
const FLOAT_BYTES: usize = 4;
const VECTOR: usize = 3;
/// A sample that lies further from its message's stamp has no stamp of its own, microseconds.
const SAMPLED_BEFORE_US: u64 = 1_000_000;

/// One stream of a topic.
#[derive(Debug)]
pub(in crate::log::ulog) struct Row {
    /// names under which it is logged; the name is the stream's source
    pub(super) topics: &'static [&'static str],
    /// what the samples hold
    pub(super) quantity: Quantity,
    /// how they are made of the fields, which changed their names over the years: the first that is whole counts
    pub(super) ways: &'static [Way],
    /// fields without which a sample counts nothing; one that is not there asks for nothing
    pub(super) when: &'static [When],
    /// when a sample was true
    pub(super) moment: Moment,
}

/// How a sample is made of fields.
#[derive(Debug)]
pub(super) struct Way {
    /// paths; `[*]` stands for all elements of an array
    pub(super) fields: &'static [&'static str],
    /// from their values to the sample
    pub(super) turn: Turn,
}

/// A condition on a field.
#[derive(Debug)]
pub(super) enum When {
    /// it is not zero
    Set(&'static str),
    /// it has this value
    Is(&'static str, f64),
}

/// When a sample was true.
#[derive(Debug, Clone, Copy)]
pub(super) enum Moment {
    /// when it was published
    Published,
    /// when the sensor was read that it rests on; where that is not logged when it was published
    Sampled,
    /// it is a mean over a time (microseconds, or seconds where the field has a fraction) that ends when it was sampled
    MeanOver(&'static str),
    /// the same, but sampled later than said by a number of microseconds
    LaterMeanOver { later: &'static str, over: &'static str },
}

/// A row whose fields are found in the layout of a log.
#[derive(Debug)]
pub(in crate::log::ulog) struct Bound {
    key: StreamKey,
    cells: Vec<Cell>,
    /// where they begin, where they are single-precision numbers one behind the other
    floats_at: Option<usize>,
    /// the same, where they are a vector that is turned and nothing else is asked: what most of a log is
    vector_at: Option<usize>,
    turn: Turn,
    when: Vec<(Cell, Option<f64>)>,
    sampled: Option<Cell>,
    later: Option<Cell>,
    over: Option<Cell>,
}

impl Row {
    /// Whether it is of a topic of this name.
    pub(in crate::log::ulog) fn is_of(&self, topic: &str) -> bool {
        self.topics.contains(&topic)
    }

    /// The row for a topic of this layout; `None` where it is of another topic, or fields are missing.
    pub(in crate::log::ulog) fn bind(&self, topic: &str, instance: u8, layout: &Layout) -> Option<Bound> {
        let source = self.topics.iter().copied().find(|name| *name == topic)?;
        let (cells, turn) = self.ways.iter().find_map(|way| Some((cells(way.fields, layout)?, way.turn)))?;
        let when = self.when.iter().filter_map(|when| match when {
            When::Set(field) => Some((layout.cell(field)?, None)),
            When::Is(field, value) => Some((layout.cell(field)?, Some(*value))),
        });
        let sampled = || layout.cell("timestamp_sample");
        let (sampled, later, over) = match self.moment {
            Moment::Published => (None, None, None),
            Moment::Sampled => (sampled(), None, None),
            Moment::MeanOver(over) => (sampled(), None, layout.cell(over)),
            Moment::LaterMeanOver { later, over } => (sampled(), layout.cell(later), layout.cell(over)),
        };
        let key = StreamKey { quantity: self.quantity, source, instance };
        let floats_at = floats_at(&cells);
        let when: Vec<_> = when.collect();
        let is_vector = matches!(turn, Turn::HalfTurn) && cells.len() == VECTOR && when.is_empty();
        let vector_at = floats_at.filter(|_| is_vector);
        Some(Bound { key, cells, floats_at, vector_at, turn, when, sampled, later, over })
    }
}

/// The cells of all fields; `None` where one is missing, or there are too many.
fn cells(fields: &[&str], layout: &Layout) -> Option<Vec<Cell>> {
    let mut cells = Vec::new();
    for field in fields {
        match field.split_once("[*]") {
            None => cells.push(layout.cell(field)?),
            Some((before, after)) => {
                let path = |index| format!("{before}[{index}]{after}");
                let elements = (0..MOST_ELEMENTS).map_while(|index| layout.cell(&path(index)));
                let known = cells.len();
                cells.extend(elements);
                if cells.len() == known {
                    return None;
                }
            }
        }
    }
    (cells.len() <= MOST_CELLS).then_some(cells)
}

/// Single-precision numbers one behind the other.
#[inline]
fn floats<const N: usize, const BYTES: usize>(bytes: &[u8; BYTES]) -> [f64; N] {
    let mut floats = [0.0; N];
    for (float, bytes) in floats.iter_mut().zip(bytes.as_chunks::<FLOAT_BYTES>().0) {
        *float = f32::from_le_bytes(*bytes).into();
    }
    floats
}

/// Where cells begin that are single-precision numbers one behind the other.
fn floats_at(cells: &[Cell]) -> Option<usize> {
    let first = cells.first()?.offset;
    let follows = |(index, cell): (usize, &Cell)| {
        cell.number == NumberType::F32 && cell.offset == first + index * FLOAT_BYTES
    };
    cells.iter().enumerate().all(follows).then_some(first)
}

impl Bound {
    /// Which stream.
    pub(in crate::log::ulog) fn key(&self) -> StreamKey {
        self.key
    }

    /// The stamp of a message's sample, microseconds, and s to be added to it; `None` where it is not said.
    #[inline]
    pub(in crate::log::ulog) fn moment(&self, message: &[u8], published_us: u64) -> Option<(u64, f64)> {
        let sampled_us = self.sampled.and_then(|cell| cell.whole(message));
        let stamp_us = sampled_us
            .filter(|sampled_us| published_us.abs_diff(*sampled_us) < SAMPLED_BEFORE_US)
            .unwrap_or(published_us);
        let later_s = self.later.map_or(0.0, |cell| seconds_from_us(cell.read(message)));
        let over_s = self.over.map_or(0.0, |cell| {
            let over = cell.read(message);
            if cell.number.is_float() { over } else { seconds_from_us(over) }
        });
        let shift_s = later_s - 0.5 * over_s;
        (shift_s.abs() < seconds_from_us(SAMPLED_BEFORE_US as f64)).then_some((stamp_us, shift_s))
    }

    /// Gives the values of a message's sample to `take`, if there are any.
    #[inline]
    pub(in crate::log::ulog) fn sample(&self, message: &[u8], take: impl FnOnce(&[f64])) {
        if let Some(at) = self.vector_at {
            let Some(bytes) = message.get(at..).and_then(|bytes| bytes.first_chunk()) else { return };
            let sample = half_turn(floats::<VECTOR, { VECTOR * FLOAT_BYTES }>(bytes));
            if sample.iter().any(|value| value.is_finite()) {
                take(&sample);
            }
            return;
        }
        let holds = |(cell, wanted): &(Cell, Option<f64>)| {
            let value = cell.read(message);
            wanted.map_or(value != 0.0, |wanted| value == wanted)
        };
        if !self.when.iter().all(holds) {
            return;
        }
        // most have few, and room for many costs as much as the rest
        if self.cells.len() <= FEW_CELLS {
            self.turned(message, &mut [0.0; FEW_CELLS], take);
        } else if self.cells.len() <= SOME_CELLS {
            self.turned(message, &mut [0.0; SOME_CELLS], take);
        } else {
            self.turned(message, &mut [0.0; MOST_CELLS], take);
        }
    }

    #[inline]
    fn turned<const N: usize>(&self, message: &[u8], values: &mut [f64; N], take: impl FnOnce(&[f64])) {
        let count = self.cells.len().min(N);
        self.read(message, &mut values[..count]);
        let given = self.turn.turn(&mut values[..count.max(FEW_CELLS)], count);
        let sample = &values[..given.min(N)];
        if sample.iter().any(|value| value.is_finite()) {
            take(sample);
        }
    }

    #[inline]
    fn read(&self, message: &[u8], values: &mut [f64]) {
        let floats = self.floats_at.and_then(|at| message.get(at..at + values.len() * FLOAT_BYTES));
        if let Some(bytes) = floats {
            for (value, bytes) in values.iter_mut().zip(bytes.as_chunks::<FLOAT_BYTES>().0) {
                *value = f32::from_le_bytes(*bytes).into();
            }
            return;
        }
        for (value, cell) in values.iter_mut().zip(&self.cells) {
            *value = cell.read(message);
        }
    }
}
