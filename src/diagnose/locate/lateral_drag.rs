//! Drag of a fit, through which wind acts.

use super::super::fit::Fitted;
use super::super::followed::Followed;
use super::view::View;
use crate::diagnose::signature::EffectTerm;

/// Lateral drag of the accepted effects with its standard error, N/(m/s) at the speeds flown: the mean of the axes along which it is
/// in the model.
pub(super) fn lateral_drag(view: &View, fitted: &Fitted) -> Option<(f64, f64)> {
    let mut first = fitted.rows.nuisances.len();
    let (mut drag, mut variance) = (0.0, 0.0);
    let speed = view.states.iter().find(|(state, _)| *state == Followed::Speed).map(|(_, values)| values);
    let mean_speed = speed.map_or(0.0, |values| values.iter().sum::<f64>() / values.len().max(1) as f64);
    for present in &fitted.base.effects {
        let slope = present.signature.role.lateral_slope.map_or(0.0, |slope| slope(mean_speed));
        if slope > 0.0 {
            let along = ACROSS.into_iter().filter(|slot| acts_along(present, *slot));
            let share = slope / along.clone().count().max(1) as f64;
            drag += share * along.map(|slot| present.values[slot]).sum::<f64>();
            for (index, slot) in present.free.iter().enumerate() {
                if ACROSS.contains(slot) {
                    variance += share.powi(2) * fitted.covariance[(first + index, first + index)];
                }
            }
        }
        first += present.free.len();
    }
    (drag > 0.0 && variance.is_finite()).then(|| (drag, variance.max(0.0).sqrt()))
}

/// Whether the model has a drag along both body axes. Along an axis without one, what is left contains the drag itself.
pub(super) fn is_known_across(fitted: &Fitted) -> bool {
    let drags = || fitted.base.effects.iter().filter(|term| term.signature.role.lateral_slope.is_some());
    ACROSS.into_iter().all(|slot| drags().any(|term| acts_along(term, slot)))
}

/// Slots of a drag's values along body x and y.
const ACROSS: [usize; 2] = [0, 1];

fn acts_along(drag: &EffectTerm, slot: usize) -> bool {
    drag.free.contains(&slot) || drag.values[slot] != 0.0
}

/// Drag of the accepted effects along body z, N/(m/s).
pub(super) fn axial_drag_n_s_m(fitted: &Fitted) -> f64 {
    let along_z = |term: &EffectTerm| term.values.get(term.signature.role.axial?).copied();
    fitted.base.effects.iter().filter_map(along_z).sum()
}
