//! What a further flight would bring, in one sentence.

use crate::diagnose::experiment::{NextFlight, Pair};
use crate::diagnose::{ByPart, called, known_to};
use crate::report::number::{spoken, with_error};
use crate::study::ExplainStudy;
use crate::text::capital;

/// What a further flight would bring; `None` where none was designed.
#[must_use]
pub fn next_flight_words(study: &ExplainStudy) -> Option<String> {
    let next = study.next_flight.as_ref()?;
    let said = match next {
        Ok(next) if study.would_gain() => {
            format!("{}{}{}", known(study), unsettled(study), brought(study, next))
        }
        _ if study.is_certain() => {
            let names = if study.effects.is_empty() { "" } else { "Every name that was given is certain. " };
            let latency = unnamed_latency(study);
            format!("{names}{}{latency}There is nothing that another flight would bring.", known(study))
        }
        Ok(next) => {
            let apart = never_apart(next);
            match not_apart(next).as_str() {
                "" => format!("{}{apart}For these names no further flight is needed.", known(study)),
                not_apart => format!("{}{not_apart}{apart}", known(study)).trim_end().to_owned(),
            }
        }
        Err(_) if study.unsettled().next().is_some() => {
            format!(
                "{}{}A further flight would show whether it is there again.",
                known(study),
                unsettled(study)
            )
        }
        Err(why) => format!("{}A further flight would not tell more: {why}.", known(study)),
    };
    Some(said)
}

/// A sentence on a latency that has no name.
fn unnamed_latency(study: &ExplainStudy) -> String {
    let said = |(value_s, std_s): (f64, f64)| {
        format!(
            "{} ms from command to rotor have no name: whether the motors lag or the commands are delayed is not told apart here. ",
            with_error(1e3 * value_s, 1e3 * std_s)
        )
    };
    study.unnamed_latency_s().map_or_else(String::new, said)
}

/// A sentence on the sizes that are known, where there are some.
fn known(study: &ExplainStudy) -> String {
    let one = |effect| {
        let percent = 100.0 * known_to(effect)?;
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

/// What the designed flight separates, of that which a user needs.
fn brought(study: &ExplainStudy, next: &NextFlight) -> String {
    let seconds = format!("A further flight of {:.0} s would", next.seconds);
    let sigma = |pair: &Pair| pair.distance("it");
    let pairs = study.worthwhile(next).map(|pair| match pair.other {
        Some(other) => {
            format!("{seconds} tell {} from {} ({}). ", called(pair.named), called(other), sigma(pair))
        }
        None => format!(
            "{seconds} determine {} better (the statistical part of its error falls to {:.0} % of what it is now). ",
            called(pair.named),
            100.0 * pair.share_left()
        ),
    });
    let mut said: String = pairs.collect();
    if said.is_empty() {
        said = "A further flight would show whether it is there again. ".to_owned();
    }
    (said + &not_apart(next) + &never_apart(next)).trim_end().to_owned()
}

/// A sentence on each pair that the designed flight does not separate.
fn not_apart(next: &NextFlight) -> String {
    let pairs = next.pairs.iter().filter(|pair| !pair.is_told_apart());
    let said = pairs.filter_map(|pair| {
        let (named, other) = (called(pair.named), called(pair.other?));
        let otherwise = pair.otherwise().map_or_else(String::new, |how| format!("; {how}"));
        Some(format!(
            "A further flight of {:.0} s would not tell {named} from {other} ({}{otherwise}). ",
            next.seconds,
            pair.distance("it")
        ))
    });
    said.collect()
}

/// A sentence on each pair that no trajectory separates.
fn never_apart(next: &NextFlight) -> String {
    let apart = next.inseparable.iter().map(|pair| {
        format!("No trajectory tells {} from {}: {}. ", called(pair.named), called(pair.other), pair.why)
    });
    apart.collect()
}
