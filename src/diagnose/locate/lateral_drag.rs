//! Force per airspeed that a fit already has, through which wind acts.

use super::super::fit::Fitted;
use super::view::{Followed, View};

/// Lateral drag of the accepted effects with its standard error, N/(m/s) at the speeds flown.
pub(super) fn lateral_drag(view: &View, fitted: &Fitted) -> Option<(f64, f64)> {
    let mut first = fitted.rows.nuisances.len();
    let (mut drag, mut variance) = (0.0, 0.0);
    let speed = view.states.iter().find(|(state, _)| *state == Followed::Speed).map(|(_, values)| values);
    let mean_speed = speed.map_or(0.0, |values| values.iter().sum::<f64>() / values.len().max(1) as f64);
    for present in &fitted.base.present {
        // a quadratic drag's slope, mean of along and across the motion
        let slope = match present.effect.id() {
            "linear_drag" => 1.0,
            "quadratic_drag" => 1.5 * mean_speed,
            _ => 0.0,
        };
        if slope > 0.0 {
            drag += slope * 0.5 * (present.values[0] + present.values[1]);
            for (index, slot) in present.free.iter().enumerate() {
                if *slot < 2 {
                    variance += (0.5 * slope).powi(2) * fitted.covariance[(first + index, first + index)];
                }
            }
        }
        first += present.free.len();
    }
    (drag > 0.0 && variance.is_finite()).then(|| (drag, variance.max(0.0).sqrt()))
}

/// Drag of the accepted effects along body z, N/(m/s).
pub(super) fn axial_drag_n_s_m(fitted: &Fitted) -> f64 {
    let along_z = fitted.base.present.iter().filter_map(|present| match present.effect.id() {
        "linear_drag" => present.values.get(2),
        "inflow" => present.values.first(),
        _ => None,
    });
    along_z.sum()
}
