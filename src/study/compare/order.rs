//! Whether flights were given in the order in which they were flown.

use crate::note::{About, Note};
use crate::text::utc;

/// When a flight began, microseconds since 1970 UTC, where its log says so, and its name.
pub(super) type Begun<'a> = (Option<u64>, &'a str);

/// Flights that are named; of more their number is told.
const NAMED: usize = 4;

/// A warning where flights began before those that were given ahead of them: of a history each with the flight before it, of groups where
/// all of after began before all of before. `first` is the number of flights before; as many as there are flights for a history. The given
/// order stays.
pub(super) fn out_of_order(flights: &[Begun<'_>], first: usize) -> Option<Note> {
    let (before, after) = flights.split_at_checked(first)?;
    let text = if after.is_empty() { of_history(flights) } else { of_groups(before, after) }?;
    Some(Note::warning(About::Vehicle, text))
}

/// Sorts the flights of a history by their start times, where each is known; whether that moved one.
pub(super) fn by_start_times<T>(flights: &mut [T], start_utc_us: impl Fn(&T) -> Option<u64>) -> bool {
    let is_moved =
        flights.iter().all(|one| start_utc_us(one).is_some()) && !flights.is_sorted_by_key(&start_utc_us);
    if is_moved {
        flights.sort_by_key(start_utc_us);
    }
    is_moved
}

/// What is said then.
pub(super) const REORDERED: &str = "the flights are compared in the order of their start times, which is not the order in which they were given";

/// Each flight beside the latest of those that were given ahead of it.
fn of_history(flights: &[Begun<'_>]) -> Option<String> {
    let mut latest: Option<(u64, &str)> = None;
    let mut told = Vec::new();
    for (began_us, name) in flights {
        let Some(began_us) = *began_us else { continue };
        match latest {
            Some((latest_us, earlier)) if began_us < latest_us => told.push(format!(
                "{name} began at {}, before {earlier} ({}), which is given ahead of it",
                utc(began_us),
                utc(latest_us)
            )),
            _ => latest = Some((began_us, name)),
        }
    }
    if told.is_empty() {
        return None;
    }
    let more = told.len().saturating_sub(NAMED);
    told.truncate(NAMED);
    let more = if more > 0 { format!("; and {more} more") } else { String::new() };
    Some(format!(
        "the flights are not given in the order of their start times: {}{more}. The given order is kept: a change is told as from a \
         flight on in this order",
        told.join("; ")
    ))
}

/// All of after began before all of before.
fn of_groups(before: &[Begun<'_>], after: &[Begun<'_>]) -> Option<String> {
    let dated =
        |group: &[Begun<'_>]| group.iter().map(|(began_us, _)| *began_us).collect::<Option<Vec<u64>>>();
    let (first_us, last_us) = (dated(before)?.into_iter().min()?, dated(after)?.into_iter().max()?);
    let names = |group: &[Begun<'_>]| match group.len() {
        1..=NAMED => group.iter().map(|(_, name)| *name).collect::<Vec<_>>().join(", "),
        count => format!("{count} flights"),
    };
    (last_us < first_us).then(|| {
        format!(
            "the flights after --with ({}, until {}) all began before those that are given as before ({}, from {} on): what is told as \
             before was flown later. The given order is kept",
            names(after),
            utc(last_us),
            names(before),
            utc(first_us)
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn told(starts_s: &[Option<u64>], first: usize) -> Option<String> {
        let names = ["a", "b", "c", "d"];
        let flights: Vec<Begun<'_>> = starts_s
            .iter()
            .zip(names)
            .map(|(start_s, name)| (start_s.map(|s| 1_000_000 * s), name))
            .collect();
        out_of_order(&flights, first).map(|note| note.text)
    }

    #[test]
    fn a_history_names_the_flights_that_began_before_those_ahead_of_them() {
        assert_eq!(told(&[Some(10), Some(20), Some(20), Some(30)], 4), None);
        assert_eq!(told(&[Some(10), None, Some(30)], 3), None);
        let said = told(&[Some(10), Some(30), None, Some(20)], 4).unwrap();
        assert!(
            said.contains("d began at 1970-01-01 00:00:20 UTC, before b (1970-01-01 00:00:30 UTC)"),
            "{said}"
        );
        assert!(!said.contains("a began") && !said.contains("before a"), "{said}");
    }

    #[test]
    fn a_history_is_sorted_where_each_flight_is_dated() {
        let mut dated = [(Some(30), 'a'), (Some(10), 'b'), (Some(30), 'c')];
        assert!(by_start_times(&mut dated, |one| one.0));
        assert_eq!(dated.map(|one| one.1), ['b', 'a', 'c']);
        assert!(!by_start_times(&mut dated, |one| one.0));
        let mut undated = [(Some(30), 'a'), (None, 'b'), (Some(10), 'c')];
        assert!(!by_start_times(&mut undated, |one| one.0));
        assert_eq!(undated.map(|one| one.1), ['a', 'b', 'c']);
    }

    #[test]
    fn groups_are_told_where_all_of_after_began_earlier() {
        let said = told(&[Some(50), Some(40), Some(10), Some(30)], 2).unwrap();
        assert!(
            said.contains("(c, d, until 1970-01-01 00:00:30 UTC)") && said.contains("(a, b, from"),
            "{said}"
        );
        // a group has no order, and one flight that was flown between says nothing
        assert_eq!(told(&[Some(50), Some(40), Some(60)], 2), None);
        assert_eq!(told(&[Some(50), Some(20), Some(30)], 2), None);
        assert_eq!(told(&[Some(50), Some(40), None], 2), None);
    }
}
