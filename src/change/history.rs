//! Where along a row of flights something changed.

use super::groups::Groups;

/// A place in a row of flights from which on something is otherwise.
#[derive(Debug, Clone, PartialEq)]
pub struct Step<T> {
    /// the first flight that is otherwise
    pub from: usize,
    /// what was compared: the flights since the step before, and those until the next
    pub groups: Groups,
    /// what changed
    pub change: T,
    /// earlier flights, between two steps, that the flights from here on do not differ from; empty: there are none
    pub as_before: Vec<usize>,
}

/// The steps of a row of flights, in order: the strongest divides the row, and its parts are searched as the whole was. `judge` gives
/// what changed between two groups and how strong that is; `None` where nothing did.
pub fn steps<T>(flights: usize, judge: &impl Fn(&Groups) -> Option<(f64, T)>) -> Vec<Step<T>> {
    let mut found = Vec::new();
    search(0, flights, judge, &mut found);
    found.sort_by_key(|step: &Step<T>| step.from);
    found
}

/// Says of each step which earlier flights the vehicle is as again. `is_same` judges whether two groups of flights do not differ,
/// where a difference as large as that of the step would have shown.
pub fn find_returns<T>(flights: usize, steps: &mut [Step<T>], is_same: &impl Fn(&Groups, &T) -> bool) {
    let borders: Vec<usize> =
        std::iter::once(0).chain(steps.iter().map(|step| step.from)).chain([flights]).collect();
    let part = |index: usize| borders[index]..borders[index + 1];
    for (index, step) in steps.iter_mut().enumerate() {
        // the part just before the step is what it differs from
        let earlier = (0..index).rev().find(|&other| {
            let groups = Groups { before: part(other).collect(), after: part(index + 1).collect() };
            is_same(&groups, &step.change)
        });
        step.as_before = earlier.map(part).into_iter().flatten().collect();
    }
}

fn search<T>(
    first: usize,
    end: usize,
    judge: &impl Fn(&Groups) -> Option<(f64, T)>,
    found: &mut Vec<Step<T>>,
) {
    let judged = (first + 1..end).filter_map(|from| {
        let groups = Groups { before: (first..from).collect(), after: (from..end).collect() };
        let (strength, change) = judge(&groups)?;
        Some((strength, Step { from, groups, change, as_before: Vec::new() }))
    });
    let Some((_, step)) = judged.max_by(|a, b| a.0.total_cmp(&b.0)) else { return };
    let from = step.from;
    found.push(step);
    search(first, from, judge, found);
    search(from, end, judge, found);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Judges the difference of the means of two groups of a row that scatters by a tenth.
    fn difference(row: &[f64]) -> impl Fn(&Groups) -> Option<(f64, f64)> {
        let mean =
            |places: &[usize]| places.iter().map(|place| row[*place]).sum::<f64>() / places.len() as f64;
        move |groups: &Groups| {
            let by: f64 = mean(&groups.after) - mean(&groups.before);
            let error = (1.0 / groups.before.len() as f64 + 1.0 / groups.after.len() as f64).sqrt();
            (by.abs() > 0.5 * error).then_some((by.abs() / error, by))
        }
    }

    #[test]
    fn a_row_with_two_steps_is_divided_where_they_are() {
        let row = [1.0, 1.1, 0.9, 3.0, 3.1, 2.0, 2.1, 1.9];
        let judge = difference(&row);
        let mut found = steps(row.len(), &judge);
        assert!(found.iter().all(|step| step.as_before.is_empty()));
        let places: Vec<usize> = found.iter().map(|step| step.from).collect();
        assert_eq!(places, [3, 5]);
        assert!(found[0].change > 0.0 && found[1].change < 0.0);
        find_returns(row.len(), &mut found, &|groups, _| judge(groups).is_none());
        assert!(found.iter().all(|step| step.as_before.is_empty()), "2 is not 1");
        assert!(steps(3, &judge).is_empty());
        assert!(steps(0, &judge).is_empty());
    }

    #[test]
    fn a_row_that_goes_back_says_to_which_flights() {
        let row = [1.0, 1.1, 0.9, 3.0, 3.1, 1.0, 1.1, 0.9];
        let judge = difference(&row);
        let mut found = steps(row.len(), &judge);
        find_returns(row.len(), &mut found, &|groups, _| judge(groups).is_none());
        let returned: Vec<(usize, &[usize])> =
            found.iter().map(|step| (step.from, step.as_before.as_slice())).collect();
        assert_eq!(returned, [(3, &[][..]), (5, &[0, 1, 2][..])]);
    }
}
