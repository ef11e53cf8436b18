//! Samples of which several messages hold a part each.

use super::topics::{Part, Topic};
use super::values::{MOST, Values};

/// Values of one sample are no further apart, s.
const APART_S: f64 = 0.25;
/// Those that are written at once, s.
const AT_ONCE_S: f64 = 0.002;

/// Puts samples together of the values that several messages hold.
#[derive(Debug)]
pub(super) struct Join {
    open: Vec<Open>,
    /// time from which a sample is no longer waited for, s
    due_s: f64,
}

impl Default for Join {
    fn default() -> Self {
        Self { open: Vec::new(), due_s: f64::INFINITY }
    }
}

/// A sample that is being put together.
#[derive(Debug)]
struct Open {
    topic: &'static Topic,
    values: [f64; MOST],
    width: usize,
    sum_s: f64,
    first_s: f64,
    count: f64,
}

impl Open {
    fn is_at_once(&self) -> bool {
        matches!(self.topic.part, Some(Part::From(_)))
    }

    /// Time from which no further part of it comes, s.
    fn due_s(&self) -> f64 {
        match self.count {
            0.0 => f64::INFINITY,
            _ => self.first_s + if self.is_at_once() { AT_ONCE_S } else { APART_S },
        }
    }

    /// The sample and its time: the mean of its parts'. None where nothing was put in.
    fn take(&mut self) -> Option<(&'static Topic, f64, Values)> {
        if self.count == 0.0 {
            return None;
        }
        let mut values = Values::NONE;
        self.values[..self.width].iter().for_each(|value| values.push(*value));
        (self.topic.convert)(&mut values);
        let time_s = self.sum_s / self.count;
        self.values = [f64::NAN; MOST];
        (self.count, self.sum_s) = (0.0, 0.0);
        Some((self.topic, time_s, values))
    }
}

impl Join {
    /// Takes a part, its first value at `slot`; gives the sample before it, where this one begins another.
    pub(super) fn take(
        &mut self,
        topic: &'static Topic,
        slot: usize,
        time_s: f64,
        part: &[f64],
    ) -> Option<(&'static Topic, f64, Values)> {
        let end = slot + part.len();
        if part.is_empty() || end > MOST {
            return None;
        }
        let same = |open: &Open| open.topic.quantity == topic.quantity && open.topic.source == topic.source;
        let at = self.open.iter().position(same).unwrap_or_else(|| {
            let values = [f64::NAN; MOST];
            self.open.push(Open { topic, values, width: 0, sum_s: 0.0, first_s: time_s, count: 0.0 });
            self.open.len() - 1
        });
        let open = &mut self.open[at];
        let is_next = !open.values[slot].is_nan() || (time_s - open.first_s).abs() > APART_S;
        let before = if is_next { open.take() } else { None };
        if open.count == 0.0 {
            open.first_s = time_s;
        }
        open.values[slot..end].copy_from_slice(part);
        open.width = open.width.max(end);
        // of what is written at once the first says when
        if open.count == 0.0 || !open.is_at_once() {
            open.sum_s += time_s;
            open.count += 1.0;
        }
        self.due_s = self.due_s.min(open.due_s());
        before
    }

    /// A sample of which no further part comes at this time or later, s; again until there is none.
    pub(super) fn due(&mut self, time_s: f64) -> Option<(&'static Topic, f64, Values)> {
        if time_s < self.due_s {
            return None;
        }
        let sample = self.open.iter_mut().find(|open| time_s >= open.due_s()).and_then(Open::take);
        self.due_s = self.open.iter().map(Open::due_s).fold(f64::INFINITY, f64::min);
        sample
    }

    /// What is left at the end.
    pub(super) fn finish(&mut self) -> impl Iterator<Item = (&'static Topic, f64, Values)> {
        self.open.iter_mut().filter_map(Open::take)
    }
}
