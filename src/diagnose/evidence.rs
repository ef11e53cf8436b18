//! The part of the residual that a column explains beyond the nuisances, with its uncertainty.
//!
//! The variance of a coefficient comes from the flight's own residual: the autocovariance of each channel, or the
//! autocovariance of the scores (Newey-West), whichever is larger. Unexplained physics enlarges it, so the evidence is
//! conservative if the model is wrong.

use super::channels::{AXES, CHANNELS, Channels, SECOND};
use super::columns::Columns;
use super::priors::{Alike, Priors};
use super::rows::Rows;
use crate::stats::{chance_by_stretches, normal_deviate};
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};
use rayon::prelude::*;
use std::ops::Range;

/// Least number of rows for the cluster test over twelve blocks. Set by judgement: ten rows a block.
pub(super) const LEAST_ROWS: usize = 120;
/// Time from row to row that lengths of flights are stated with, s: twenty rows a second.
pub(super) const ROW_S: f64 = 0.05;
/// Least usable time of flight for a search of effects, s: so many rows.
pub const LEAST_FLIGHT_S: f64 = LEAST_ROWS as f64 * ROW_S;

/// Rows weighted by each channel's residual, and the nuisances' projection.
#[derive(Debug, Clone)]
pub struct Weighted {
    /// rows without a break between them
    pub(super) runs: Vec<Range<usize>>,
    /// the same at which each channel is measured
    pub(super) measured: [Vec<Range<usize>>; CHANNELS],
    pub(super) rows: usize,
    /// torques are averaged: their residual is correlated by that
    averaged_torques: bool,
    /// residual standard deviation of each channel, N and N m
    pub sigma: [f64; CHANNELS],
    /// nuisances and the base's own effects, weighted
    pub(super) nuisances: Columns,
    /// variance of the scores by the priors
    prior_meat: DVector<f64>,
    /// what the priors' means add to the score
    prior_pull: DVector<f64>,
    pub(super) normal: Option<Cholesky<f64, Dyn>>,
    /// residual without the part of the nuisances, weighted
    pub left: DVector<f64>,
    /// residual energy in units of sigma squared
    pub energy: f64,
}

/// Estimates of a candidate's coefficients, with their significance.
#[derive(Debug, Clone, PartialEq)]
pub struct Evidence {
    /// coefficients, SI
    pub theta: Vec<f64>,
    /// covariance
    pub covariance: DMatrix<f64>,
    /// normal deviate with the p-value of the coefficients' Wald statistic
    pub z: f64,
    /// p-value of the cluster test over twelve blocks
    pub p_cluster: f64,
    /// share of the residual energy that it explains (0..1)
    pub gain: f64,
    /// energy that it explains, in sigma squared
    pub energy: f64,
    /// root mean square of its contribution without the part of the nuisances, each channel, N and N m
    pub rms: [f64; CHANNELS],
    /// the same of one unit of each coefficient
    pub unit_rms: Vec<[f64; CHANNELS]>,
}

impl Evidence {
    /// Norm of the coefficients, in their unit.
    #[must_use]
    pub fn size(&self) -> f64 {
        self.theta.iter().map(|value| value * value).sum::<f64>().sqrt()
    }

    /// Standard error of one coefficient.
    #[must_use]
    pub fn std(&self, index: usize) -> f64 {
        self.covariance[(index, index)].max(0.0).sqrt()
    }
}

impl Weighted {
    /// Removes the nuisances and the base's own effects from the residual by projection. Each channel is weighted by
    /// its residual.
    #[must_use]
    pub fn new(rows: &Rows) -> Self {
        let first: [f64; CHANNELS] = std::array::from_fn(|channel| spread(rows, channel));
        let columns = Columns::weighted(&rows.nuisances, &rows.effects, &first, rows.len());
        // other standard deviations only scale the products of each channel
        let products = columns.products();
        let gram = products.gram(&[1.0; CHANNELS]);
        let mut this = Self::of(rows, (&first, Alike::OF_WHITE_NOISE), columns, gram);
        for _ in 0..2 {
            let (sigma, alike) = (this.residual_sigma(), this.alike());
            let columns = this.nuisances.scaled(&factors(&this.sigma, &sigma));
            this = Self::of(rows, (&sigma, alike), columns, products.gram(&factors(&first, &sigma)));
        }
        this
    }

    /// The same with given standard deviations of the channels (N, N m), for simulated flights.
    #[must_use]
    pub fn at(rows: &Rows, sigma: &[f64; CHANNELS]) -> Self {
        Self::with(rows, sigma, Alike::OF_WHITE_NOISE)
    }

    /// The same with the standard deviations and the correlation of other rows' residual.
    pub(super) fn like(rows: &Rows, other: &Self) -> Self {
        Self::with(rows, &other.sigma, other.alike())
    }

    /// The same by the first reading of the force alone.
    pub(super) fn by_first_reading(rows: &Rows, other: &Self) -> Self {
        let mut sigma = other.sigma;
        sigma[SECOND..].fill(0.0);
        Self::with(rows, &sigma, other.alike())
    }

    /// The same without a channel.
    pub(super) fn without(rows: &Rows, other: &Self, channel: usize) -> Self {
        let mut sigma = other.sigma;
        sigma[channel] = 0.0;
        Self::with(rows, &sigma, other.alike())
    }

    /// By the forces alone.
    pub(super) fn by_forces(rows: &Rows, other: &Self) -> Self {
        let mut sigma = other.sigma;
        sigma[3..AXES].fill(0.0);
        Self::with(rows, &sigma, other.alike())
    }

    /// The same if so many rows of a reading count as one independent measurement.
    fn with(rows: &Rows, sigma: &[f64; CHANNELS], alike: Alike) -> Self {
        let columns = Columns::weighted(&rows.nuisances, &rows.effects, sigma, rows.len());
        let gram = columns.products().gram(&[1.0; CHANNELS]);
        Self::of(rows, (sigma, alike), columns, gram)
    }

    /// The same with the weighted columns and the products of each two of them.
    fn of(
        rows: &Rows,
        (sigma, alike): (&[f64; CHANNELS], Alike),
        nuisances: Columns,
        gram: DMatrix<f64>,
    ) -> Self {
        let priors = Priors::of(&rows.nuisances, nuisances.len(), alike);
        let mut normal = gram + DMatrix::from_diagonal(&priors.precision);
        // a column that is nowhere excited drops out
        let most = normal.diagonal().max();
        for index in 0..normal.nrows() {
            if normal[(index, index)] <= 1e-14 * most {
                normal[(index, index)] += 1.0;
            }
        }
        let mut this = Self {
            runs: rows.runs.clone(),
            measured: rows.measured.clone(),
            rows: rows.len(),
            averaged_torques: !rows.compares_torques,
            sigma: *sigma,
            nuisances,
            prior_meat: priors.meat,
            prior_pull: priors.pull,
            normal: normal.cholesky(),
            left: DVector::zeros(0),
            energy: 0.0,
        };
        let y = weighted(&rows.residual, sigma);
        this.left = this.project(&y);
        if let Some(part) = this.by_prior_means() {
            this.left -= part;
        }
        this.energy = this.left.dot(&y);
        this
    }

    /// The part of the rows, weighted, that the priors' means alone bring into the coefficients; `None`: they are zero.
    fn by_prior_means(&self) -> Option<DVector<f64>> {
        let normal = self.normal.as_ref().filter(|_| self.prior_pull.iter().any(|pull| *pull != 0.0))?;
        Some(self.nuisances.times(&normal.solve(&self.prior_pull)))
    }

    /// Residual of a channel (N, N m) without the part of the nuisances.
    #[must_use]
    pub fn left_of(&self, channel: usize) -> Vec<f64> {
        let part = self.left.rows(channel * self.rows, self.rows);
        part.iter().map(|value| value * self.sigma[channel]).collect()
    }

    /// Number of rows at which a channel is measured.
    #[must_use]
    pub fn count_of(&self, channel: usize) -> usize {
        self.measured[channel].iter().map(ExactSizeIterator::len).sum()
    }

    /// Standard deviations of the residual of each channel.
    fn residual_sigma(&self) -> [f64; CHANNELS] {
        std::array::from_fn(|channel| {
            let part = self.left.rows(channel * self.rows, self.rows);
            let std = (part.norm_squared() / self.count_of(channel).max(1) as f64).sqrt();
            if std > 0.0 { self.sigma[channel] * std } else { self.sigma[channel] }
        })
    }

    /// Factor of correlated noise on standard deviations, relative to independent rows: the square root of the
    /// residual's long-run variance, mean of the channels.
    #[must_use]
    pub fn long_run_deviation(&self) -> f64 {
        self.alike().all.sqrt()
    }

    /// Rows of the residual that count as one independent measurement: its long-run variance relative to independent rows.
    pub(super) fn alike(&self) -> Alike {
        let variance = |channel: usize| {
            if self.averaged_torques && (3..AXES).contains(&channel) {
                return None;
            }
            let gamma = self.gamma(&self.left, channel);
            (gamma[0] > 0.0).then(|| (gamma[0] + 2.0 * gamma[1..].iter().sum::<f64>()).max(gamma[0]))
        };
        let variances: Vec<Option<f64>> = (0..CHANNELS).into_par_iter().map(variance).collect();
        let mean = |channels: &[Option<f64>]| {
            let used = || channels.iter().flatten();
            (used().sum::<f64>() / used().count().max(1) as f64).max(1.0)
        };
        Alike { all: mean(&variances), torques: mean(&variances[3..AXES]) }
    }

    /// Coefficients of the nuisances and of the base's effects, in the order of the rows' columns.
    pub(super) fn values(&self, rows: &Rows) -> DVector<f64> {
        let y = weighted(&rows.residual, &self.sigma);
        match &self.normal {
            Some(normal) => normal.solve(&(self.nuisances.transposed_times(y.as_slice()) + &self.prior_pull)),
            None => DVector::zeros(self.nuisances.len()),
        }
    }

    /// The same and their covariance.
    #[must_use]
    pub fn coefficients(&self, rows: &Rows) -> (DVector<f64>, DMatrix<f64>) {
        let size = self.nuisances.len();
        let theta = self.values(rows);
        let Some(normal) = &self.normal else {
            return (theta, DMatrix::from_diagonal_element(size, size, f64::INFINITY));
        };
        let bread = normal.inverse();
        let prior = DMatrix::from_diagonal(&self.prior_meat);
        let mut covariance = self.sandwich(&bread, &self.nuisances, &self.left, &prior);
        for (index, column) in rows.nuisances.iter().enumerate() {
            let Some(considered) = &column.considered else { continue };
            // what one unit of its error brings into the others (consider covariance)
            let mut brings = self.part_in(&weighted(considered, &self.sigma));
            brings[index] = 0.0;
            let variance = covariance[(index, index)];
            covariance += &brings * brings.transpose() * variance;
        }
        (theta, covariance)
    }

    /// Squared norm of the part of a column that no other column explains, weighted; the columns as in [`Self::coefficients`].
    pub(super) fn own(&self, index: usize) -> Option<f64> {
        let mut unit = DVector::zeros(self.nuisances.len());
        unit[index] = 1.0;
        Some(self.normal.as_ref()?.solve(&unit)[index].recip())
    }

    /// Coefficients of the nuisances and of the base's effects in the projection of a weighted column.
    pub(super) fn part_in(&self, column: &DVector<f64>) -> DVector<f64> {
        let part = self.nuisances.transposed_times(column.as_slice());
        self.normal.as_ref().map_or_else(|| DVector::zeros(part.len()), |normal| normal.solve(&part))
    }

    /// A column without the part that the nuisances explain.
    pub(super) fn project(&self, column: &DVector<f64>) -> DVector<f64> {
        match &self.normal {
            Some(normal) => {
                let part = self.nuisances.transposed_times(column.as_slice());
                column - self.nuisances.times(&normal.solve(&part))
            }
            None => column.clone(),
        }
    }

    /// Columns after weighting and after projection.
    #[must_use]
    pub fn partialled(&self, columns: &[Channels]) -> Option<(DMatrix<f64>, DMatrix<f64>)> {
        let plain: Vec<DVector<f64>> = columns.iter().map(|column| weighted(column, &self.sigma)).collect();
        let partialled: Vec<DVector<f64>> = plain.iter().map(|column| self.project(column)).collect();
        // what the nuisances explain all but entirely says nothing
        let seen = plain.iter().zip(&partialled).all(|(plain, partialled)| {
            plain.norm_squared() > 0.0 && partialled.norm_squared() > 1e-6 * plain.norm_squared()
        });
        let put_together = |columns: Vec<DVector<f64>>| DMatrix::from_columns(&columns);
        seen.then(|| (put_together(plain), put_together(partialled)))
    }

    /// Tests columns. `None` if they cannot be distinguished from the nuisances or from each other.
    #[must_use]
    pub fn test(&self, columns: &[Channels]) -> Option<Evidence> {
        let (plain, partialled) = self.partialled(columns)?;
        let normal = plain.tr_mul(&partialled);
        let normal = 0.5 * (&normal + normal.transpose());
        let inverse = normal.clone().cholesky()?.inverse();
        let theta = &inverse * plain.tr_mul(&self.left);
        let energy = theta.dot(&(&normal * &theta));
        let after = &self.left - &partialled * &theta;
        let prior = self.prior_part(&plain);
        let gamma = self.gammas(&after);
        let tested = Columns::of(&partialled, self.rows);
        let scores = tested.scores(after.as_slice());
        let by_residual = &inverse * (self.meat_of_residual(&tested, &gamma) + &prior) * &inverse;
        let by_score = &inverse * (self.meat_of_scores(&scores, &gamma) + &prior) * &inverse;
        let larger = scaled_trace(&by_residual, &normal) > scaled_trace(&by_score, &normal);
        let covariance = if larger { by_residual } else { by_score };
        let size = columns.len();
        let wald = covariance.clone().cholesky().map_or(0.0, |c| theta.dot(&c.solve(&theta)));
        Some(Evidence {
            z: normal_deviate(wald, size),
            p_cluster: chance_by_stretches(&scores.transposed(), &inverse, &theta),
            gain: energy / self.energy.max(f64::MIN_POSITIVE),
            energy,
            rms: self.rms((&partialled * &theta).as_slice()),
            unit_rms: partialled.column_iter().map(|column| self.rms(column.as_slice())).collect(),
            theta: theta.iter().copied().collect(),
            covariance,
        })
    }

    /// Normal deviate of the columns from `first` on, given those before.
    #[must_use]
    pub fn conditional(&self, columns: &[Channels], first: usize) -> Option<f64> {
        let all = self.test(columns)?;
        let size = columns.len() - first;
        let theta = DVector::from_iterator(size, all.theta[first..].iter().copied());
        let covariance = all.covariance.view((first, first), (size, size)).into_owned();
        Some(normal_deviate(theta.dot(&covariance.cholesky()?.solve(&theta)), size))
    }

    /// Root mean square of a weighted series over the rows at which each channel is measured, N and N m.
    pub(super) fn rms(&self, series: &[f64]) -> [f64; CHANNELS] {
        std::array::from_fn(|channel| {
            let part = &series[channel * self.rows..(channel + 1) * self.rows];
            let squares: f64 = part.iter().map(|value| value * value).sum();
            (squares / self.count_of(channel).max(1) as f64).sqrt() * self.sigma[channel]
        })
    }

    /// Contribution of the priors' variance to the variance of the scores.
    fn prior_part(&self, plain: &DMatrix<f64>) -> DMatrix<f64> {
        let size = plain.ncols();
        let Some(normal) = &self.normal else { return DMatrix::zeros(size, size) };
        // X' M Z = X'Z A^-1 P
        let cross = normal.solve(&self.nuisances.transposed_times_each(plain));
        let mut out = DMatrix::zeros(size, size);
        for (index, variance) in self.prior_meat.iter().enumerate().filter(|(_, p)| **p > 0.0) {
            let row = cross.row(index);
            out += row.transpose() * row * *variance;
        }
        out
    }
}

/// Sum of a covariance's diagonal in units of the information about each parameter.
fn scaled_trace(covariance: &DMatrix<f64>, normal: &DMatrix<f64>) -> f64 {
    covariance.diagonal().dot(&normal.diagonal())
}

/// The channels one after another, each divided by its sigma.
pub(super) fn weighted(column: &Channels, sigma: &[f64; CHANNELS]) -> DVector<f64> {
    let count = column[0].len();
    let mut out = DVector::zeros(CHANNELS * count);
    let each = out.as_mut_slice().chunks_exact_mut(count.max(1)).zip(column).zip(sigma);
    for ((to, values), sigma) in each.filter(|(_, sigma)| **sigma > 0.0) {
        let weight = 1.0 / sigma;
        to.iter_mut().zip(values).for_each(|(to, value)| *to = value * weight);
    }
    out
}

/// Factors of the weighted channels from one set of their standard deviations to another; 1 where there is none.
fn factors(from: &[f64; CHANNELS], to: &[f64; CHANNELS]) -> [f64; CHANNELS] {
    std::array::from_fn(|channel| if to[channel] > 0.0 { from[channel] / to[channel] } else { 1.0 })
}

/// Standard deviation of a channel's residual about its mean, over the rows at which it is measured.
fn spread(rows: &Rows, channel: usize) -> f64 {
    let values = || rows.measured[channel].iter().flat_map(|run| &rows.residual[channel][run.clone()]);
    let count = rows.count_of(channel).max(1) as f64;
    let mean = values().sum::<f64>() / count;
    (values().map(|value| (value - mean).powi(2)).sum::<f64>() / count).sqrt()
}

#[cfg(test)]
#[path = "evidence_tests.rs"]
mod tests;
