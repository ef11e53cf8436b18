//! A comparison in words.

use super::flight_name::flight_name;
use super::own::{doubt, scale};
use crate::change::{NAMED_SIGMAS, Step, Undecided, What};
use crate::report::number::{significant, with_error};
use crate::study::{Change, Changed, CompareStudy, Compared, LeastChange, Track};
use crate::text::capital;

/// What the errors of parameters along the flights hold.
pub(super) const FLIGHTS_OWN_ERRORS: &str = "errors of each flight alone; those of before and after hold the spread between flights of one vehicle as well, and with it \
     that the air has another law of drag, which `explain` holds in the errors of each flight";

/// What the rotors along the flights are.
pub(super) const OF_MEAN_ROTOR: &str = "over that of the mean of all rotors; the centre of mass is taken where the vehicle has it, and errors hold what wanders from flight \
     to flight";

/// A value of one flight with its standard error, or that it has none.
pub(in crate::report) fn value_of(track: &Track, estimate: Option<(f64, f64)>) -> String {
    match estimate {
        None => "not determined".to_owned(),
        Some((value, std)) if track.is_determined((value, std)) => with_error(value, std),
        Some(_) => "not determined".to_owned(),
    }
}

/// Since which flights something is otherwise, as a clause; empty where nothing is.
pub(super) fn changed_since(study: &CompareStudy, what: Changed) -> String {
    let flight = |place: usize| format!("flight {}", place + 1);
    let all: Vec<String> = study.changed(what).map(|dated| since(dated, &flight)).collect();
    if all.is_empty() { String::new() } else { format!("changed {}", all.join(" and ")) }
}

/// Since when something is otherwise, as a clause: from the first flight that shows it on, or, where flights before that do not tell, since
/// the last one that shows what was before. `name` says a flight by its place.
fn since((last, first): (Option<usize>, usize), name: &dyn Fn(usize) -> String) -> String {
    match last {
        Some(last) if last + 1 < first => format!("between {} and {}", name(last), name(first)),
        _ => format!("from {} on", name(first)),
    }
}

/// The same of one change of a step, with the names of the files.
pub(super) fn since_files(study: &CompareStudy, step: &Step<Compared>, what: Changed) -> String {
    since(study.dated(step, what), &|place| flight_name(study, place).to_owned())
}

/// The changes of a step as a clause, those with the same flights together.
pub(in crate::report) fn step_words(
    study: &CompareStudy,
    step: &Step<Compared>,
    name: &dyn Fn(usize) -> String,
) -> String {
    let mut parts: Vec<(String, Vec<String>)> = Vec::new();
    for change in &step.change.changes {
        let (when, words) = (since(study.dated(step, change.what), name), sentence(study, change));
        match parts.iter_mut().find(|(other, _)| *other == when) {
            Some((_, all)) => all.push(words),
            None => parts.push((when, vec![words])),
        }
    }
    let told: Vec<String> =
        parts.into_iter().map(|(when, all)| format!("{when}: {}", all.join("; "))).collect();
    told.join("; ")
}

/// The answer in a few sentences, with what is the flights' own and what speaks against one vehicle.
pub(super) fn answer(study: &CompareStudy) -> String {
    let doubt = doubt(study).map(|doubt| format!(" {doubt}"));
    format!("{}{}{}", what_changed(study), scale(study), doubt.unwrap_or_default())
}

fn what_changed(study: &CompareStudy) -> String {
    match (&study.compared, &study.groups) {
        (Some(compared), Some(groups)) => {
            let between = format!(
                "between {} before and {} after",
                flights(groups.before.len()),
                flights(groups.after.len())
            );
            if let Some(lifts) = compared.other_vehicle {
                return other_vehicle(study, compared, lifts);
            }
            if compared.changes.is_empty() {
                return format!(
                    "Nothing changed {between} that these flights could show. {}{}",
                    unseen(study, compared),
                    all_open(study, compared)
                );
            }
            let all: Vec<String> = compared.changes.iter().map(|change| sentence(study, change)).collect();
            capital(&format!("{} ({between}).", all.join("; ")))
        }
        _ if study.history.is_empty() => {
            let seen = study.least_named().map(|least| would_have_shown(&least));
            let seen = seen.map_or_else(String::new, |seen| format!(" From the middle of them on {seen}."));
            format!(
                "Nothing changed along {} that they could show.{seen}{}",
                flights(study.flights.len()),
                open_along(study)
            )
        }
        _ => {
            let path = |place: usize| flight_name(study, place).to_owned();
            let steps = study
                .history
                .iter()
                .map(|step| format!("{}{}", step_words(study, step, &path), returned(study, step)));
            format!(
                "Along {} the vehicle changed {}.",
                flights(study.flights.len()),
                steps.collect::<Vec<_>>().join("; ")
            )
        }
    }
}

/// Flights that are hardly those of one vehicle.
fn other_vehicle(study: &CompareStudy, compared: &Compared, (before, after): (f64, f64)) -> String {
    let changes = compared.changes.iter().chain(compared.undecided.iter().map(|(change, _)| change));
    let moved: Vec<String> = changes.map(|change| said(study, change.what)).collect();
    format!(
        "These flights are hardly those of one vehicle: full thrust over weight is {} before and {} after, and {} moved as well. Compare \
         flights of one vehicle, with its own vehicle file; if it is one vehicle, its motors, propellers or load are other ones.",
        significant(before, 3),
        significant(after, 3),
        moved.join(", ")
    )
}

/// What a change is of, in a sentence.
fn said(study: &CompareStudy, what: Changed) -> String {
    match what {
        Changed::Parameter(place) => {
            study.tracks.get(place).map_or_else(String::new, |track| format!("the {}", track.words()))
        }
        _ => name(study, what),
    }
}

/// Which earlier flights the vehicle is as again, as a clause; empty where it is as none of them.
pub(super) fn returned(study: &CompareStudy, step: &Step<Compared>) -> String {
    let path = |place: &usize| flight_name(study, *place);
    match step.as_before.as_slice() {
        [] => String::new(),
        [one] => format!("; in this it is again as in {}", path(one)),
        [first, .., last] => format!("; in this it is again as in {} to {}", path(first), path(last)),
    }
}

fn flights(count: usize) -> String {
    format!("{count} flight{}", if count == 1 { "" } else { "s" })
}

/// What one change is, as a clause.
pub(super) fn sentence(study: &CompareStudy, change: &Change) -> String {
    let moved = change.moved.map(|moved| {
        let of = |(value, std)| with_error(value, std);
        (of(moved.before), of(moved.after), of(moved.by))
    });
    let (before, after, by) = moved.unwrap_or_default();
    let unit = spaced(change.unit);
    let told = match change.what {
        Changed::Rotor(_) => {
            format!(
                "{} gives {after} of the thrust that it gave for the same command",
                name(study, change.what)
            )
        }
        Changed::CentreOfMass(_) => {
            format!(
                "{} moved by {by}{unit} (a load or a battery that sits elsewhere does the same)",
                name(study, change.what)
            )
        }
        Changed::Balance => return balance_sentence(study, &change.rivals),
        Changed::YawTorque => format!("{} went from {before} to {after}", name(study, change.what)),
        Changed::Parameter(_) => format!("{} went from {before} to {after}{unit}", said(study, change.what)),
    };
    let rivals: Vec<String> = change.rivals.iter().map(|rival| rival_name(study, *rival)).collect();
    if rivals.is_empty() {
        told
    } else {
        format!("{told}; a change of {} would look the same to these flights", rivals.join(" or of "))
    }
}

/// A balance that moved without a single name, as a clause; `alone`: what would account for it by itself.
fn balance_sentence(study: &CompareStudy, alone: &[What]) -> String {
    let names: Vec<String> = alone.iter().map(|what| rival_name(study, *what)).collect();
    if names.is_empty() {
        return "the balance of the vehicle moved as no single rotor and no centre of mass moves it: more than one thing changed, or the \
                propellers sit otherwise"
            .to_owned();
    }
    format!(
        "the balance of the vehicle moved: {} alone would account for it, and another rotor together with a load or a centre of mass nearly \
         as well",
        names.join(" or ")
    )
}

/// All that is not decided, in a sentence or two; empty where nothing is.
fn all_open(study: &CompareStudy, compared: &Compared) -> String {
    let Some(most) = compared.undecided.iter().map(|(_, why)| why.flights).max() else {
        return String::new();
    };
    let all: Vec<String> = compared.undecided.iter().map(|(change, _)| by_how_much(study, change)).collect();
    format!(
        " Not decided: {}; {NAMED_SIGMAS} make a change. Fly {} on each side to decide.",
        all.join("; "),
        flights(most)
    )
}

/// What is not decided along the flights, in a sentence or two; empty where nothing is.
fn open_along(study: &CompareStudy) -> String {
    let Some(along) = &study.undecided_along else { return String::new() };
    let all: Vec<String> = along.moved.iter().map(|change| by_how_much(study, change)).collect();
    format!(
        " Not decided: from {} on {}; {} make a change at one of the places between {}. More flights on both sides of it decide.",
        flight_name(study, along.from),
        all.join("; "),
        significant(along.least_sigmas, 2),
        flights(study.flights.len())
    )
}

/// By how much something moved, as a clause.
fn by_how_much(study: &CompareStudy, change: &Change) -> String {
    let by = change.moved.map_or_else(String::new, |moved| with_error(moved.by.0, moved.by.1));
    let sigmas = significant(change.sigmas, 2);
    format!(
        "{} moved by {by}{} ({sigmas} standard deviations)",
        said(study, change.what),
        spaced(change.unit)
    )
}

/// A parameter that moved by more than chance and less than is certain, and what decides it, as a sentence.
pub(super) fn open(study: &CompareStudy, (change, why): &(Change, Undecided)) -> String {
    let by = change.moved.map_or_else(String::new, |moved| with_error(moved.by.0, moved.by.1));
    let spread = match change.what {
        Changed::Parameter(place) => study.tracks.get(place).map_or(0.0, |track| track.spread.relative),
        _ => 0.0,
    };
    let because = if why.by_spread {
        format!(
            "most of this error is the spread between flights of one vehicle, {} % of the value",
            significant(100.0 * spread, 2)
        )
    } else {
        "most of this error is that of the flights themselves".to_owned()
    };
    // flights of two vehicles decide nothing
    let is_one = study.compared.as_ref().is_none_or(|compared| compared.other_vehicle.is_none());
    let decide =
        if is_one { format!(" Fly {} on each side to decide.", flights(why.flights)) } else { String::new() };
    format!(
        "{} moved by {by}{}, {} standard deviations: below the {NAMED_SIGMAS} that make a change; {because}.{decide}",
        capital(&said(study, change.what)),
        spaced(change.unit),
        significant(change.sigmas, 2)
    )
}

/// What a change is of.
pub(super) fn name(study: &CompareStudy, what: Changed) -> String {
    match what {
        Changed::Rotor(place) => study.vehicle.motor_words(place),
        Changed::CentreOfMass(axis) => {
            format!("the centre of mass along body {}", if axis == 0 { "x" } else { "y" })
        }
        Changed::YawTorque => "the torque about the vertical".to_owned(),
        Changed::Balance => "the balance".to_owned(),
        Changed::Parameter(place) => {
            study.tracks.get(place).map_or_else(String::new, |track| track.name.clone())
        }
    }
}

pub(super) fn rival_name(study: &CompareStudy, what: What) -> String {
    match what {
        What::Rotor(place) => name(study, Changed::Rotor(place)),
        What::CentreOfMass => "the centre of mass".to_owned(),
        What::YawTorque => name(study, Changed::YawTorque),
    }
}

/// The unit behind a number.
pub(super) fn spaced(unit: &str) -> String {
    if unit == "-" { String::new() } else { format!(" {unit}") }
}

/// What would have shown: the balance in a sentence.
fn unseen(study: &CompareStudy, compared: &Compared) -> String {
    let balance = &compared.balance;
    let [x, y, z] = balance.moved.map(|moved| with_error(moved.by.0, moved.by.1));
    let moved = if balance.by_a_load {
        format!(
            "Its balance differs by {x} of an arm along body x and {y} along y, as a load or a battery that sits elsewhere makes it, which \
             is the flight's own. A rotor that gives less thrust, or a centre of mass that moved, may make it as well: these flights do not tell \
             which, and more flights on each side may. The rotors along the flights have it in their values. "
        )
    } else if balance.moved_without_name() {
        format!(
            "Its balance differs by {x} of an arm along body x, {y} along y and {z} about the vertical: too little to name a rotor. The \
             rotors along the flights have it in their values. "
        )
    } else {
        String::new()
    };
    let least = study.least_named().unwrap_or_default();
    let others = if study.tracks.is_empty() {
        ""
    } else {
        "; the table of the smallest changes says it of all other parameters"
    };
    format!("{moved}{}{others}.", capital(&would_have_shown(&least)))
}

/// What would have shown of the balance, as a clause. Where it moved without a name, no rotor is among it: it would not have had one either.
fn would_have_shown(all: &[LeastChange]) -> String {
    let of_rotor = |least: &&LeastChange| matches!(least.what, Changed::Rotor(_));
    let rotor = all.iter().filter(of_rotor).map(|least| least.size).reduce(f64::max);
    let centre = all.iter().find(|least| matches!(least.what, Changed::CentreOfMass(_)));
    let centre = format!("a centre of mass {} elsewhere", centre.map(size).unwrap_or_default());
    match rotor {
        Some(rotor) => format!(
            "a rotor that gives {} % less thrust would have shown, or {centre}",
            significant(100.0 * rotor, 2)
        ),
        None => format!("{centre} would have shown"),
    }
}

/// What the list of smallest changes is.
pub(super) fn smallest_heading(study: &CompareStudy) -> &'static str {
    if study.groups.is_some() {
        "the smallest change that would have been named"
    } else {
        "the smallest change that would have been named if it stayed from the middle of the flights on"
    }
}

/// The size of a smallest change.
pub(super) fn size(least: &LeastChange) -> String {
    match (least.what, least.unit) {
        (Changed::Rotor(_), _) => format!("{} of its thrust", significant(least.size, 2)),
        (_, "m") => format!("{} mm", significant(1000.0 * least.size, 2)),
        (_, "arm") => format!("{} of an arm", significant(least.size, 2)),
        // a bare number is said to be one
        (_, unit) => format!("{} {unit}", significant(least.size, 2)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_change_that_flights_in_between_do_not_show_is_told_between_two_flights() {
        let flight = |place: usize| format!("flight {}", place + 1);
        assert_eq!(since((Some(1), 2), &flight), "from flight 3 on");
        assert_eq!(since((None, 2), &flight), "from flight 3 on");
        assert_eq!(since((Some(1), 3), &flight), "between flight 2 and flight 4");
    }
}
