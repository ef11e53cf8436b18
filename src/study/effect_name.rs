//! An effect by what a person calls it: its identifier or its name, without regard to case, spaces, hyphens and underscores.

use crate::diagnose::called;
use crate::physics::Effect;
use crate::physics::effects::ALL;
use crate::text::excerpt;

/// Words before a name that are no part of it.
const ARTICLES: [&str; 3] = ["a", "an", "the"];
/// So many wrong letters of a name are taken for slips, as a share of its letters.
const SLIPS: f64 = 0.34;

/// The effect of a name or an identifier.
///
/// # Errors
/// There is none: in words what was expected, and the nearest.
pub(super) fn effect_of(name: &str) -> Result<&'static dyn Effect, String> {
    let wanted = folded(name);
    let is_it = |effect: &&dyn Effect| names(effect.id()).contains(&wanted);
    if let Some(effect) = ALL.iter().copied().find(is_it) {
        return Ok(effect);
    }
    let known = ALL.iter().map(|effect| effect.id()).collect::<Vec<_>>().join(", ");
    let near =
        nearest(&wanted).map_or_else(String::new, |id| format!("; the nearest is {} ({id})", called(id)));
    Err(format!("expected one of {known}, or what `mavid effects` calls it, got {}{near}", excerpt(name, 40)))
}

/// The identifier of the effect with the nearest name; `None` where none is near.
fn nearest(wanted: &str) -> Option<&'static str> {
    let length = wanted.chars().count();
    let far = |id: &'static str| {
        let of = |name: &String| match !wanted.is_empty() && name.contains(wanted) {
            true => 0,
            false => letters_apart(name, wanted),
        };
        (names(id).iter().map(of).min().unwrap_or(usize::MAX), id)
    };
    let (apart, id) = ALL.iter().map(|effect| far(effect.id())).min_by_key(|(apart, _)| *apart)?;
    (apart as f64 <= SLIPS * length as f64).then_some(id)
}

/// An identifier and the name that people read, as they are compared.
fn names(id: &str) -> [String; 2] {
    [folded(id), folded(called(id))]
}

/// Small letters and digits alone, without an article before them, in British spelling.
fn folded(name: &str) -> String {
    let small = name.to_lowercase().replace("center", "centre");
    let mut words: Vec<&str> =
        small.split(|letter: char| !letter.is_alphanumeric()).filter(|word| !word.is_empty()).collect();
    if words.len() > 1 && ARTICLES.contains(&words[0]) {
        words.remove(0);
    }
    words.concat()
}

/// Letters that have to be changed, added or left out to make one word of another (Levenshtein's distance).
fn letters_apart(one: &str, other: &str) -> usize {
    let other: Vec<char> = other.chars().collect();
    let mut above: Vec<usize> = (0..=other.len()).collect();
    for (row, letter) in one.chars().enumerate() {
        let mut here = vec![row + 1];
        for (column, wanted) in other.iter().enumerate() {
            let changed = above[column] + usize::from(letter != *wanted);
            here.push(changed.min(above[column + 1] + 1).min(here[column] + 1));
        }
        above = here;
    }
    above.last().copied().unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_effect_is_found_by_its_name_and_by_its_identifier_however_they_are_written() {
        for effect in ALL {
            let id = effect.id();
            for name in [id.to_owned(), id.replace('_', "-").to_uppercase(), called(id).to_owned()] {
                assert_eq!(effect_of(&name).map(|found| found.id()), Ok(id), "{name}");
            }
        }
        for name in ["Motor Lag", "motor-lag", "MOTORLAG", "the motor lag", " motor  lag "] {
            assert_eq!(effect_of(name).map(|found| found.id()), Ok("motor_lag"), "{name}");
        }
        assert_eq!(effect_of("weak rotor").map(|found| found.id()), Ok("weak_rotor"));
    }

    #[test]
    fn of_a_name_that_is_none_the_nearest_is_said() {
        for (name, near) in [
            ("motr lag", "the nearest is motor lag (motor_lag)"),
            ("center of mass", "(com_offset)"),
            ("slung", "(slung_load)"),
        ] {
            let why = effect_of(name).map(|found| found.id()).unwrap_err();
            assert!(why.ends_with(near), "{name}: {why}");
        }
        for name in ["", "---", "gravity waves"] {
            let why = effect_of(name).map(|found| found.id()).unwrap_err();
            assert!(why.starts_with("expected one of linear_drag, ") && !why.contains("nearest"), "{why}");
        }
    }

    #[test]
    fn letters_apart_are_counted() {
        assert_eq!((letters_apart("kitten", "sitting"), letters_apart("", "lag")), (3, 3));
    }
}
