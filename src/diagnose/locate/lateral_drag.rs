//! Drag of a fit, through which wind acts.

use super::super::fit::Fitted;
use super::super::followed::Followed;
use super::view::View;
use crate::diagnose::signature::EffectTerm;

/// Lateral drag of the accepted effects with its standard error, N/(m/s) at the speeds flown.
pub(super) fn lateral_drag(view: &View, fitted: &Fitted) -> Option<(f64, f64)> {
    let mut first = fitted.rows.nuisances.len();
    let (mut drag, mut variance) = (0.0, 0.0);
    let speed = view.states.iter().find(|(state, _)| *state == Followed::Speed).map(|(_, values)| values);
    let mean_speed = speed.map_or(0.0, |values| values.iter().sum::<f64>() / values.len().max(1) as f64);
    for present in &fitted.base.effects {
        let slope = present.signature.role.lateral_slope.map_or(0.0, |slope| slope(mean_speed));
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
    let along_z = |term: &EffectTerm| term.values.get(term.signature.role.axial?).copied();
    fitted.base.effects.iter().filter_map(along_z).sum()
}
