//! Errors of two models on the same stretches of flight, with intervals from resampled blocks.

use crate::compare::improvement_percent;
use crate::stats::{percentiles_95, resamples};

/// Least number of blocks for an interval. Chosen; not measured.
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
    /// error that the right model would have, if that can be estimated
    pub floor: Option<f64>,
    /// `100 (1 - after/before)`, with the same resampled blocks for both
    pub improvement_percent: Interval,
}

/// Sums over one block of the flight, one entry a quantity.
#[derive(Debug, Clone)]
struct Block {
    /// flight and number of the block in it
    place: (usize, u64),
    before: Vec<f64>,
    after: Vec<f64>,
    count: Vec<f64>,
}

/// Errors before and after of each quantity; `None` if it was not measured.
type Roots = Vec<Option<(f64, f64)>>;

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

    /// Sums of squares `before` and `after` over `count` instants at `time_s` of a flight.
    pub(super) fn add(
        &mut self,
        (flight, time_s): (usize, f64),
        before: &[f64],
        after: &[f64],
        count: &[f64],
    ) {
        // whole and small: as a key only
        let place = (flight, (time_s / self.block_s).floor().to_bits());
        if self.blocks.last().is_none_or(|block| block.place != place) {
            let zero = vec![0.0; self.quantities];
            let block = Block { place, before: zero.clone(), after: zero.clone(), count: zero };
            self.blocks.push(block);
        }
        if let Some(block) = self.blocks.last_mut() {
            for quantity in 0..self.quantities {
                block.before[quantity] += before[quantity];
                block.after[quantity] += after[quantity];
                block.count[quantity] += count[quantity];
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
                Some(Compared {
                    before: interval(&|roots| roots[quantity].map(|(before, _)| before))?,
                    after: interval(&|roots| roots[quantity].map(|(_, after)| after))?,
                    floor: None,
                    improvement_percent: interval(&|roots| {
                        roots[quantity].map(|(before, after)| improvement_percent(before, after))
                    })?,
                })
            })
            .collect();
        (each, interval(&mean_improvement))
    }

    fn roots(&self, picks: impl IntoIterator<Item = usize>) -> Roots {
        let mut sums = vec![[0.0; 3]; self.quantities];
        for pick in picks {
            let block = &self.blocks[pick];
            for (quantity, [before, after, count]) in sums.iter_mut().enumerate() {
                *before += block.before[quantity];
                *after += block.after[quantity];
                *count += block.count[quantity];
            }
        }
        let root = |[before, after, count]: [f64; 3]| {
            (count > 0.0).then(|| ((before / count).sqrt(), (after / count).sqrt()))
        };
        sums.into_iter().map(root).collect()
    }
}

fn mean_improvement(roots: &Roots) -> Option<f64> {
    let each: Vec<f64> =
        roots.iter().flatten().map(|(before, after)| improvement_percent(*before, *after)).collect();
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
            blocks.add((0, time_s), &[1.0 + scatter], &[after + scatter], &[1.0]);
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
        few.add((0, 0.0), &[4.0, 0.0], &[1.0, 0.0], &[1.0, 0.0]);
        let (each, _) = few.compared(100, 1);
        assert_eq!(each[0].unwrap().after, Interval { value: 1.0, range: None });
        assert!(each[1].is_none());
    }
}
