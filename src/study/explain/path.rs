//! The flown path with what is left of it.

use super::result::ExplainStudy;
use crate::diagnose::{AXES, drift_m};
use crate::stats::quantile;
use nalgebra::Vector3;

/// Share of the path that lies between the ends of a residual, one half of the rest on each side: no outlier has a colour of its own.
const MOST: [(usize, usize); 2] = [(5, 100), (95, 100)];
/// Least span of the colours, in units of the residual after. Noise alone in three to six axes spreads over 0.9 to 1.3 between these ends:
/// colours do not enlarge it. Only colours and words about them depend on it.
const LEAST_SPAN: f64 = 2.0;

/// Where the first flight was, and how much the models miss there.
#[derive(Debug, Clone, PartialEq)]
pub struct FlownPath {
    /// s
    pub time_s: Vec<f64>,
    /// m, world: north, west, up
    pub position_m: Vec<[f64; 3]>,
    /// by the rigid body alone
    pub before: PathResidual,
    /// by the model found
    pub after: PathResidual,
}

/// Residual along a path: root mean square over the axes, each in units of what is left of it after.
#[derive(Debug, Clone, PartialEq)]
pub struct PathResidual {
    /// one at each place
    pub along: Vec<f64>,
    /// nine tenths of the path lie between these
    pub most: [f64; 2],
    /// residuals of the first and of the last colour
    pub colours: [f64; 2],
}

impl PathResidual {
    fn new(along: Vec<f64>) -> Self {
        let mut ranked = along.clone();
        ranked.sort_by(f64::total_cmp);
        let most = MOST.map(|part| quantile(&ranked, part).unwrap_or(0.0));
        let wider = 0.5 * (LEAST_SPAN - (most[1] - most[0])).max(0.0);
        // no residual is below zero
        let low = (most[0] - wider).max(0.0);
        Self { along, most, colours: [low, (most[1] + wider).max(low + LEAST_SPAN)] }
    }

    /// It is about the same along the whole path.
    #[must_use]
    pub fn is_even(&self) -> bool {
        self.most[1] - self.most[0] < LEAST_SPAN
    }
}

impl ExplainStudy {
    /// The path of the first flight; `None` where its position is not known.
    #[must_use]
    pub fn path(&self) -> Option<FlownPath> {
        let trace = self.traces.first().filter(|trace| trace.known.position)?;
        let rows = trace.rows();
        let search = &self.explanation.search;
        let sigma = search.after.weighted.sigma;
        let axes: Vec<usize> =
            self.compared_axes().filter(|&axis| axis < AXES && sigma[axis] > 0.0).collect();
        let missed = |left: &dyn Fn(usize) -> Vec<f64>| -> Vec<f64> {
            let mut sum = vec![0.0; rows];
            for &axis in &axes {
                let of_axis = left(axis);
                sum.iter_mut().zip(&of_axis).for_each(|(sum, value)| *sum += (value / sigma[axis]).powi(2));
            }
            sum.into_iter().map(|sum| (sum / axes.len().max(1) as f64).sqrt()).collect()
        };
        // explained together, each flight was seen with the air; the path is over the ground
        let own = self.along.as_ref().and_then(|along| *along.winds_m_s.first()?);
        let wind_m_s = own.map_or_else(Vector3::zeros, |[north, west]| Vector3::new(north, west, 0.0));
        let flown =
            |center: usize| trace.states[center].position_m + drift_m(&wind_m_s, trace.grid.step_s, center);
        Some(FlownPath {
            time_s: search.before.rows.time_s.get(..rows)?.to_vec(),
            position_m: trace.centers.iter().map(|&center| flown(center).into()).collect(),
            before: PathResidual::new(missed(&|axis| self.left_before(axis))),
            after: PathResidual::new(missed(&|axis| self.left_after(axis))),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_span_what_most_of_the_path_has_and_no_outlier() {
        // 101 places from 20 to 40, one of them far off
        let mut along: Vec<f64> = (0..101).map(|place| 20.0 + 0.2 * f64::from(place)).collect();
        along[50] = 1000.0;
        let missed = PathResidual::new(along);
        assert!(
            (20.5..22.0).contains(&missed.most[0]) && (38.0..40.0).contains(&missed.most[1]),
            "{missed:?}"
        );
        assert!(missed.colours == missed.most && !missed.is_even());
        // noise about one is not spread over all colours
        let missed = PathResidual::new((0..101).map(|place| 0.5 + 0.01 * f64::from(place)).collect());
        assert!(missed.is_even() && missed.colours[0].abs() < 1e-9, "{missed:?}");
        assert!((missed.colours[1] - LEAST_SPAN).abs() < 0.1, "{missed:?}");
        assert_eq!(PathResidual::new(Vec::new()).colours, [0.0, LEAST_SPAN]);
    }
}
