//! The nuisances' priors, as they weigh against the rows.

use super::channels::{Nuisance, NuisanceColumn};
use nalgebra::DVector;

/// Rows of white noise that count as one independent measurement of something slow: one over the rows' distance and the
/// integral of the squared test function, 1 / (0.05 s x 4.54 1/s).
pub(super) const OF_KERNEL: f64 = 4.4;
/// Readings of the force that share the error of the airspeed: accelerometer and kinematics.
pub(super) const READINGS: f64 = 2.0;

/// One entry a column of the rows: nuisances first, then the base's effects, which have no prior.
#[derive(Debug, Clone)]
pub(super) struct Priors {
    /// what is added to the diagonal of the normal matrix
    pub(super) precision: DVector<f64>,
    /// variance of what the prior adds to the score
    pub(super) meat: DVector<f64>,
}

impl Priors {
    /// Of these nuisances among `columns` columns. `alike` rows count as one independent measurement of a slow error: rows
    /// that overlap, and noise that lasts, must not outvote what is known of it.
    pub(super) fn of(nuisances: &[NuisanceColumn], columns: usize, alike: f64) -> Self {
        let mut priors = Self { precision: DVector::zeros(columns), meat: DVector::zeros(columns) };
        for (index, column) in nuisances.iter().enumerate() {
            let Some(std) = column.prior_std else { continue };
            let counts = if column.nuisance == Nuisance::VelocityError { alike } else { 1.0 };
            priors.precision[index] = counts * std.powi(-2);
            priors.meat[index] = counts * priors.precision[index];
        }
        priors
    }
}
