//! Whether one parameter moved between two groups of flights.

use super::balance_change::NAMED;
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
    /// the smallest difference that would have been, the parameter's unit
    pub least: f64,
    /// later flights that each show it alone
    pub carried_by: Vec<usize>,
}

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
    let of = |group: &[usize]| -> Vec<(usize, f64, f64)> {
        let one = |&flight: &usize| {
            let (value, std) = values.get(flight).copied().flatten()?;
            let wide = std.powi(2) + (spread.relative * value).powi(2) + spread.absolute.powi(2);
            (value.is_finite() && wide.is_finite()).then_some((flight, value, wide))
        };
        group.iter().filter_map(one).collect()
    };
    let [before, after] = groups.both().map(of);
    if before.is_empty() || after.is_empty() {
        return None;
    }
    let scale = scatter(&before, &after);
    let [first, second] = [&before, &after].map(|group| mean(group, scale));
    let by = (second.0 - first.0, first.1.hypot(second.1));
    let moved = Moved { before: first, after: second, by };
    let alone = |(flight, value, variance): &(usize, f64, f64)| {
        let by = value - first.0;
        let std = (variance * scale * scale + first.1 * first.1).sqrt();
        ((by > 0.0) == (moved.by.0 > 0.0) && by.abs() > SAYS * std).then_some(*flight)
    };
    Some(ParameterChange {
        changed: moved.sigmas().powi(2) >= NAMED,
        least: NAMED.sqrt() * by.1,
        carried_by: after.iter().filter_map(alone).collect(),
        moved,
    })
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
        assert!(!found.changed && found.least > 1.0);
        assert!(judge_parameter(&[None, None, Some((1.0, 0.1)), None], &groups, &exact).is_none());
    }
}
