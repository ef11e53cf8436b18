//! What the reconstructed paths of all flights tell together.

use crate::reconstruction::{Fit, Term};
use nalgebra::{DMatrix, DVector};

/// Scale and free values of all flights: each flight weighted by its information.
pub(super) struct PooledEstimate {
    /// scale of the thrust over mass first, then the free values of the effects
    pub(super) values: DVector<f64>,
    /// of the values
    pub(super) covariance: DMatrix<f64>,
}

impl PooledEstimate {
    pub(super) fn std(&self, index: usize) -> f64 {
        self.covariance[(index, index)].max(0.0).sqrt()
    }

    /// The estimates where some of them are held at these values: the others move with them by what they have in common, and are as
    /// certain as they are then. Those that are held keep their standard errors. `None` where their covariance is singular.
    pub(super) fn held_at(&self, held: &[(usize, f64)]) -> Option<Self> {
        if held.is_empty() {
            return Some(Self { values: self.values.clone(), covariance: self.covariance.clone() });
        }
        let places: Vec<usize> = held.iter().map(|(at, _)| *at).collect();
        let moved = held.iter().map(|(at, value)| value - self.values[*at]);
        let moved = DVector::from_iterator(held.len(), moved);
        let with = self.covariance.select_columns(&places);
        let gain = &with * with.select_rows(&places).try_inverse()?;
        let mut values = &self.values + &gain * moved;
        let mut covariance = &self.covariance - &gain * with.transpose();
        for &(at, value) in held {
            values[at] = value;
            covariance.row_mut(at).fill(0.0);
            covariance.column_mut(at).fill(0.0);
            covariance[(at, at)] = self.covariance[(at, at)];
        }
        Some(Self { values, covariance })
    }

    pub(super) fn of(fits: &[Fit], terms: &[Term]) -> Option<Self> {
        let count = 1 + terms.iter().map(|term| term.free.len()).sum::<usize>();
        let mut information = DMatrix::zeros(count, count);
        let mut weighted = DVector::zeros(count);
        for fit in fits {
            let (values, covariance) = fit.scale_and_effects();
            let inverse = covariance.try_inverse()?;
            weighted += &inverse * values;
            information += inverse;
        }
        let covariance = information.try_inverse()?;
        Some(Self { values: &covariance * weighted, covariance })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_held_moves_what_it_has_in_common_with_others() {
        // -0.20 +- 0.15 and 0.50 +- 0.10, with a correlation of -0.95
        let covariance = DMatrix::from_row_slice(2, 2, &[0.0225, -0.014_25, -0.014_25, 0.01]);
        let estimate = PooledEstimate { values: DVector::from_vec(vec![-0.2, 0.5]), covariance };
        let held = estimate.held_at(&[(0, 0.0)]).expect("regular");
        // 0.5 - 0.2 * 0.01425 / 0.0225, and 0.1 * sqrt(1 - 0.95^2)
        assert!((held.values[1] - 0.373_333).abs() < 1e-6 && held.values[0] == 0.0, "{}", held.values);
        assert!((held.std(1) - 0.031_225).abs() < 1e-6 && (held.std(0) - 0.15).abs() < 1e-12);
        assert_eq!(held.covariance[(0, 1)], 0.0);
        assert_eq!(estimate.held_at(&[]).expect("regular").values, estimate.values);
    }
}
