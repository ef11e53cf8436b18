//! Names of models in the narrow columns of a terminal.

use std::collections::BTreeSet;

/// Width of a column's head, letters.
const WIDTH: usize = 14;
/// Mark of omitted letters.
const CUT: char = '\u{2026}';

/// One head for each model, at most [`WIDTH`] letters, different for different names. Long names lose their middle. If
/// that makes two equal, they lose their common beginning; otherwise they are numbered.
pub(super) fn column_heads(names: &[String]) -> Vec<String> {
    let count = |of: &[String]| of.iter().collect::<BTreeSet<_>>().len();
    let plain: Vec<String> = names.iter().map(|name| without_middle(name, WIDTH)).collect();
    let distinct = names.iter().map(|name| without_middle(&distinct_part(name, names), WIDTH)).collect();
    let numbered = || {
        let head = |(number, name): (usize, &String)| {
            let number = format!("{number}:");
            let left = WIDTH.saturating_sub(number.chars().count());
            format!("{number}{}", without_middle(name, left))
        };
        (1..).zip(names).map(head).collect()
    };
    [plain, distinct].into_iter().find(|heads| count(heads) == count(names)).unwrap_or_else(numbered)
}

/// Heads that are not the whole name, each with its name.
#[must_use]
pub fn shortened_names(names: &[String]) -> Vec<(String, String)> {
    column_heads(names).into_iter().zip(names.iter().cloned()).filter(|(head, name)| head != name).collect()
}

/// The first and last letters of a name that is too long.
fn without_middle(name: &str, width: usize) -> String {
    let letters: Vec<char> = name.chars().collect();
    if letters.len() <= width {
        return name.to_owned();
    }
    let kept = width.saturating_sub(1);
    let first = kept / 2;
    let last = letters.len() - (kept - first);
    letters[..first].iter().chain([&CUT]).chain(&letters[last..]).collect()
}

/// A long name without the beginning that all long names have in common.
fn distinct_part(name: &str, names: &[String]) -> String {
    let long = |name: &&str| name.chars().count() > WIDTH;
    if !long(&name) {
        return name.to_owned();
    }
    let others = || names.iter().map(String::as_str).filter(long);
    let alike =
        |other: &str| name.chars().zip(other.chars()).take_while(|(mine, theirs)| mine == theirs).count();
    let common = others().map(alike).min().unwrap_or(0);
    if common == 0 {
        name.to_owned()
    } else {
        std::iter::once(CUT).chain(name.chars().skip(common)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn heads(names: &[&str]) -> Vec<String> {
        column_heads(&names.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>())
    }

    #[test]
    fn long_names_stay_apart() {
        assert_eq!(heads(&["bare", "fourteen_chars"]), ["bare", "fourteen_chars"]);
        assert_eq!(
            heads(&["a_long_name_of_before", "another_long_name_of_before"]),
            ["a_long\u{2026}_before", "anothe\u{2026}_before"]
        );
        assert_eq!(
            heads(&["/one/long/folder/a/model.toml", "/one/long/folder/b/model.toml", "nominal"]),
            ["\u{2026}a/model.toml", "\u{2026}b/model.toml", "nominal"]
        );
        // they differ in the middle of what is left
        let middle = |letter: &str| format!("x{}{letter}{}", "-".repeat(20), "-".repeat(20));
        let (a, b, other) = (middle("a"), middle("b"), "y".repeat(20));
        let found = heads(&[&a, &b, &other]);
        assert!(found[0].starts_with("1:x-") && found[1].starts_with("2:x-"), "{found:?}");
        assert!(found.iter().all(|head| head.chars().count() <= WIDTH), "{found:?}");
    }

    #[test]
    fn only_what_is_cut_is_explained() {
        let names = ["bare".to_owned(), "a_name_beyond_the_width".to_owned()];
        assert_eq!(
            shortened_names(&names),
            [("a_name\u{2026}e_width".to_owned(), "a_name_beyond_the_width".to_owned())]
        );
    }
}
