//! Whether one parameter moved between two groups of flights.

use super::balance_change::{NAMED, NAMED_SIGMAS};
use super::groups::{Groups, Moved};
use super::pooled::PRIOR;

/// How a parameter of one vehicle differs from flight to flight beside its stated error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spread {
    /// standard deviation, share of the value
    pub relative: f64,
    /// standard deviation, the parameter's unit
    pub absolute: f64,
}

/// A parameter along the flights, and whether it moved.
#[derive(Debug, Clone, PartialEq)]
pub struct ParameterChange {
    /// before and after
    pub moved: Moved,
    /// the difference is certain
    pub changed: bool,
    /// more than chance, and less than certain
    pub undecided: Option<Undecided>,
    /// the smallest difference that would have been, the parameter's unit
    pub least: f64,
    /// later flights that each show it alone
    pub carried_by: Vec<usize>,
}

/// A difference that chance hardly explains, and that is not certain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Undecided {
    /// flights on each side from which on a difference of this size would be certain, where they scatter like these
    pub flights: usize,
    /// most of the error is the spread between flights of one vehicle, and not that of the flights themselves
    pub by_spread: bool,
}

/// A difference is told as undecided from so many standard errors on. Of ten parameters of an unchanged vehicle, one in 40 pairs of
/// flights is.
pub const UNDECIDED: f64 = 3.0;

/// Later flights say the same from so many standard errors on.
const SAYS: f64 = 2.0;

/// Judges whether a parameter moved. `values` are those of all flights with standard errors, `None` where a flight does not determine it.
/// `None` where one of the groups has no value.
#[must_use]
pub fn judge_parameter(
    values: &[Option<(f64, f64)>],
    groups: &Groups,
    spread: &Spread,
) -> Option<ParameterChange> {
    judged(values, groups, spread, 0.0)
}

/// The same where the values of all later flights have a standard error in common, `in_common` as a share of the value.
pub(super) fn judged(
    values: &[Option<(f64, f64)>],
    groups: &Groups,
    spread: &Spread,
    in_common: f64,
) -> Option<ParameterChange> {
    // one size for all: by its own, a value that came out small would weigh more
    let size = groups.both().map(|group| mean_size(values, group)).into_iter().flatten().sum::<f64>() / 2.0;
    let of = |group: &[usize]| -> Vec<(usize, f64, f64)> {
        let one = |&flight: &usize| {
            let (value, std) = values.get(flight).copied().flatten()?;
            let wide = std.powi(2) + (spread.relative * size).powi(2) + spread.absolute.powi(2);
            (value.is_finite() && wide.is_finite()).then_some((flight, value, wide))
        };
        group.iter().filter_map(one).collect()
    };
    let [before, after] = groups.both().map(of);
    if before.is_empty() || after.is_empty() {
        return None;
    }
    let scale = scatter(&before, &after);
    let [first, (later, std)] = [&before, &after].map(|group| mean(group, scale));
    let second = (later, std.hypot(in_common * later));
    let by = (second.0 - first.0, first.1.hypot(second.1));
    let moved = Moved { before: first, after: second, by };
    let alone = |(flight, value, variance): &(usize, f64, f64)| {
        let by = value - first.0;
        let std = (variance * scale * scale + first.1 * first.1).sqrt().hypot(in_common * value);
        ((by > 0.0) == (moved.by.0 > 0.0) && by.abs() > SAYS * std).then_some(*flight)
    };
    let changed = moved.sigmas().powi(2) >= NAMED;
    let tells = !changed && moved.sigmas().abs() >= UNDECIDED;
    Some(ParameterChange {
        changed,
        undecided: tells.then(|| undecided(&moved, [&before, &after], (values, scale))),
        least: NAMED.sqrt() * by.1,
        carried_by: after.iter().filter_map(alone).collect(),
        moved,
    })
}

/// What would decide a difference that is not certain.
fn undecided(
    moved: &Moved,
    groups: [&[(usize, f64, f64)]; 2],
    (values, scale): (&[Option<(f64, f64)>], f64),
) -> Undecided {
    // errors of so many times the flights are smaller by the root of it
    let most = groups.map(<[_]>::len).into_iter().fold(1, usize::max);
    let needed = (NAMED_SIGMAS / moved.sigmas()).powi(2);
    let flights = (1..).find(|flights| *flights as f64 >= needed * most as f64).unwrap_or(usize::MAX);
    let own = |group: &[(usize, f64, f64)]| {
        let weights: f64 = group.iter().map(|(.., variance)| variance.recip()).sum();
        let of = |(flight, _, variance): &(usize, f64, f64)| {
            let std = values[*flight].map_or(0.0, |(_, std)| std);
            (std / (variance * weights)).powi(2)
        };
        scale * scale * group.iter().map(of).sum::<f64>()
    };
    Undecided { flights, by_spread: 2.0 * groups.map(own).iter().sum::<f64>() < moved.by.1.powi(2) }
}

/// Mean of the values' sizes, where a group has any.
fn mean_size(values: &[Option<(f64, f64)>], group: &[usize]) -> Option<f64> {
    let sizes: Vec<f64> =
        group.iter().filter_map(|&flight| Some(values.get(flight).copied().flatten()?.0.abs())).collect();
    (!sizes.is_empty()).then(|| sizes.iter().sum::<f64>() / sizes.len() as f64)
}

fn mean(group: &[(usize, f64, f64)], scale: f64) -> (f64, f64) {
    let weights: f64 = group.iter().map(|(.., variance)| variance.recip()).sum();
    let sum: f64 = group.iter().map(|(_, value, variance)| value / variance).sum();
    (sum / weights, scale / weights.sqrt())
}

/// Scatter over what is expected, learned as far as there are flights to learn it from.
fn scatter(before: &[(usize, f64, f64)], after: &[(usize, f64, f64)]) -> f64 {
    let squares = |group: &[(usize, f64, f64)]| -> f64 {
        let (mean, _) = mean(group, 1.0);
        group.iter().map(|(_, value, variance)| (value - mean).powi(2) / variance).sum()
    };
    let free = (before.len() + after.len() - 2) as f64;
    ((PRIOR + squares(before) + squares(after)) / (PRIOR + free)).sqrt().max(0.8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_difference_beyond_the_scatter_is_a_change_and_less_is_not() {
        let exact = Spread { relative: 0.0, absolute: 0.0 };
        let groups = Groups::split(4, 2);
        let values = [Some((1.0, 0.1)), Some((1.1, 0.1)), Some((2.0, 0.1)), Some((2.1, 0.1))];
        let found = judge_parameter(&values, &groups, &exact).unwrap();
        assert!(found.changed && (found.moved.by.0 - 1.0).abs() < 1e-12);
        assert_eq!(found.carried_by, [2, 3]);
        // where one vehicle's flights differ by a third, this says nothing
        let wide = Spread { relative: 0.33, absolute: 0.0 };
        let found = judge_parameter(&values, &groups, &wide).unwrap();
        assert!(!found.changed && found.least > 1.0 && found.undecided.is_none());
        assert!(judge_parameter(&[None, None, Some((1.0, 0.1)), None], &groups, &exact).is_none());
    }

    #[test]
    fn values_that_came_out_small_do_not_weigh_more() {
        let spread = Spread { relative: 0.12, absolute: 0.0 };
        let values = [1.0, 0.8, 1.2, 1.0].map(|value| Some((value, 0.0)));
        let found = judge_parameter(&values, &Groups::split(4, 1), &spread).unwrap();
        assert!((found.moved.after.0 - 1.0).abs() < 1e-12, "{found:?}");
    }

    #[test]
    fn a_difference_that_is_not_certain_says_how_many_flights_would_decide() {
        let spread = Spread { relative: 0.12, absolute: 0.0 };
        let pair = |flights: usize| {
            let values = [vec![Some((0.5, 0.02)); flights], vec![Some((1.0, 0.03)); flights]].concat();
            judge_parameter(&values, &Groups::split(2 * flights, flights), &spread).unwrap()
        };
        let found = pair(1);
        let undecided = found.undecided.unwrap();
        assert!(!found.changed && undecided.by_spread && undecided.flights == 2, "{found:?}");
        let decided = pair(undecided.flights);
        assert!(decided.changed && decided.undecided.is_none());
        // where each flight hardly determines it, its own error is why
        let blurred = [Some((0.5, 0.1)), Some((1.0, 0.1))];
        let exact = Spread { relative: 0.0, absolute: 0.0 };
        let found = judge_parameter(&blurred, &Groups::split(2, 1), &exact).unwrap();
        assert!(found.undecided.is_some_and(|undecided| !undecided.by_spread));
    }
}
