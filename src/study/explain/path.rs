//! The flown path with what is left of it.

use super::result::ExplainStudy;
use crate::diagnose::{AXES, drift_m};
use crate::stats::quantile;
use nalgebra::Vector3;

/// Least residual with the last colour: what is left after is one. Only colours depend on it.
const LEAST_FULL: f64 = 2.0;

/// Where the first flight was, and how much the models miss there.
#[derive(Debug, Clone, PartialEq)]
pub struct FlownPath {
    /// s
    pub time_s: Vec<f64>,
    /// m, world: north, west, up
    pub position_m: Vec<[f64; 3]>,
    /// residual of all axes by the rigid body alone, root mean square over the axes, each in units of what is left of it
    /// after
    pub before: Vec<f64>,
    /// the same by the model found
    pub after: Vec<f64>,
    /// nine tenths of `before` are below this
    pub full: f64,
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
        let before = missed(&|axis| self.left_before(axis));
        // explained together, each flight was seen with the air; the path is over the ground
        let own = self.along.as_ref().and_then(|along| *along.winds_m_s.first()?);
        let wind_m_s = own.map_or_else(Vector3::zeros, |[north, west]| Vector3::new(north, west, 0.0));
        let flown =
            |center: usize| trace.states[center].position_m + drift_m(&wind_m_s, trace.grid.step_s, center);
        let mut ranked = before.clone();
        ranked.sort_by(f64::total_cmp);
        Some(FlownPath {
            full: quantile(&ranked, (9, 10)).unwrap_or(0.0).max(LEAST_FULL),
            time_s: search.before.rows.time_s.get(..rows)?.to_vec(),
            position_m: trace.centers.iter().map(|&center| flown(center).into()).collect(),
            before,
            after: missed(&|axis| self.left_after(axis)),
        })
    }
}
