//! A parameter that flights know only up to the scale of force, between two groups of flights whose scales differ.

use super::groups::Groups;
use super::parameter::{ParameterChange, Spread, judge_parameter, judged};

/// Judges whether a parameter that goes with the scale of force moved, where that scale moved between the groups. A flight knows moments of
/// inertia and forces only over its mass and its thrust for a command, and one of the two is taken as stated. `factor` (with its standard
/// error) brings the later flights' values to where the other one is: nothing says which of them changed, or whether both did in part. So the
/// parameter moved only if it differs at both ends, the same way. What is told is the end at which it differs less. `None` as
/// [`judge_parameter`].
#[must_use]
pub fn judge_at_both_scales(
    values: &[Option<(f64, f64)>],
    groups: &Groups,
    spread: &Spread,
    factor: (f64, f64),
) -> Option<ParameterChange> {
    let fitted = judge_parameter(values, groups, spread)?;
    let mut brought = values.to_vec();
    for &flight in &groups.after {
        if let Some(Some((value, std))) = brought.get_mut(flight) {
            *value *= factor.0;
            *std *= factor.0.abs();
        }
    }
    let other = judged(&brought, groups, spread, factor.1 / factor.0.abs())?;
    // a scale between the two ends has no difference left
    let is_between = fitted.moved.by.0 * other.moved.by.0 < 0.0;
    // a change against the other scale has to make up for it first
    let apart = (other.moved.after.0 - fitted.moved.after.0).abs();
    let least = fitted.least.max(other.least) + apart;
    let less = if other.moved.sigmas().abs() < fitted.moved.sigmas().abs() { other } else { fitted };
    Some(ParameterChange {
        changed: less.changed && !is_between,
        undecided: less.undecided.filter(|_| !is_between),
        least,
        ..less
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const EXACT: Spread = Spread { relative: 0.0, absolute: 0.0 };

    /// A value of 1 +- 0.03 in three flights before, and of so much with the same share of error in three after.
    fn judged_after(after: f64, factor: (f64, f64)) -> ParameterChange {
        let values = [vec![Some((1.0, 0.03)); 3], vec![Some((after, 0.03 * after)); 3]].concat();
        judge_at_both_scales(&values, &Groups::split(6, 3), &EXACT, factor).unwrap()
    }

    #[test]
    fn what_another_scale_accounts_for_is_no_change() {
        // a payload of a quarter, where the mass is stated: all values come out at 1 / 1.25
        let payload = judged_after(0.8, (1.25, 0.01));
        assert!(!payload.changed && payload.undecided.is_none() && payload.moved.by.0.abs() < 1e-12);
        // nothing before the scale is made up for, from 0.8 to 1
        assert!(payload.least > 0.2, "{payload:?}");
        // half of it by a payload, half by a battery
        let both = judged_after(0.9, (1.25, 0.01));
        assert!(!both.changed && both.undecided.is_none() && both.moved.by.0 < 0.0);
    }

    #[test]
    fn what_differs_at_both_scales_is_a_change_of_the_smaller_size() {
        let found = judged_after(0.5, (1.25, 0.0));
        assert!(found.changed && (found.moved.by.0 + 0.375).abs() < 1e-12, "{found:?}");
        assert!((found.moved.after.0 - 0.625).abs() < 1e-12);
        let more = judged_after(1.6, (1.25, 0.0));
        assert!(more.changed && (more.moved.by.0 - 0.6).abs() < 1e-12, "{more:?}");
    }

    #[test]
    fn the_error_of_the_ratio_is_that_of_all_later_flights() {
        let [exact, blurred] = [0.0, 0.125].map(|std| judged_after(0.5, (1.25, std)).moved.by.1);
        // a tenth of 0.625
        assert!((blurred - exact.hypot(0.0625)).abs() < 1e-12, "{exact} {blurred}");
    }
}
