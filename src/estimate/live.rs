//! Recursive least squares (40) in bounded memory, with the standard errors of the batch method.

use super::recursive::{LAGS, NormalEquations, SCORE_BLOCK_S, newey_west};
use super::result::Estimated;
use super::theta::{THETA, Theta};
use nalgebra::{SMatrix, Vector4};

/// Largest number of blocks. When all are full, neighbours are merged and blocks last twice as long. Of the live
/// view: twice as many cost twice the memory and show no more.
const BLOCKS: usize = 256;

/// Sums of (40), in total and by blocks of time. The blocks contain the data of the scores of any estimate, so that the
/// covariance allows for coloured residuals, as in the batch method.
#[derive(Debug, Clone)]
pub struct RecursiveEstimator {
    whole: NormalEquations,
    blocks: Vec<NormalEquations>,
    open: NormalEquations,
    rows_in_open: usize,
    rows_a_block: usize,
    /// blocks over which scores are correlated: a second
    lags: usize,
    rows: u64,
    scores: Vec<Theta>,
}

impl RecursiveEstimator {
    /// An estimator for rows with the distance `step_s` (s).
    #[must_use]
    pub fn new(step_s: f64) -> Self {
        let mut rows_a_block = 1;
        while (rows_a_block as f64) * step_s < SCORE_BLOCK_S {
            rows_a_block += 1;
        }
        Self {
            whole: NormalEquations::default(),
            blocks: Vec::with_capacity(BLOCKS),
            open: NormalEquations::default(),
            rows_in_open: 0,
            rows_a_block,
            lags: LAGS,
            rows: 0,
            scores: Vec::with_capacity(BLOCKS),
        }
    }

    /// Adds a row of `Gamma Theta = Upsilon` (N, N m).
    pub fn add(&mut self, gamma: &SMatrix<f64, 4, THETA>, upsilon: &Vector4<f64>) {
        self.whole.add(gamma, upsilon);
        self.open.add(gamma, upsilon);
        self.rows += 1;
        self.rows_in_open += 1;
        if self.rows_in_open >= self.rows_a_block {
            if self.blocks.len() == BLOCKS {
                self.put_neighbours_together();
            }
            self.blocks.push(std::mem::take(&mut self.open));
            self.rows_in_open = 0;
        }
    }

    /// Number of rows so far.
    #[must_use]
    pub fn rows(&self) -> u64 {
        self.rows
    }

    /// `Theta` of all rows so far with its covariance; `None` while the equations are singular.
    pub fn estimate(&mut self) -> Option<Estimated> {
        let theta = self.whole.solve()?;
        let inverse = self.whole.information.try_inverse()?;
        self.scores.clear();
        self.scores.extend(self.blocks.iter().map(|block| block.right - block.information * theta));
        let meat = newey_west(&self.scores, self.lags);
        let covariance = inverse * meat * inverse.transpose();
        Some(Estimated {
            theta,
            covariance,
            explained: None,
            by_wider_window: None,
            by_guessed_curve: None,
            torque_exponent: None,
        })
    }

    fn put_neighbours_together(&mut self) {
        for pair in 0..BLOCKS / 2 {
            let second = self.blocks[2 * pair + 1];
            self.blocks[pair] = self.blocks[2 * pair];
            self.blocks[pair].merge(&second);
        }
        self.blocks.truncate(BLOCKS / 2);
        // the block that is about to be kept is half as long as those to come: one among many
        self.rows_a_block *= 2;
        self.lags = (self.lags / 2).max(1);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::estimate::least_squares;
    use crate::regression::{Phi, SampledModel};
    use nalgebra::{SVector, Vector3};

    /// Coloured residuals on a lively motion, `count` rows of 10 ms.
    fn model(count: u32) -> SampledModel {
        let truth = SVector::from([1.82, 0.0075, -0.0005, 0.0, 0.0098, -0.001, 0.0513]);
        let mut model = SampledModel { step_s: 0.01, ..SampledModel::default() };
        let mut colour = Vector4::zeros();
        for i in 0..count {
            let t = f64::from(i) * model.step_s;
            let hash = |salt: u32| {
                let mixed = (i ^ salt.rotate_left(16)).wrapping_mul(0x9E37_79B9).rotate_left(13);
                f64::from(mixed.wrapping_mul(0x85EB_CA6B) >> 8) / f64::from(1_u32 << 24) - 0.5
            };
            colour = 0.9 * colour + Vector4::new(hash(1), 0.01 * hash(2), 0.01 * hash(3), 0.01 * hash(4));
            let wave = |f: f64, phase: f64| (f * t + phase).sin();
            let gamma = Phi::of(
                9.81 + 0.3 * wave(2.0, 0.1),
                &Vector3::new(0.5 * wave(2.5, 0.0), 0.5 * wave(3.1, 1.0), 0.4 * wave(1.3, 2.0)),
                &Vector3::new(1.5 * wave(2.5, 1.6), 1.5 * wave(3.1, 2.6), 0.8 * wave(1.3, 3.6)),
            );
            model.time_s.push(t);
            model.gamma.push(gamma);
            model.upsilon.push(gamma.matrix() * truth + colour);
        }
        model.runs.push(0..model.time_s.len());
        model
    }

    #[test]
    fn it_is_the_batch_estimate_with_its_standard_errors() {
        // 20 s: blocks are still whole; 100 s: they were put together twice
        for (count, tolerance) in [(2_000, 1e-9), (10_000, 0.25)] {
            let model = model(count);
            let batch = least_squares(&model).unwrap();
            let mut recursive = RecursiveEstimator::new(model.step_s);
            for (gamma, upsilon) in model.gamma.iter().zip(&model.upsilon) {
                recursive.add(&gamma.matrix(), upsilon);
            }
            let estimate = recursive.estimate().unwrap();
            assert_eq!(recursive.rows(), u64::from(count));
            assert!((estimate.theta - batch.theta).norm() < 1e-9);
            for i in 0..THETA {
                let ratio = (estimate.covariance[(i, i)] / batch.covariance[(i, i)]).sqrt();
                assert!((ratio - 1.0).abs() < tolerance, "{count} rows, parameter {i}: {ratio}");
            }
        }
    }

    #[test]
    fn nothing_is_said_of_too_few_rows() {
        let mut recursive = RecursiveEstimator::new(0.01);
        assert!(recursive.estimate().is_none());
        let model = model(1);
        recursive.add(&model.gamma[0].matrix(), &model.upsilon[0]);
        assert!(recursive.estimate().is_none());
    }
}
