//! The page of `compare` for the terminal.

use super::words::{
    FLIGHTS_OWN_ERRORS, OF_MEAN_ROTOR, answer, changed_since, name, open, returned, sentence, since_files,
    size, smallest_heading, spaced, value_of,
};
use crate::diagnose::Owner;
use crate::report::number::{significant, with_error};
use crate::study::{Change, Changed, CompareStudy, Compared};
use std::fmt::Write;

/// The page for the terminal.
#[must_use]
pub fn comparison_text(study: &CompareStudy) -> String {
    let mut page = format!("{}\n", answer(study));
    if let Some(compared) = &study.compared {
        changes(&mut page, study, compared);
    }
    smallest(&mut page, study);
    flights(&mut page, study);
    rotors(&mut page, study);
    tracks(&mut page, study);
    history(&mut page, study);
    let warnings: Vec<String> =
        study.notes.iter().filter(|note| note.is_warning()).map(|note| format!("\n  {note}")).collect();
    if !warnings.is_empty() {
        let _ = write!(page, "{}", warnings.concat());
    }
    page.trim_end().to_owned()
}

fn changes(page: &mut String, study: &CompareStudy, compared: &Compared) {
    if !compared.changes.is_empty() {
        page.push_str(
            "\n  changed                             before              after               difference\n",
        );
    }
    for change in &compared.changes {
        change_line(page, study, change);
    }
    if !compared.undecided.is_empty() {
        page.push_str("\n  not decided\n");
        for of in &compared.undecided {
            let _ = writeln!(page, "    {}", open(study, of));
        }
    }
}

fn smallest(page: &mut String, study: &CompareStudy) {
    let Some(all) = study.least_named() else { return };
    let _ = writeln!(page, "\n  {}", smallest_heading(study));
    for least in &all {
        let _ = writeln!(page, "    {:<32}  {}", name(study, least.what), size(least));
    }
}

fn change_line(page: &mut String, study: &CompareStudy, change: &Change) {
    let of = |(value, std)| with_error(value, std);
    let [before, after, by] = match change.moved {
        Some(moved) => {
            [of(moved.before), of(moved.after), format!("{}{}, ", of(moved.by), spaced(change.unit))]
        }
        // three components moved, of which none is told alone
        None => ["-".to_owned(), "-".to_owned(), String::new()],
    };
    let against = if change.moved.is_none() { " of what unchanged flights would show" } else { "" };
    let _ = writeln!(
        page,
        "    {:<32}  {before:<18}  {after:<18}  {by}{} standard deviations{against}",
        name(study, change.what),
        significant(change.sigmas, 2)
    );
    let say: Vec<&str> =
        change.carried_by.iter().map(|&flight| study.flights[flight].input.path.as_str()).collect();
    let _ = writeln!(
        page,
        "      shown alone by: {}",
        if say.is_empty() { "none".to_owned() } else { say.join(", ") }
    );
}

fn flights(page: &mut String, study: &CompareStudy) {
    page.push_str(
        "\n  balance in still air, share of the thrust: where it acts along x and y (arms), torque about z; felt: the air's push over the weight\n",
    );
    for (place, (flight, of)) in study.flights.iter().zip(&study.balance.flights).enumerate() {
        let part = |axis: usize| {
            let (lean, std) = study.balance.lean(place, axis);
            with_error(lean, std)
        };
        let lift = of.lift.map_or_else(|| "-".to_owned(), |(lift, std)| with_error(lift, std));
        let volts = of.voltage_v.map_or_else(|| "-".to_owned(), |volts| format!("{volts:.1} V"));
        let power = flight.power_w.map_or_else(|| "-".to_owned(), |power| format!("{power:.0} W"));
        let _ = writeln!(
            page,
            "    {:<28} x {:<17} y {:<17} z {:<17} felt {:+.3} {:+.3}; the flight's own: full thrust over weight {lift}, {volts}, {power}",
            flight.input.path,
            part(0),
            part(1),
            part(2),
            of.felt[0],
            of.felt[1],
        );
    }
    for flight in &study.flights {
        if let Some(why) = flight.balance_only.as_ref().filter(|_| study.is_known) {
            let _ = writeln!(page, "    {}: its balance alone was compared: {why}", flight.input.path);
        }
    }
}

/// What a track says in words behind its values.
fn told(study: &CompareStudy, what: Changed) -> String {
    let since = changed_since(study, what);
    if since.is_empty() { since } else { format!("; {since}") }
}

fn rotors(page: &mut String, study: &CompareStudy) {
    if study.rotors.is_empty() {
        return;
    }
    let _ = writeln!(page, "\n  thrust of each rotor for a command along the flights, {OF_MEAN_ROTOR}");
    for (place, track) in study.rotors.iter().enumerate() {
        let values: Vec<String> = track.iter().map(|(value, std)| with_error(*value, *std)).collect();
        let what = Changed::Rotor(place);
        let _ = writeln!(page, "    {:<24} {}{}", name(study, what), values.join(", "), told(study, what));
    }
}

fn tracks(page: &mut String, study: &CompareStudy) {
    if study.tracks.is_empty() {
        return;
    }
    let _ = writeln!(page, "\n  parameters along the flights, in their order; {FLIGHTS_OWN_ERRORS}");
    for (place, track) in study.tracks.iter().enumerate() {
        let values = track.values.iter().map(|value| value_of(track, *value));
        let own = if track.owner == Owner::Flight { " (the flight's own)" } else { "" };
        let _ = writeln!(
            page,
            "    {:<24} {}{}{own}{}",
            track.name,
            values.collect::<Vec<_>>().join(", "),
            spaced(track.unit),
            told(study, Changed::Parameter(place))
        );
    }
}

fn history(page: &mut String, study: &CompareStudy) {
    if study.flights.len() < 3 {
        return;
    }
    page.push_str("\n  along the flights\n");
    if study.history.is_empty() {
        page.push_str("    nothing changed that they could show\n");
    }
    for step in &study.history {
        for change in &step.change.changes {
            let _ = writeln!(
                page,
                "    {}: {}{}",
                since_files(study, step, change.what),
                sentence(study, change),
                returned(study, step)
            );
        }
    }
}
