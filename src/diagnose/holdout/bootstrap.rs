//! Errors of two models, and of a state that does not change, on the same stretches of flight, with intervals from resampled
//! blocks.

use crate::compare::improvement_percent;
use crate::stats::{percentiles_95, resamples};

/// Least number of blocks for an interval. Of fewer there are too few different draws for an interval of 95 %.
const LEAST_BLOCKS: usize = 5;

/// A figure with its 95 % bootstrap interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    /// value for the flight itself
    pub value: f64,
    /// 2.5 and 97.5 percentile; `None` with fewer than five blocks
    pub range: Option<(f64, f64)>,
}

/// One quantity before and after.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Compared {
    /// root mean square error of the rigid body alone
    pub before: Interval,
    /// root mean square error of the model with effects
    pub after: Interval,
    /// root mean square error of a state that does not change, where a state is predicted
    pub unchanged: Option<Interval>,
    /// error that the right model would have, if that can be estimated
    pub floor: Option<f64>,
    /// by how much `after` is less than the better of `before` and `unchanged`, with the same resampled blocks for all
    pub improvement_percent: Interval,
    /// errors at the end of the windows, where a state is predicted
    pub at_end: Option<AtEnd>,
}

impl Compared {
    /// Whether a state that does not change predicts better than the final model, over the windows.
    #[must_use]
    pub fn is_worse_than_unchanged(&self) -> bool {
        self.unchanged.is_some_and(|unchanged| unchanged.value < self.after.value)
    }

    /// The smaller error of the rigid body's and that of a state that does not change, over the windows.
    #[must_use]
    pub fn better_baseline(&self) -> f64 {
        self.unchanged.map_or(self.before.value, |unchanged| unchanged.value.min(self.before.value))
    }

    /// Whether a state that does not change ends nearer than the final model, at the end of the windows.
    #[must_use]
    pub fn ends_worse_than_unchanged(&self) -> bool {
        self.at_end.is_some_and(|at_end| at_end.unchanged < at_end.after)
    }
}

/// Mean size of the error at the end of the windows, as benchmarks of multi-step prediction define it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AtEnd {
    /// of a state that does not change
    pub unchanged: f64,
    /// of the rigid body alone
    pub before: f64,
    /// of the model with effects
    pub after: f64,
}

/// Sums of squared errors over a stretch of flight, one entry a quantity.
#[derive(Debug, Clone, Copy)]
pub(super) struct Squares<'a> {
    /// of a state that does not change, where a state is predicted
    pub unchanged: Option<&'a [f64]>,
    /// of the rigid body alone
    pub before: &'a [f64],
    /// of the model with effects
    pub after: &'a [f64],
    /// instants
    pub count: &'a [f64],
}

/// Sums over one block of the flight, one entry a quantity.
#[derive(Debug, Clone)]
struct Block {
    /// flight and number of the block in it
    place: (usize, u64),
    unchanged: Option<Vec<f64>>,
    before: Vec<f64>,
    after: Vec<f64>,
    count: Vec<f64>,
}

/// Root mean square errors of one quantity.
#[derive(Debug, Clone, Copy)]
struct Root {
    unchanged: Option<f64>,
    before: f64,
    after: f64,
}

impl Root {
    /// Against the better one of what does not change and the rigid body alone.
    fn improvement_percent(&self) -> f64 {
        improvement_percent(
            self.unchanged.map_or(self.before, |unchanged| unchanged.min(self.before)),
            self.after,
        )
    }
}

/// Errors of each quantity; `None` if it was not measured.
type Roots = Vec<Option<Root>>;

/// Squared errors of several quantities gathered into blocks.
#[derive(Debug, Clone)]
pub(super) struct Blocks {
    quantities: usize,
    block_s: f64,
    blocks: Vec<Block>,
}

impl Blocks {
    pub(super) fn new(quantities: usize, block_s: f64) -> Self {
        Self { quantities, block_s, blocks: Vec::new() }
    }

    pub(super) fn len(&self) -> usize {
        self.blocks.len()
    }

    /// Errors at `time_s` of a flight.
    pub(super) fn add(&mut self, (flight, time_s): (usize, f64), squares: Squares<'_>) {
        // whole and small: as a key only
        let place = (flight, (time_s / self.block_s).floor().to_bits());
        if self.blocks.last().is_none_or(|block| block.place != place) {
            let zero = vec![0.0; self.quantities];
            let unchanged = squares.unchanged.map(|_| zero.clone());
            let block = Block { place, unchanged, before: zero.clone(), after: zero.clone(), count: zero };
            self.blocks.push(block);
        }
        if let Some(block) = self.blocks.last_mut() {
            let sum =
                |to: &mut Vec<f64>, more: &[f64]| to.iter_mut().zip(more).for_each(|(to, more)| *to += more);
            sum(&mut block.before, squares.before);
            sum(&mut block.after, squares.after);
            sum(&mut block.count, squares.count);
            if let (Some(to), Some(more)) = (&mut block.unchanged, squares.unchanged) {
                sum(to, more);
            }
        }
    }

    /// Errors of every quantity, and the mean of their improvements; `None` for a quantity that was not measured.
    pub(super) fn compared(&self, draws: usize, seed: u64) -> (Vec<Option<Compared>>, Option<Interval>) {
        let whole = self.roots(0..self.blocks.len());
        let mut drawn: Vec<Roots> = Vec::new();
        if self.blocks.len() >= LEAST_BLOCKS {
            drawn.extend(resamples(self.blocks.len(), draws, seed).map(|picks| self.roots(picks)));
        }
        let interval = |of: &dyn Fn(&Roots) -> Option<f64>| -> Option<Interval> {
            let value = of(&whole)?;
            let spread: Vec<f64> = drawn.iter().filter_map(of).collect();
            Some(Interval { value, range: percentiles_95(spread) })
        };
        let each = (0..self.quantities)
            .map(|quantity| {
                let of = |pick: fn(&Root) -> Option<f64>| {
                    interval(&|roots: &Roots| roots[quantity].as_ref().and_then(pick))
                };
                Some(Compared {
                    before: of(|root| Some(root.before))?,
                    after: of(|root| Some(root.after))?,
                    unchanged: of(|root| root.unchanged),
                    floor: None,
                    improvement_percent: of(|root| Some(root.improvement_percent()))?,
                    at_end: None,
                })
            })
            .collect();
        (each, interval(&mean_improvement))
    }

    fn roots(&self, picks: impl IntoIterator<Item = usize>) -> Roots {
        let mut sums = vec![[0.0; 4]; self.quantities];
        let mut state_is_predicted = true;
        for pick in picks {
            let block = &self.blocks[pick];
            state_is_predicted &= block.unchanged.is_some();
            for (quantity, [unchanged, before, after, count]) in sums.iter_mut().enumerate() {
                *unchanged += block.unchanged.as_ref().map_or(0.0, |squares| squares[quantity]);
                *before += block.before[quantity];
                *after += block.after[quantity];
                *count += block.count[quantity];
            }
        }
        let root = |[unchanged, before, after, count]: [f64; 4]| {
            let root = |sum: f64| (sum / count).sqrt();
            let unchanged = state_is_predicted.then(|| root(unchanged));
            (count > 0.0).then(|| Root { unchanged, before: root(before), after: root(after) })
        };
        sums.into_iter().map(root).collect()
    }
}

fn mean_improvement(roots: &Roots) -> Option<f64> {
    let each: Vec<f64> = roots.iter().flatten().map(Root::improvement_percent).collect();
    (!each.is_empty()).then(|| each.iter().sum::<f64>() / each.len() as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One quantity over 40 blocks whose squares are 1 before and `after` with a scatter.
    fn blocks(after: f64) -> Blocks {
        let mut blocks = Blocks::new(1, 2.0);
        for index in 0..40_u32 {
            let scatter = 0.2 * f64::from(index % 5) - 0.4;
            let time_s = 2.0 * f64::from(index) + 0.1;
            let (before, after) = ([1.0 + scatter], [after + scatter]);
            blocks
                .add((0, time_s), Squares { unchanged: None, before: &before, after: &after, count: &[1.0] });
        }
        blocks
    }

    #[test]
    fn paired_blocks_narrow_the_improvement() {
        let (each, mean) = blocks(0.81).compared(400, 1);
        let one = each[0].unwrap();
        assert!((one.before.value - 1.0).abs() < 1e-9 && (one.after.value - 0.9).abs() < 1e-9);
        assert!((one.improvement_percent.value - 10.0).abs() < 1e-6);
        let (low, high) = one.improvement_percent.range.unwrap();
        let (low_rms, high_rms) = one.before.range.unwrap();
        assert!(low > 9.0 && high < 11.5 && low < 10.0 && high > 10.0, "{low} {high}");
        // the figures themselves scatter by more than their ratio
        assert!(high_rms - low_rms > 0.05);
        assert_eq!(mean.unwrap().value, one.improvement_percent.value);
    }

    #[test]
    fn few_blocks_have_no_interval_and_nothing_has_no_figure() {
        let mut few = Blocks::new(2, 2.0);
        let unchanged = Some([9.0, 0.0].as_slice());
        let (before, after, count) = (&[4.0, 0.0], &[1.0, 0.0], &[1.0, 0.0]);
        few.add((0, 0.0), Squares { unchanged, before, after, count });
        let (each, _) = few.compared(100, 1);
        assert_eq!(each[0].unwrap().after, Interval { value: 1.0, range: None });
        assert!(each[1].is_none());
        assert_eq!(each[0].unwrap().improvement_percent.value, 50.0);
    }

    #[test]
    fn the_gain_is_against_the_better_baseline() {
        let mut blocks = Blocks::new(1, 2.0);
        let (unchanged, before, after, count) = (Some([4.0].as_slice()), &[100.0], &[1.0], &[1.0]);
        blocks.add((0, 0.0), Squares { unchanged, before, after, count });
        let one = blocks.compared(100, 1).0[0].unwrap();
        assert_eq!(one.unchanged.unwrap().value, 2.0);
        assert_eq!(one.improvement_percent.value, 50.0);
        assert!(!one.is_worse_than_unchanged());
        blocks.add((0, 0.0), Squares { unchanged: Some(&[0.0]), before, after: &[24.0], count });
        let one = blocks.compared(100, 1).0[0].unwrap();
        assert!(one.is_worse_than_unchanged() && one.improvement_percent.value < -100.0);
    }
}
