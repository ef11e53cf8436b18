//! Samples of which several messages hold a value each.

use super::topics::Topic;
use super::values::{MOST, Values};

/// Values of one sample are no further apart, s.
const APART_S: f64 = 0.25;

/// Puts samples together of the values that several messages hold: one each.
#[derive(Debug, Default)]
pub(super) struct Join {
    open: Vec<Open>,
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
    /// The sample and its time: the mean of its values'. None where nothing was put in.
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
    /// Takes one value; gives the sample before it, where this one begins another.
    pub(super) fn take(
        &mut self,
        topic: &'static Topic,
        slot: usize,
        time_s: f64,
        value: f64,
    ) -> Option<(&'static Topic, f64, Values)> {
        if slot >= MOST {
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
        open.values[slot] = value;
        open.width = open.width.max(slot + 1);
        open.sum_s += time_s;
        open.count += 1.0;
        before
    }

    /// What is left at the end.
    pub(super) fn finish(&mut self) -> impl Iterator<Item = (&'static Topic, f64, Values)> {
        self.open.iter_mut().filter_map(Open::take)
    }
}
