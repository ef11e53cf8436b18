//! How the errors of estimates go together.

use crate::diagnose::{Fitted, Nuisance};
use crate::estimate::{MethodResult, NAMES, THETA};
use nalgebra::DMatrix;

/// Correlation of everything that was estimated at once.
#[derive(Debug, Clone, PartialEq)]
pub struct Correlation {
    /// names in the order of rows and columns
    pub names: Vec<String>,
    /// row by row, -1 to 1; `None` where there is none
    pub rows: Vec<Vec<Option<f64>>>,
}

impl Correlation {
    /// Of mass, inertia, latency and effects.
    #[must_use]
    pub fn of_fit(fitted: &Fitted) -> Self {
        let mut kept: Vec<(usize, String)> = Vec::new();
        for (index, column) in fitted.rows.nuisances.iter().enumerate() {
            let name = match column.nuisance {
                // a weighed mass has no error
                Nuisance::Mass if fitted.base.weighed_kg.is_some() => continue,
                Nuisance::Mass => NAMES[0].to_owned(),
                Nuisance::Inertia(entry) => NAMES[1 + entry].to_owned(),
                Nuisance::Latency => "latency".to_owned(),
                _ => continue,
            };
            kept.push((index, name));
        }
        let mut index = fitted.rows.nuisances.len();
        for present in &fitted.base.effects {
            for &free in &present.free {
                let parameter = present.parameter(free).map_or("", |parameter| parameter.name);
                kept.push((index, format!("{}.{parameter}", present.id())));
                index += 1;
            }
        }
        let places: Vec<usize> = kept.iter().map(|(index, _)| *index).collect();
        let rows = rows(&places, |i, j| fitted.covariance[(i, j)]);
        Self { names: kept.into_iter().map(|(_, name)| name).collect(), rows }
    }

    /// Of mass and inertia by one method.
    #[must_use]
    pub fn of_method(result: &MethodResult) -> Self {
        let places: Vec<usize> = (0..THETA).collect();
        let rows = rows(&places, |i, j| result.estimated.covariance[(i, j)]);
        Self { names: NAMES.map(str::to_owned).to_vec(), rows }
    }
}

fn rows(places: &[usize], covariance: impl Fn(usize, usize) -> f64) -> Vec<Vec<Option<f64>>> {
    let of = |i: usize, j: usize| {
        let r = covariance(i, j) / (covariance(i, i) * covariance(j, j)).sqrt();
        r.is_finite().then_some(r)
    };
    possible(places.iter().map(|i| places.iter().map(|j| of(*i, *j)).collect()).collect())
}

/// Least variance, over those of the parameters, that a combination of them has: with less, four written digits may have a negative one.
const LEAST: f64 = 1e-3;

/// Correlations that errors can have. Forces and torques are estimated one after the other, and what both bear on has its covariance from
/// one of them. All correlations are then brought towards none by the same share, until each combination of the parameters has a
/// variance. The standard errors stay.
fn possible(mut rows: Vec<Vec<Option<f64>>>) -> Vec<Vec<Option<f64>>> {
    let count = rows.len();
    let all = DMatrix::from_fn(count, count, |i, j| if i == j { 1.0 } else { rows[i][j].unwrap_or(0.0) });
    let least = all.symmetric_eigenvalues().iter().copied().fold(1.0, f64::min);
    if least < LEAST {
        let left = (1.0 - LEAST) / (1.0 - least);
        for (i, row) in rows.iter_mut().enumerate() {
            for (_, of) in row.iter_mut().enumerate().filter(|(j, _)| *j != i) {
                *of = of.map(|of| left * of);
            }
        }
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(matrix: [[f64; 3]; 3]) -> Vec<Vec<Option<f64>>> {
        rows(&[0, 1, 2], |i, j| matrix[i][j])
    }

    #[test]
    fn correlations_are_those_of_the_covariance_where_errors_can_have_it() {
        let told = of([[4.0, 1.0, 0.0], [1.0, 1.0, 0.3], [0.0, 0.3, 9.0]]);
        assert_eq!(told[0], [Some(1.0), Some(0.5), Some(0.0)]);
        assert!((told[1][2].unwrap() - 0.1).abs() < 1e-12);
        assert_eq!(of([[0.0, 0.0, 0.0], [0.0, 1.0, 0.2], [0.0, 0.2, 1.0]])[0][1], None);
    }

    #[test]
    fn what_no_errors_can_have_is_brought_to_what_they_can() {
        let told = of([[4.0, -2.8, 0.2], [-2.8, 1.0, 0.1], [0.2, 0.1, 1.0]]);
        let matrix = DMatrix::from_fn(3, 3, |i, j| told[i][j].unwrap());
        let least = matrix.symmetric_eigenvalues().min();
        assert!((least - LEAST).abs() < 1e-9, "{least}");
        assert!((0..3).all(|i| matrix[(i, i)] == 1.0) && (-1.0..-0.9).contains(&matrix[(0, 1)]), "{matrix}");
    }
}
