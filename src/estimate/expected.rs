//! The expected covariance of an estimate, from known noises.

use super::problem::{Normal, Problem};
use nalgebra::DMatrix;

/// A noise and the equations that it affects. A noise in several equations correlates their errors.
#[derive(Debug, Clone, PartialEq)]
pub struct NoiseTerm {
    /// over row lags from 0 on, zero beyond its end; its own unit squared
    pub autocovariance: Vec<f64>,
    /// channel, and its factor in each of the channel's rows, in units of the output over its own; empty if it is 1
    pub reaches: Vec<(usize, Vec<f64>)>,
    /// contribution of an offset that is estimated from the same rows, in parts of this noise's mean: -1 if the offset
    /// removes the mean, 0 if there is none
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
    /// The expected covariance over repeated flights, for known and independent noises. The rows are those of one
    /// flight: an offset that is estimated from them belongs to the flight.
    #[must_use]
    pub fn expected_covariance(&self, noise: &[NoiseTerm]) -> DMatrix<f64> {
        let shares: Vec<Normal> = (0..self.channels.len()).map(|index| self.normal_share(index)).collect();
        let sigma: Vec<f64> = (0..self.channels.len())
            .map(|channel| noise.iter().map(|term| term.variance(channel)).sum::<f64>().sqrt())
            .collect();
        let bread = Normal::weighted(&shares, &sigma, &self.priors).inverse();
        let mut meat = DMatrix::zeros(self.parameters(), self.parameters());
        for term in noise {
            let mut weighted: Option<DMatrix<f64>> = None;
            for (channel, factors) in &term.reaches {
                let mut rows = &self.channels[*channel].x / sigma[*channel].powi(2);
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
