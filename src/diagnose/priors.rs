//! Priors of the nuisance parameters, with their weight relative to the rows.

use super::channels::{Nuisance, NuisanceColumn, SECOND};
use nalgebra::DVector;

/// Rows of white noise that count as one independent measurement of something slow: one over the rows' distance and the
/// integral of the squared test function, 1 / (0.05 s x 4.54 1/s).
const OF_KERNEL: f64 = 4.4;

/// Rows of one reading that count as one independent measurement of something slow: those that overlap, or whose noise lasts.
#[derive(Debug, Clone, Copy)]
pub(super) struct Alike {
    /// mean of all channels
    pub(super) all: f64,
    /// mean of the torques
    pub(super) torques: f64,
}

impl Alike {
    /// Of rows whose noise is white.
    pub(super) const OF_WHITE_NOISE: Self = Self { all: OF_KERNEL, torques: OF_KERNEL };
    /// Of rows that are independent.
    pub(super) const ONE: Self = Self { all: 1.0, torques: 1.0 };

    /// Of the rows that tell a nuisance. Of a moment or product of inertia, those of the whole residual: the noise that a controller feeds
    /// back is an error of the motion, and the residual of the torques does not show how long it lasts.
    pub(super) fn of(self, nuisance: Nuisance) -> f64 {
        match nuisance {
            Nuisance::GuessedMomentAboutZ => self.torques,
            _ => self.all,
        }
    }
}

/// One entry a column of the rows: nuisances first, then the base's effects, which have no prior.
#[derive(Debug, Clone)]
pub(super) struct Priors {
    /// what is added to the diagonal of the normal matrix
    pub(super) precision: DVector<f64>,
    /// variance of what the prior adds to the score
    pub(super) meat: DVector<f64>,
    /// what is added to the score at zero: precision times mean
    pub(super) pull: DVector<f64>,
}

impl Priors {
    /// Of these nuisances among `columns` columns. Rows that overlap, noise that lasts, and a second reading that shares the error
    /// must not outvote what is known.
    pub(super) fn of(nuisances: &[NuisanceColumn], columns: usize, alike: Alike) -> Self {
        let zeros = || DVector::zeros(columns);
        let mut priors = Self { precision: zeros(), meat: zeros(), pull: zeros() };
        for (index, column) in nuisances.iter().enumerate() {
            let Some(std) = column.prior_std else { continue };
            let counts = match column.nuisance {
                Nuisance::VelocityError => alike.of(column.nuisance) * readings(column),
                Nuisance::Inertia(_) | Nuisance::GuessedMomentAboutZ => alike.of(column.nuisance),
                _ => 1.0,
            };
            priors.precision[index] = counts * std.powi(-2);
            priors.meat[index] = counts * priors.precision[index];
            priors.pull[index] = priors.precision[index] * column.prior_mean;
        }
        priors
    }
}

/// Readings of the force in which a column shows: one, or both of accelerometer and kinematics.
fn readings(column: &NuisanceColumn) -> f64 {
    let twice = column.values[SECOND..].iter().flatten().any(|value| *value != 0.0);
    if twice { 2.0 } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::super::channels::Channels;
    use super::*;

    #[test]
    fn a_slow_error_counts_for_each_reading_that_has_it() {
        let column = |second: f64| {
            let mut values: Channels = std::array::from_fn(|_| vec![0.0; 3]);
            values[0].fill(1.0);
            values[SECOND].fill(second);
            NuisanceColumn {
                first_row: 0,
                nuisance: Nuisance::VelocityError,
                values,
                prior_std: Some(0.5),
                prior_mean: 0.0,
                considered: None,
            }
        };
        let priors = Priors::of(&[column(0.0), column(1.0)], 3, Alike { all: 10.0, torques: 1.0 });
        assert_eq!(priors.precision.as_slice(), [40.0, 80.0, 0.0]);
        assert_eq!(priors.meat.as_slice(), [400.0, 1600.0, 0.0]);
    }
}
