//! Gusts: a red horizontal force that corresponds to wind by a known drag.

use super::lateral_drag::{is_known_across, lateral_drag};
use super::redness::{
    CONTRADICTED, LEAST_S, Quantity, RED_STATISTIC, Redness, beside_harmonics, red_fit, red_shape,
};
use super::spectrum::{Ordinate, noise_shapes};
use super::view::View;
use crate::diagnose::fit::Fitted;
use crate::stats::{Whittle, whittle};
use nalgebra::DMatrix;
use std::f64::consts::TAU;

/// Gusts, computed from their force and the drag.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GustFound {
    /// standard deviation of the wind on each horizontal axis, m/s
    pub sigma_m_s: f64,
    /// standard error, including that of the drag
    pub sigma_std_m_s: f64,
    /// correlation time, s
    pub correlation_s: f64,
    /// standard error
    pub correlation_std_s: f64,
    /// drag through which it acts, N/(m/s)
    pub drag_n_s_m: f64,
    /// likelihood ratio of the red part, both axes, as in [`Redness`]
    pub statistic: f64,
}

/// Least force of a gust, rms, as a share of the weight. Set by judgement; measured only together with all conditions
/// of a finding (see `Gates`).
const LEAST_FORCE: f64 = 0.002;
/// Air that moves by less is called still, m/s rms: a draught in a room. Four flights of one small quadrotor in a room showed 0.18.
const STILL_M_S: f64 = 0.25;
/// Strongest gusts, m/s rms: a wind of 25 m/s near the ground has a fifth of it, and no multirotor flies in more. A force that needs more has
/// another cause than the air.
const MOST_M_S: f64 = 5.0;
/// Largest ratio of the strengths of a gust on the two horizontal axes. Gusts along the ground have no direction of
/// their own; a larger ratio is that of another cause.
const ALIKE: f64 = 3.0;

impl GustFound {
    /// Whether it is no more than the air of a room.
    pub(in crate::diagnose) fn is_slight(&self) -> bool {
        self.sigma_m_s < STILL_M_S
    }
}

/// Gusts: both horizontal axes are equally red, and there is a drag through which they act.
pub(super) fn gust(view: &View, fitted: &Fitted, redness: &[Redness]) -> Option<GustFound> {
    let axes: Vec<&Redness> = redness.iter().filter(|red| matches!(red.of, Quantity::World(_))).collect();
    let [x, y] = axes.as_slice() else { return None };
    let alike = x.rms < ALIKE * y.rms && y.rms < ALIKE * x.rms;
    let each = x.statistic.min(y.statistic) > 0.5 * RED_STATISTIC;
    // no wind where the velocity's error alone makes as much
    let each = each && axes.iter().all(|red| red.rms > CONTRADICTED * red.of_velocity_n);
    let shows = |red: &Redness| {
        red.statistic > RED_STATISTIC && red.relative > LEAST_FORCE && red.correlation_s >= LEAST_S
    };
    let certain = axes.iter().any(|red| shows(red));
    if !(alike && each && certain && is_known_across(fitted)) {
        return None;
    }
    let (drag, drag_std) = lateral_drag(view, fitted)?;
    let world = view.world_force_n.as_ref()?;
    let mut ordinates = beside_harmonics(view, &world[0]);
    ordinates.extend(beside_harmonics(view, &world[1]));
    let (at_s, _, statistic) = red_fit(view, &ordinates)?;
    let (correlation_s, fit) = refined(view, &ordinates, at_s)?;
    let (relative_variance, correlation_std_s) = red_errors(view, &ordinates, &fit, correlation_s)?;
    let sigma_m_s = fit.coefficients[2].sqrt() / drag;
    if sigma_m_s > MOST_M_S {
        return None;
    }
    let relative = (0.25 * relative_variance + (drag_std / drag).powi(2)).sqrt();
    Some(GustFound {
        sigma_m_s,
        sigma_std_m_s: sigma_m_s * relative,
        correlation_s,
        correlation_std_s,
        drag_n_s_m: drag,
        statistic,
    })
}

/// Correlation time between the tried ones, by a search on the deviance, s.
fn refined(view: &View, ordinates: &[Ordinate], at_s: f64) -> Option<(f64, Whittle)> {
    let power: Vec<f64> = ordinates.iter().map(|o| o.power).collect();
    let [force, velocity] = noise_shapes(view, ordinates);
    let fit = |correlation_s: f64| {
        let red = red_shape(view, ordinates, &force, correlation_s);
        whittle(&power, &[&force, &velocity, &red])
    };
    let mut best = (at_s, fit(at_s)?);
    let mut step = 1.25;
    while step > 1.01 {
        let tried = [best.0 / step, best.0 * step];
        let better = tried
            .into_iter()
            .filter_map(|time_s| Some((time_s, fit(time_s)?)))
            .filter(|(_, found)| found.deviance < best.1.deviance)
            .min_by(|a, b| a.1.deviance.total_cmp(&b.1.deviance));
        match better {
            Some(found) if (0.05..60.0).contains(&found.0) => best = found,
            _ => step = step.sqrt(),
        }
    }
    Some(best)
}

/// Relative variance of the red variance, and standard error of the correlation time, by Whittle's information.
fn red_errors(view: &View, ordinates: &[Ordinate], fit: &Whittle, correlation_s: f64) -> Option<(f64, f64)> {
    let [force, velocity] = noise_shapes(view, ordinates);
    let red = red_shape(view, ordinates, &force, correlation_s);
    let mut information = DMatrix::<f64>::zeros(4, 4);
    for (i, o) in ordinates.iter().enumerate() {
        let turn = (TAU * o.frequency_hz * correlation_s).powi(2);
        let of_red = fit.coefficients[2] * red[i];
        let slopes = [
            of_red,
            // by the logarithm of the correlation time
            of_red * (1.0 - turn) / (1.0 + turn),
            fit.coefficients[0] * force[i],
            fit.coefficients[1] * velocity[i],
        ]
        .map(|slope| slope / fit.spectrum[i]);
        for a in 0..4 {
            for b in 0..4 {
                information[(a, b)] += slopes[a] * slopes[b];
            }
        }
    }
    // a noise shape that is not there has no error
    for index in 2..4 {
        if information[(index, index)] <= 0.0 {
            information[(index, index)] = 1.0;
        }
    }
    let covariance = information.cholesky()?.inverse();
    Some((covariance[(0, 0)], correlation_s * covariance[(1, 1)].sqrt()))
}
