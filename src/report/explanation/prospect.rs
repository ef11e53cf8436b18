//! What a further flight would bring, in one sentence.

use crate::diagnose::experiment::{NextFlight, Pair};
use crate::diagnose::{ByPart, called};
use crate::report::number::{spoken, with_error};
use crate::study::ExplainStudy;
use crate::text::capital;

/// What a further flight would bring; `None` where none was designed.
#[must_use]
pub fn next_flight_words(study: &ExplainStudy) -> Option<String> {
    let next = study.next_flight.as_ref()?;
    if study.is_certain() {
        let names = if study.effects.is_empty() { "" } else { "Every name is certain: " };
        return Some(capital(&format!("{names}no further flight is needed.")));
    }
    Some(match next {
        Ok(next) => format!("{}{}{}", known(study), unsettled(study), brought(next)),
        Err(_) if study.unsettled().next().is_some() => {
            format!(
                "{}{}A further flight would show whether it is there again.",
                known(study),
                unsettled(study)
            )
        }
        Err(why) => format!("{}A further flight would not tell more: {why}.", known(study)),
    })
}

/// A sentence on the sizes that are known, where there are some.
fn known(study: &ExplainStudy) -> String {
    let one = |effect| {
        let percent = 100.0 * study.known_to(effect)?;
        let digits = usize::from(percent < 1.0);
        Some(format!("{} is known to {percent:.digits$} %", called(effect.id)))
    };
    let all: Vec<String> = study.effects.iter().filter_map(one).collect();
    if all.is_empty() { String::new() } else { format!("{}. ", capital(&all.join(", "))) }
}

/// A sentence on each name that not every part shows.
fn unsettled(study: &ExplainStudy) -> String {
    let of_parts =
        if study.given.inputs.len() > 1 { "one flight after the other gives" } else { "its halves give" };
    let one = |of: &ByPart| {
        let parts: Vec<String> = of.parts.iter().map(|(value, std)| with_error(*value, *std)).collect();
        format!(
            "{} is not certain: {of_parts} {} {}. ",
            capital(called(of.id)),
            parts.join(" and "),
            spoken(of.unit)
        )
    };
    study.unsettled().map(one).collect()
}

/// What the designed flight separates.
fn brought(next: &NextFlight) -> String {
    let seconds = format!("A further flight of {:.0} s would", next.seconds);
    let sigma =
        |pair: &Pair| format!("now {:.1}, with it {:.1} standard deviations", pair.now, pair.with_next());
    let pairs = next.pairs.iter().map(|pair| match pair.other {
        Some(other) => {
            format!("{seconds} tell {} from {} ({})", called(pair.named), called(other), sigma(pair))
        }
        None => format!("{seconds} determine {} better ({} from zero)", called(pair.named), sigma(pair)),
    });
    let apart = next.inseparable.iter().map(|pair| {
        format!("No trajectory tells {} from {}: {}", called(pair.named), called(pair.other), pair.why)
    });
    pairs.chain(apart).map(|sentence| format!("{sentence}.")).collect::<Vec<_>>().join(" ")
}
