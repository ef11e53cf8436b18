//! The answer in one sentence.

use super::limits::{unseen_of_usual_size, would_show};
use super::no_model::{left_out_force, no_model, spoken_along, written};
use super::own_wind::own_wind;
use super::whereabouts::whereabouts;
use crate::diagnose::holdout::HoldoutFit;
use crate::diagnose::{Named, Verdict, brief, called, clause};
use crate::report::number::significant;
use crate::study::{ExplainStudy, FlightLimit, Predicted, Refuted, ValidationData};
use crate::text::{list, list_or};

/// Largest number of effects that are listed with their sizes.
const SIZED: usize = 4;

/// The answer in one sentence; what makes it doubtful and what limits the flights come first, or last where that concerns no name.
#[must_use]
pub fn answer(study: &ExplainStudy) -> String {
    let found = format!(
        "{}{}{}{}{}",
        limits(study),
        found(study),
        withdrawn(study),
        left_out_force(study),
        no_model(study)
    );
    match study.doubts().as_slice() {
        [] => found,
        [doubt] if study.doubts_torques_alone() => {
            let doubt = doubt.strip_prefix("it ").unwrap_or(doubt);
            format!(
                "{found} Moments of inertia and torques are doubtful, the forces are not: the inertia {doubt}."
            )
        }
        doubts => format!("Doubtful: {}. {found}", doubts.join("; ")),
    }
}

/// What limits the flights by the way they were flown.
fn limits(study: &ExplainStudy) -> String {
    let clauses: Vec<String> = study.limited().iter().map(FlightLimit::words).collect();
    let unsure = if study.effects.is_empty() { "" } else { "; no name is certain" };
    if clauses.is_empty() { String::new() } else { format!("Limited: {}{unsure}. ", clauses.join("; ")) }
}

fn found(study: &ExplainStudy) -> String {
    match study.verdict() {
        Verdict::NothingMissing if !unsure_names(study).is_empty() => format!(
            "No name is certain: this flight shows {}, but not surely enough, so the model stays the rigid body.",
            list(unsure_names(study))
        ),
        Verdict::NothingMissing => {
            let nothing = match of_one_flight(study).trim_start_matches("; ") {
                "" => nothing(study),
                alone => beside_what_is_alone(&nothing(study), alone),
            };
            let wind = own_wind(study).map(|wind| format!(" The air moved: there was {wind}."));
            format!("{nothing}{}", wind.unwrap_or_default())
        }
        Verdict::Explained => {
            format!("{}{}.{}{}", left_out(study), gain(study), not_told_apart(study), unsure(study))
        }
        Verdict::PartlyExplained => format!(
            "{}{}. There is another deviation that no known effect explains: {}.{}{}",
            left_out(study),
            gain(study),
            whereabouts(&study.left_over()),
            not_told_apart(study),
            unsure(study)
        ),
        Verdict::Unexplained => unexplained(study),
    }
}

/// What flights have alone, and that nothing else is missing.
fn beside_what_is_alone(nothing: &str, alone: &str) -> String {
    let own = format!("Single flights have something of their own: {alone}.");
    match nothing.strip_prefix('N') {
        Some(nothing) => format!("{own} Apart from that, n{nothing}"),
        None => format!("{own} {nothing}"),
    }
}

/// A sentence on what a short flight shows beside the names, not surely enough for one.
fn unsure(study: &ExplainStudy) -> String {
    match unsure_names(study) {
        [] => String::new(),
        unsure => format!(" It also shows {}, but not surely enough for a name.", list(unsure)),
    }
}

/// A sentence on what the flights explained show, and the hold-out does not.
fn withdrawn(study: &ExplainStudy) -> String {
    let names = study.withdrawn.as_slice();
    if names.is_empty() {
        return String::new();
    }
    let (have, them) = if names.len() > 1 { ("have", "them") } else { ("has", "it") };
    let (on, another) = (study.shown_on.words(), matches!(study.shown_on, ValidationData::Flights(_)));
    let changed = if another { " If the vehicle changed in between, mavid compare tells what." } else { "" };
    format!(
        " What was explained also shows {}, but the errors on {on} do not confirm {them}, so {} {have} no name.{changed}",
        list(names),
        if names.len() > 1 { "they" } else { "it" }
    )
}

fn unsure_names(study: &ExplainStudy) -> &[String] {
    study.short.as_ref().map_or(&[], |short| &short.unsure)
}

/// The named effects: one effect in full, several with their sizes, the rest without; and the wind, which is each flight's own.
fn left_out(study: &ExplainStudy) -> String {
    let vehicle = study.vehicle();
    let of_one_flight = of_one_flight(study);
    if let [one] = study.effects.as_slice() {
        let wind = own_wind(study).map(|wind| format!("; beside it there was {wind}"));
        let wind = wind.unwrap_or_default();
        return format!("{}{}{wind}{of_one_flight}", clause(one, vehicle), in_flights(study, one));
    }
    let sized = if study.effects.len() <= SIZED { SIZED } else { SIZED - 1 };
    let (large, small) = study.effects.split_at(sized.min(study.effects.len()));
    let words = |effects: &[Named], with_size| -> Vec<String> {
        effects
            .iter()
            .map(|effect| format!("{}{}", brief(effect, vehicle, with_size), in_flights(study, effect)))
            .collect()
    };
    let large: Vec<String> = words(large, true).into_iter().chain(own_wind(study)).collect();
    match words(small, false).as_slice() {
        [] => format!("Several effects were left out: {}{of_one_flight}", list(&large)),
        small => {
            let (large, small) = (list(&large), list(small));
            format!("Several effects were left out: {large}; and to a lesser degree {small}{of_one_flight}")
        }
    }
}

/// The flights that a name is of, where not all of them have it, or each has its own.
fn in_flights(study: &ExplainStudy, effect: &Named) -> String {
    let sized = study.along.iter().flat_map(|along| &along.sized_by);
    let of = sized.into_iter().find(|(id, _)| *id == effect.id);
    let Some((_, flights)) = of else { return String::new() };
    let carried = study.along.iter().flat_map(|along| &along.carried_by).find(|(id, _)| *id == effect.id);
    let others = carried.and_then(|(_, by)| by.as_deref()).unwrap_or_default();
    let others: Vec<usize> = others.iter().copied().filter(|flight| !flights.contains(flight)).collect();
    match others.as_slice() {
        [] => format!(" in {}", paths(study, flights)),
        others => format!(" in {} (with another size in {})", paths(study, flights), paths(study, others)),
    }
}

/// What single flights have alone, as a clause.
fn of_one_flight(study: &ExplainStudy) -> String {
    let alone = study.along.iter().flat_map(|along| &along.of_one_flight);
    let said = alone.map(|(flight, named)| {
        format!("; in {} alone {}", paths(study, &[*flight]), brief(named, study.vehicle(), true))
    });
    said.collect()
}

fn paths(study: &ExplainStudy, flights: &[usize]) -> String {
    let path = |flight: &usize| study.given.inputs[*flight].path.clone();
    list(&flights.iter().map(path).collect::<Vec<_>>())
}

/// A sentence on the effects that the flight does not distinguish from a named one.
fn not_told_apart(study: &ExplainStudy) -> String {
    // what is told apart and explains nearly as much stands in the list of rivals
    let pairs: Vec<String> = study
        .effects
        .iter()
        .filter_map(|effect| {
            let rivals = effect.confusable_with.iter().filter(|other| !other.is_told_apart());
            let others: Vec<&str> = rivals.map(|other| called(other.id)).collect();
            (!others.is_empty()).then(|| format!("{} from {}", called(effect.id), others.join(" or ")))
        })
        .collect();
    if pairs.is_empty() {
        return String::new();
    }
    let these = if study.given.inputs.len() > 1 { "These flights" } else { "This flight" };
    format!(" {these} cannot distinguish {}.", pairs.join(", nor "))
}

/// The prediction gain on data that were not used.
fn gain(study: &ExplainStudy) -> String {
    if let Some(by) = study.other_vehicle() {
        return format!("; {} ({by}), so nothing is shown on it", whose(study));
    }
    let Some(pair) = study.holdout.as_ref() else { return String::new() };
    let are_several = study.effects.len() > 1 || own_wind(study).is_some();
    let with = if are_several { "them" } else { "it" };
    let shown = study.shown_on.words();
    if pair.most().is_none() {
        return format!("; on {shown} nothing could be predicted");
    }
    // the model that is written has no empirical force
    let pair = written(study).unwrap_or(pair);
    let rises = pair.rises();
    let worse =
        rises.map_or_else(String::new, |(name, percent)| format!(", that of {name} rises by {percent:.0} %"));
    match pair.falls() {
        Some((name, percent)) => {
            let written = by_written(study, name);
            format!("; with {with} the 0.5 s {name} error on {shown} falls by {percent:.0} %{worse}{written}")
        }
        None => format!("; with {with} the 0.5 s errors on {shown} do not fall{worse}"),
    }
}

/// The error of a quantity with the model file as it is, where the gain is with a load that no model file has.
fn by_written(study: &ExplainStudy, quantity: &str) -> String {
    let of = |predicted: &Predicted| predicted.errors_of(quantity);
    let errors = study.as_written.as_ref().and_then(of).zip(study.holdout.as_ref().and_then(of));
    let Some(((written, unit), (loaded, _))) = errors else { return String::new() };
    let error = written.after.value;
    let baseline = match (100.0 * (1.0 - error / loaded.better_baseline())).round() {
        more if more < 0.0 => format!(", {:.0} % above the better baseline", -more),
        less if less > 0.0 => format!(", {less:.0} % below the better baseline"),
        _ => String::new(),
    };
    let by = format!(
        "the {quantity} error is {} {unit} in place of {} {unit}{baseline}",
        significant(error, 3),
        significant(loaded.after.value, 3)
    );
    format!(
        " (all this with the mass and centre of mass that the first seconds of each flight there show; with model.toml as it is, {by})"
    )
}

fn whose(study: &ExplainStudy) -> &'static str {
    match study.shown_on {
        ValidationData::HeldBack { .. } => "something changed in the part of the flight that was held back",
        ValidationData::LeftOut { .. } => "the flights are not of one vehicle",
        _ if study.shown.as_ref().is_some_and(HoldoutFit::holds_more) => {
            "the hold-out is of another vehicle or contains something that the flights explained do not"
        }
        _ => "the hold-out is of another vehicle, or something of this one changed",
    }
}

fn nothing(study: &ExplainStudy) -> String {
    let limits = &study.explanation.limits;
    let seen = would_show(limits);
    let other = study
        .other_vehicle()
        .map_or_else(String::new, |by| format!(" But {} ({by}), so nothing is shown on it.", whose(study)));
    if study.explanation.too_little_excitation {
        let could =
            if seen.is_empty() { String::new() } else { format!("; it could show {}", list_or(&seen)) };
        let these = study.these_flights();
        let (why, fly) = if study.given.has_velocity {
            (
                format!("the vehicle hardly moves in {these}"),
                "Fly a trajectory that moves all axes (mavid plan)",
            )
        } else {
            (format!("velocity and attitude are not both recorded in {these}"), "Log both")
        };
        return format!(
            "Too little excitation: {why}, so drag, damping, ground effect and similar effects could not be detected at any usual \
             size{could}, and none of this was found. {fly}.{other}"
        );
    }
    if let Some(refuted) = &study.refuted {
        return taken_back(refuted, &study.shown_on);
    }
    let would =
        if seen.is_empty() { String::new() } else { format!("; it would have shown {}", list_or(&seen)) };
    let would = match unseen_of_usual_size(limits).as_slice() {
        [] => would,
        unseen => format!("{would}, but not {} of usual size", list_or(unseen)),
    };
    let traces: Vec<String> =
        study.explanation.slight.iter().map(|of| called(of.effect.id).to_owned()).collect();
    let traces = match traces.as_slice() {
        [] => String::new(),
        traces => format!(
            " Significant, but too small to get a name, and perhaps of another cause: {}.",
            list(traces)
        ),
    };
    let (these, it) = (study.these_flights(), if study.given.inputs.len() > 1 { "them" } else { "it" });
    if let Some((left_n, share)) = study.much_left() {
        return format!(
            "Nothing was found that {these} could show. The rigid body with its rotors leaves a force of {} N rms, {:.0} % of the \
             weight, which follows nothing that was tested: noise, vibration or something unknown{would}.{traces}{other}",
            significant(left_n, 2),
            100.0 * share
        );
    }
    let left = if no_model(study).is_empty() && study.doubts().is_empty() {
        format!("the rigid body with its rotors explains {it} down to the noise")
    } else {
        "what the rigid body with its rotors leaves follows nothing that was tested".to_owned()
    };
    format!("Nothing is missing that {these} could show: {left}{would}.{traces}{other}")
}

/// The flights that were explained show something that the others refute: that is not the same as nothing.
fn taken_back(Refuted { names, worse_percent }: &Refuted, shown_on: &ValidationData) -> String {
    let them = if names.len() > 1 { "them" } else { "it" };
    format!(
        "No name holds. What was explained shows {}, but with {them} the 0.5 s errors on {} are {} % larger in the mean. Why the two \
         differ is not known, so the model stays the rigid body. Fly again, and give both flights; mavid compare tells whether the \
         vehicle changed in between.",
        list(names),
        shown_on.words(),
        significant(*worse_percent, 2)
    )
}

fn unexplained(study: &ExplainStudy) -> String {
    let mut closest: Vec<&str> = study.closest.iter().map(|effect| called(effect.id)).collect();
    closest.dedup();
    let closest = if closest.is_empty() {
        String::new()
    } else {
        format!("; {} comes closest but does not explain it", closest.join(" with "))
    };
    let term = study.empirical.as_ref().map_or_else(String::new, |term| {
        let falls = study.holdout.as_ref().and_then(Predicted::falls);
        let gain = falls.map_or_else(String::new, |(name, percent)| {
            format!(" and lowers the 0.5 s {name} error on {} by {percent:.0} %", study.shown_on.words())
        });
        format!(
            "; an empirical force that depends on {}, without a mechanism, replaces it{gain}",
            spoken_along(term.along)
        )
    });
    format!(
        "There is a deviation that no known effect explains: {}{closest}{term}.{}{}",
        whereabouts(&study.located),
        each_alone(study),
        unsure(study)
    )
}

/// Sentences on what flights show alone that one model does not explain together.
fn each_alone(study: &ExplainStudy) -> String {
    let alone = study.along.iter().flat_map(|along| along.alone.iter().enumerate());
    let shows = |(flight, names): (usize, &Vec<Named>)| {
        let names: Vec<String> = names.iter().map(|named| brief(named, study.vehicle(), true)).collect();
        (!names.is_empty()).then(|| format!("{} shows {}", paths(study, &[flight]), list(&names)))
    };
    let each: Vec<String> = alone.filter_map(shows).collect();
    if each.is_empty() {
        return String::new();
    }
    format!(
        " Alone, {}. No one model explains these flights together: explain each by itself.",
        each.join("; ")
    )
}
