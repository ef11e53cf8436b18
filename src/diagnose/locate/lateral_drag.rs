//! Drag of a fit, through which wind acts.

use super::super::fit::Fitted;
use super::super::followed::Followed;
use super::view::View;
use crate::diagnose::signature::EffectTerm;

/// Lateral drag of the accepted effects with its standard error, N/(m/s) at the speeds flown: all terms of one axis together, then the
/// mean of the axes along which the model has any.
pub(super) fn lateral_drag(view: &View, fitted: &Fitted) -> Option<(f64, f64)> {
    let mut first = fitted.rows.nuisances.len();
    let speed = view.states.iter().find(|(state, _)| *state == Followed::Speed).map(|(_, values)| values);
    let mean_speed = speed.map_or(0.0, |values| values.iter().sum::<f64>() / values.len().max(1) as f64);
    let mut along = [const { Vec::new() }; ACROSS.len()];
    for present in &fitted.base.effects {
        let slope = present.signature.role.lateral_slope.map_or(0.0, |slope| slope(mean_speed));
        if slope > 0.0 {
            for slot in ACROSS.into_iter().filter(|slot| acts_along(present, *slot)) {
                let column = present.free.iter().position(|free| *free == slot).map(|index| first + index);
                let variance = column.map_or(0.0, |column| fitted.covariance[(column, column)]);
                along[slot].push((slope * present.values[slot], slope.powi(2) * variance));
            }
        }
        first += present.free.len();
    }
    let (drag, variance) = mean_of_axes(&along);
    (drag > 0.0 && variance.is_finite()).then(|| (drag, variance.max(0.0).sqrt()))
}

/// Mean over the axes that have terms, each with the sum of its terms, and its variance. Of each axis: values and variances of its terms.
fn mean_of_axes(along: &[Vec<(f64, f64)>]) -> (f64, f64) {
    let count = along.iter().filter(|terms| !terms.is_empty()).count().max(1) as f64;
    let (sum, variance) = along
        .iter()
        .flatten()
        .fold((0.0, 0.0), |(sum, all), (value, variance)| (sum + value, all + variance));
    (sum / count, variance / count.powi(2))
}

/// Whether the model has a drag along both body axes. Along an axis without one, what is left contains the drag itself.
pub(super) fn is_known_across(fitted: &Fitted) -> bool {
    let drags = || fitted.base.effects.iter().filter(|term| term.signature.is_drag());
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn terms_of_one_axis_add_and_axes_are_averaged() {
        // linear along x, quadratic along y: each axis has its own drag once
        assert_eq!(mean_of_axes(&[vec![(0.4, 0.04)], vec![(0.4, 0.04)]]), (0.4, 0.02));
        // both terms along x, one along y
        assert_eq!(mean_of_axes(&[vec![(0.25, 0.0), (0.25, 0.0)], vec![(0.25, 0.0)]]), (0.375, 0.0));
        // an axis without a drag is none
        assert_eq!(mean_of_axes(&[vec![(0.4, 0.04)], Vec::new()]), (0.4, 0.04));
        assert_eq!(mean_of_axes(&[Vec::new(), Vec::new()]), (0.0, 0.0));
    }
}
