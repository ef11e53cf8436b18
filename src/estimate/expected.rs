//! The covariance that an estimate will have, from noises that are known before it is made.

use super::problem::{Channel, Normal, Problem};
use nalgebra::DMatrix;

/// One noise, and the equations whose rows it reaches: what reaches several makes their errors go together.
#[derive(Debug, Clone, PartialEq)]
pub struct NoiseTerm {
    /// over row lags from 0 on, zero beyond its end; its own unit squared
    pub autocovariance: Vec<f64>,
    /// channel, and the factor by which it comes into each of its rows, the output's unit over its own; empty where that is 1
    pub reaches: Vec<(usize, Vec<f64>)>,
    /// what an offset that is estimated from the same rows adds to each of them, in parts of this noise's mean: -1 where it
    /// takes the mean away, 0 where there is none
    pub of_mean: f64,
}

impl NoiseTerm {
    /// Mean variance of a channel's row.
    fn variance(&self, channel: usize) -> f64 {
        let mean_square = |factors: &[f64]| {
            let square = factors.iter().map(|a| a * a).sum::<f64>();
            if factors.is_empty() { 1.0 } else { square / factors.len() as f64 }
        };
        let reached = self.reaches.iter().filter(|(reached, _)| *reached == channel);
        let share: f64 = reached.map(|(_, factors)| mean_square(factors)).sum();
        share * self.autocovariance.first().copied().unwrap_or(0.0)
    }
}

impl Problem {
    /// The covariance that the estimate will have over repeated flights, for noises that are known and independent. The rows
    /// are those of one flight: an offset that is estimated from them is the flight's.
    #[must_use]
    pub fn expected_covariance(&self, noise: &[NoiseTerm]) -> DMatrix<f64> {
        let shares: Vec<Normal> =
            (0..self.channels.len()).map(|index| self.normal_share(index, None)).collect();
        let sigma: Vec<f64> = (0..self.channels.len())
            .map(|channel| noise.iter().map(|term| term.variance(channel)).sum::<f64>().sqrt())
            .collect();
        let bread = Normal::weighted(&shares, &sigma, &self.priors).inverse();
        let mut meat = DMatrix::zeros(self.parameters(), self.parameters());
        for term in noise {
            let mut weighted: Option<DMatrix<f64>> = None;
            for (channel, factors) in &term.reaches {
                let Channel { x, z, .. } = &self.channels[*channel];
                let mut rows = z.as_ref().unwrap_or(x) / sigma[*channel].powi(2);
                for mut column in rows.column_iter_mut() {
                    let mean = column.mean();
                    column.add_scalar_mut(term.of_mean * mean);
                }
                for (mut row, factor) in rows.row_iter_mut().zip(factors) {
                    row *= *factor;
                }
                weighted = Some(weighted.map_or_else(|| rows.clone(), |sum| sum + &rows));
            }
            if let Some(weighted) = weighted {
                meat += self.meat_of(&weighted, &term.autocovariance);
            }
        }
        &bread * meat * bread.transpose()
    }
}
