//! Whether what an effect has along each axis of the body moved together, by one factor.
//!
//! The spread between flights of one vehicle is mostly each axis' own. What all axes do alike is known better than one of them.

use super::balance_change::NAMED_SIGMAS;
use super::groups::Moved;
use super::parameter::{ParameterChange, UNDECIDED, Undecided, flights_needed};

/// Part of the spread between flights of one vehicle that goes the same way along all axes, standard deviation, share of the value. The mean of the
/// axes scatters by 1.5 to 3 % in simulated flights of unchanged vehicles (two of PX4, with two paths and more) and, over the mass, by
/// 2.5 % in eight flights of Crazyflies of one type; single axes scatter by up to 12 %.
const IN_COMMON: f64 = 0.03;
/// Standard deviations from the mean of all axes beyond which an axis has not moved by the same factor. The usual two.
const ALIKE: f64 = 2.0;
/// Share of the variance of an axis that is at least its own.
const OWN: f64 = 0.5;

/// Parameters along several axes that moved by the same factor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Together {
    /// size of the common difference in its standard errors
    pub sigmas: f64,
    /// more than chance, and less than certain; `None`: it is a change
    pub undecided: Option<Undecided>,
}

/// Judges whether parameters of one effect moved by the same factor along all axes of the body. `None` where they did not, where that is no more
/// than chance, or where one axis alone says more.
#[must_use]
pub fn judge_together(axes: &[&ParameterChange]) -> Option<Together> {
    let shares: Option<Vec<(f64, f64)>> =
        axes.iter().map(|axis| share(&axis.moved).filter(|_| axis.same_way)).collect();
    let shares = shares.filter(|shares| shares.len() > 1)?;
    // flights of each side in which all of them are known at least
    let known = |side: usize| axes.iter().map(|axis| axis.flights[side]).min();
    let flights = [known(0)?, known(1)?];
    let common = IN_COMMON.powi(2) * flights.map(|flights| (flights as f64).recip()).iter().sum::<f64>();
    let own = |std: f64| (std * std - common).max(OWN * std * std);
    let information: f64 = shares.iter().map(|(_, std)| own(*std).recip()).sum();
    let mean = shares.iter().map(|(by, std)| by / own(*std)).sum::<f64>() / information;
    let is_alike = |(by, std): &(f64, f64)| by * mean > 0.0 && (by - mean).abs() <= ALIKE * own(*std).sqrt();
    let sigmas = mean.abs() / (information.recip() + common).sqrt();
    let alone = axes.iter().map(|axis| axis.moved.sigmas().abs()).fold(0.0, f64::max);
    if sigmas < UNDECIDED.max(alone) || !shares.iter().all(is_alike) {
        return None;
    }
    let undecided = Undecided {
        flights: flights_needed(sigmas, flights[0].max(flights[1])),
        by_spread: axes.iter().all(|axis| axis.by_spread),
    };
    Some(Together { sigmas, undecided: (sigmas < NAMED_SIGMAS).then_some(undecided) })
}

/// A difference as a share of the mean of before and after, with its standard error: that of the way back is the opposite. `None` where the
/// value has another sign after.
fn share(moved: &Moved) -> Option<(f64, f64)> {
    let (before, after) = (moved.before.0, moved.after.0);
    let size = f64::midpoint(before.abs(), after.abs());
    (before * after > 0.0).then(|| (moved.by.0 / size, moved.by.1 / size))
}

#[cfg(test)]
mod tests {
    use super::super::groups::Groups;
    use super::super::parameter::{Spread, judge_parameter};
    use super::*;

    const SPREAD: Spread = Spread { relative: 0.12, absolute: 0.0 };

    /// Three axes at 1, and by so much in as many later flights, all known to 0.02.
    fn moved(to: [f64; 3], flights: usize) -> Option<Together> {
        let axis = |after: &f64| {
            let values = [vec![Some((1.0, 0.02)); flights], vec![Some((*after, 0.02)); flights]].concat();
            judge_parameter(&values, &Groups::split(2 * flights, flights), &SPREAD).unwrap()
        };
        let axes: Vec<ParameterChange> = to.iter().map(axis).collect();
        // none of them is certain alone
        assert!(axes.iter().all(|axis| !axis.changed), "{axes:?}");
        judge_together(&axes.iter().collect::<Vec<_>>())
    }

    #[test]
    fn axes_that_moved_alike_are_known_better_than_one_of_them() {
        let found = moved([0.7, 0.69, 0.71], 1).unwrap();
        let why = found.undecided.unwrap();
        assert!(found.sigmas > 3.0 && why.by_spread && why.flights == 2, "{found:?}");
        let decided = moved([0.7, 0.69, 0.71], 2).unwrap();
        assert!(decided.undecided.is_none() && decided.sigmas > 4.5, "{decided:?}");
        // doubled
        assert!(moved([1.9, 2.0, 2.0], 1).is_some_and(|found| found.undecided.is_none()));
    }

    #[test]
    fn axes_that_moved_otherwise_and_the_spread_of_one_vehicle_are_no_common_move() {
        assert_eq!(moved([0.7, 1.0, 1.3], 1), None);
        assert_eq!(moved([0.6, 1.0, 1.0], 1), None);
        assert_eq!(moved([0.85, 0.88, 0.86], 1), None);
        // one of them, or a part that has no size before
        assert_eq!(judge_together(&[]), None);
        assert_eq!(share(&Moved { before: (-0.1, 0.1), after: (0.4, 0.1), by: (0.5, 0.14) }), None);
    }

    #[test]
    fn the_way_back_is_as_certain() {
        let one = |before: f64, after: f64| {
            let values = [Some((before, 0.02)), Some((after, 0.02))];
            let axis = judge_parameter(&values, &Groups::split(2, 1), &SPREAD).unwrap();
            judge_together(&[&axis, &axis, &axis]).unwrap().sigmas
        };
        assert!((one(1.0, 0.65) - one(0.65, 1.0)).abs() < 1e-12);
    }
}
