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

/// Flights of a part of a row in which a change that goes back is searched: there are as many places for it as pairs of flights.
const MOST_THERE_AND_BACK: usize = 60;

/// The steps of a row of flights, in order: the strongest divides the row, and its parts are searched as the whole was. `judge` gives
/// what changed between two groups and how strong that is; `None` where nothing did. In a part that no step divides, flights in
/// its middle may differ from those on both sides: there are many more places for that, so it needs a strength of `there_and_back`, and
/// so do changes beside it.
pub fn steps<T>(
    flights: usize,
    judge: &impl Fn(&Groups) -> Option<(f64, T)>,
    there_and_back: f64,
) -> Vec<Step<T>> {
    let mut found = Vec::new();
    search(0, flights, (judge, 0.0, there_and_back), &mut found);
    found.sort_by_key(|step: &Step<T>| step.from);
    found
}

/// Says of each step which earlier flights the vehicle is as again. `is_same` judges whether two groups of flights do not differ, and
/// certainly by less than the step.
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

/// Judges two groups, the strength that a step needs, and that which one there and back needs.
type Search<'a, T> = (&'a Judge<'a, T>, f64, f64);
/// How strong a change between two groups is, and what it is; `None` where nothing changed.
type Judge<'a, T> = dyn Fn(&Groups) -> Option<(f64, T)> + 'a;

fn search<T>(
    first: usize,
    end: usize,
    (judge, least, there_and_back): Search<'_, T>,
    found: &mut Vec<Step<T>>,
) {
    let judged = (first + 1..end).filter_map(|from| {
        let groups = Groups { before: (first..from).collect(), after: (from..end).collect() };
        let (strength, change) = judge(&groups).filter(|(strength, _)| *strength >= least)?;
        Some((strength, Step { from, groups, change, as_before: Vec::new() }))
    });
    if let Some((_, step)) = judged.max_by(|a, b| a.0.total_cmp(&b.0)) {
        let from = step.from;
        found.push(step);
        search(first, from, (judge, least, there_and_back), found);
        search(from, end, (judge, least, there_and_back), found);
    } else if let Some((from, to)) = middle(first, end, (judge, there_and_back)) {
        let others = || (first..from).chain(to..end).collect::<Vec<_>>();
        // beside its neighbours where they show it, otherwise beside all others
        let step = |from: usize, groups: Groups, wide: Groups| {
            let (groups, (_, change)) = judge(&groups)
                .map(|judged| (groups, judged))
                .or_else(|| Some((wide.clone(), judge(&wide)?)))?;
            Some(Step { from, groups, change, as_before: Vec::new() })
        };
        let own = || (from..to).collect::<Vec<_>>();
        let there = Groups { before: (first..from).collect(), after: own() };
        let back = Groups { before: own(), after: (to..end).collect() };
        found.extend(step(from, there, Groups { before: others(), after: own() }));
        found.extend(step(to, back, Groups { before: own(), after: others() }));
        // as many places as for the change in the middle
        for (first, end) in [(first, from), (from, to), (to, end)] {
            search(first, end, (judge, there_and_back, there_and_back), found);
        }
    }
}

/// From and to of the flights within a part of a row that differ the most from those on both sides of them, if they do so enough.
fn middle<T>(first: usize, end: usize, (judge, least): (&Judge<'_, T>, f64)) -> Option<(usize, usize)> {
    if end - first > MOST_THERE_AND_BACK {
        return None;
    }
    let inside = (first + 1..end).flat_map(|from| (from + 1..end).map(move |to| (from, to)));
    let judged = inside.filter_map(|(from, to)| {
        let groups = Groups { before: (first..from).chain(to..end).collect(), after: (from..to).collect() };
        judge(&groups).map(|(strength, _)| (strength, (from, to))).filter(|(strength, _)| *strength >= least)
    });
    judged.max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, found)| found)
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
        let mut found = steps(row.len(), &judge, f64::INFINITY);
        assert!(found.iter().all(|step| step.as_before.is_empty()));
        let places: Vec<usize> = found.iter().map(|step| step.from).collect();
        assert_eq!(places, [3, 5]);
        assert!(found[0].change > 0.0 && found[1].change < 0.0);
        find_returns(row.len(), &mut found, &|groups, _| judge(groups).is_none());
        assert!(found.iter().all(|step| step.as_before.is_empty()), "2 is not 1");
        assert!(steps(3, &judge, 0.0).is_empty());
        assert!(steps(0, &judge, 0.0).is_empty());
    }

    #[test]
    fn a_row_that_goes_back_says_to_which_flights() {
        let row = [1.0, 1.1, 0.9, 3.0, 3.1, 1.0, 1.1, 0.9];
        let judge = difference(&row);
        let mut found = steps(row.len(), &judge, f64::INFINITY);
        find_returns(row.len(), &mut found, &|groups, _| judge(groups).is_none());
        let returned: Vec<(usize, &[usize])> =
            found.iter().map(|step| (step.from, step.as_before.as_slice())).collect();
        assert_eq!(returned, [(3, &[][..]), (5, &[0, 1, 2][..])]);
    }
    #[test]
    fn flights_between_others_that_differ_from_both_are_found_where_no_step_divides_the_row() {
        // a step must part the row by as much as it scatters
        let row = [1.0, 1.1, 0.9, 1.8, 1.9, 1.8, 1.0, 1.0, 1.1, 0.9, 1.0, 1.1];
        let judge = |groups: &Groups| {
            let of = |places: &[usize]| {
                let mean = places.iter().map(|place| row[*place]).sum::<f64>() / places.len() as f64;
                (mean, places.iter().map(|place| (row[*place] - mean).powi(2)).sum::<f64>())
            };
            let ((before, one), (after, other)) = (of(&groups.before), of(&groups.after));
            let scatter = ((one + other) / 10.0).sqrt().max(0.1);
            let strength = (after - before).abs() / scatter;
            (strength > 1.5).then_some((strength, after - before))
        };
        assert!(steps(row.len(), &judge, f64::INFINITY).is_empty());
        let found = steps(row.len(), &judge, 5.0);
        assert_eq!(found.iter().map(|step| step.from).collect::<Vec<_>>(), [3, 6]);
        assert!(found[0].change > 0.7 && found[1].change < -0.7);
        assert_eq!((&found[0].groups.before, &found[0].groups.after), (&vec![0, 1, 2], &vec![3, 4, 5]));
    }
}
