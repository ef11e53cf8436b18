//! The answer in one line of a terminal.

use crate::diagnose::{Verdict, brief};
use crate::study::ExplainStudy;
use crate::text::list;

/// The answer in so many columns: with the sizes of the effects where they find room, else with their names, else with their
/// number.
#[must_use]
pub fn answer_line(study: &ExplainStudy, columns: usize) -> String {
    let doubtful = if study.doubts().is_empty() { "" } else { "doubtful: " };
    let limited = if study.limited().is_empty() { "" } else { "limited flight: " };
    let names = |with_size| -> String {
        let each = study.effects.iter().map(|effect| brief(effect, study.vehicle(), with_size));
        list(&each.collect::<Vec<_>>())
    };
    let forms = match study.effects.len() {
        0 => Vec::new(),
        count => vec![names(true), names(false), format!("{count} effects")],
    };
    let was = if study.effects.len() > 1 { "were" } else { "was" };
    let found: Vec<String> = match study.verdict() {
        Verdict::NothingMissing => vec![nothing(study).to_owned()],
        Verdict::Unexplained => vec!["there is a deviation that no known effect explains".to_owned()],
        Verdict::Explained => forms.iter().map(|names| format!("{names} {was} left out")).collect(),
        Verdict::PartlyExplained => {
            let more = "another deviation has no known cause";
            forms.iter().map(|names| format!("{names} {was} left out; {more}")).collect()
        }
    };
    first_that_fits(found.into_iter().map(|found| format!("answer: {limited}{doubtful}{found}")), columns)
}

/// The first that finds room; the last where none does.
fn first_that_fits(forms: impl Iterator<Item = String>, columns: usize) -> String {
    let mut last = String::new();
    for form in forms {
        last = form;
        if last.chars().count() <= columns {
            break;
        }
    }
    last
}

fn nothing(study: &ExplainStudy) -> &'static str {
    let is_unsure = study.short.as_ref().is_some_and(|short| !short.unsure.is_empty());
    let has_own = study.along.iter().any(|along| !along.of_one_flight.is_empty());
    if is_unsure {
        "no name is certain"
    } else if study.explanation.too_little_excitation {
        "the vehicle moved too little to tell"
    } else if study.refuted.is_some() {
        "no name holds"
    } else if has_own {
        "single flights have effects of their own; nothing else is missing"
    } else if study.much_left().is_some() {
        "nothing was found, and much is left over"
    } else {
        "nothing is missing that could be shown"
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_longest_form_that_finds_room_is_taken() {
        let forms = || ["drag (1 N per m/s)", "drag", "1"].into_iter().map(str::to_owned);
        assert_eq!(first_that_fits(forms(), 18), "drag (1 N per m/s)");
        assert_eq!(first_that_fits(forms(), 17), "drag");
        assert_eq!(first_that_fits(forms(), 0), "1");
    }
}
