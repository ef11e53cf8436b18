//! Names of flights in sentences: the end of a path that tells a flight from the others.

use crate::study::CompareStudy;
use std::cmp::Reverse;

/// The file's name of a flight, with as many folders as tell it from the others.
pub(super) fn flight_name(study: &CompareStudy, place: usize) -> &str {
    distinct_end(&paths(study), place)
}

/// The names of some flights, one after the other.
pub(super) fn flight_names(study: &CompareStudy, places: &[usize]) -> String {
    let names: Vec<&str> = places.iter().map(|&place| flight_name(study, place)).collect();
    names.join(", ")
}

/// Words in which the flights have these names in place of their paths.
pub(super) fn with_names(study: &CompareStudy, words: &str) -> String {
    named(&paths(study), words)
}

fn paths(study: &CompareStudy) -> Vec<&str> {
    study.flights.iter().map(|flight| flight.input.path.as_str()).collect()
}

fn named(paths: &[&str], words: &str) -> String {
    let mut order: Vec<usize> = (0..paths.len()).collect();
    // one may end as another does
    order.sort_by_key(|&place| Reverse(paths[place].len()));
    order
        .into_iter()
        .fold(words.to_owned(), |words, place| words.replace(paths[place], distinct_end(paths, place)))
}

/// The shortest end of a path, of whole names, in which no other path ends; the whole path where there is none.
fn distinct_end<'a>(paths: &[&'a str], place: usize) -> &'a str {
    let whole = paths[place];
    let begins = whole.rmatch_indices(['/', '\\']).map(|(at, _)| at + 1);
    let ends = |other: &str, end: &str| {
        let before = other.strip_suffix(end);
        before.is_some_and(|before| before.is_empty() || before.ends_with(['/', '\\']))
    };
    let others = || paths.iter().enumerate().filter(|(at, _)| *at != place).map(|(_, path)| *path);
    begins.map(|at| &whole[at..]).find(|end| !others().any(|other| ends(other, end))).unwrap_or(whole)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flight_has_the_shortest_end_of_its_path_that_is_its_own() {
        let of = |paths: &[&str]| -> Vec<String> {
            (0..paths.len()).map(|place| distinct_end(paths, place).to_owned()).collect()
        };
        assert_eq!(of(&["/a/b/one.bin", "/a/b/two.bin"]), ["one.bin", "two.bin"]);
        assert_eq!(
            of(&["logs/mon/f1.bin", "logs/tue/f1.bin", "logs/tue/f11.bin"]),
            ["mon/f1.bin", "tue/f1.bin", "f11.bin"]
        );
        // an end of a name is no name
        assert_eq!(of(&["x/1.bin", "x/11.bin", "C:\\logs\\a.bin"]), ["1.bin", "11.bin", "a.bin"]);
        // a path that ends another one
        assert_eq!(of(&["f.bin", "a/f.bin"]), ["f.bin", "a/f.bin"]);
        assert_eq!(of(&["m/radio.tlog, flight 1", "m/radio.tlog, flight 2"])[1], "radio.tlog, flight 2");
    }

    #[test]
    fn sentences_have_names_in_place_of_paths() {
        let paths = ["/l/mon/f1.bin", "/l/tue/f1.bin", "/l/mon/f2.bin"];
        assert_eq!(
            named(&paths, "/l/tue/f1.bin, /l/mon/f1.bin and /l/mon/f2.bin: 3 m/s"),
            "tue/f1.bin, mon/f1.bin and f2.bin: 3 m/s"
        );
    }
}
