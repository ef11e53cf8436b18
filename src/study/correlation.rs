//! How the errors of estimates go together.

use crate::diagnose::{Fitted, Nuisance};
use crate::estimate::{MethodResult, NAMES, THETA};

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
    places.iter().map(|i| places.iter().map(|j| of(*i, *j)).collect()).collect()
}
