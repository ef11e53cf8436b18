//! The page of `compare` for the terminal.

use super::cells::{ByFlight, OWN_HEADS, balance_cells, group, own_cells};
use super::columns::columns;
use super::flight_name::{flight_names, with_names};
use super::words::{
    FLIGHTS_OWN_ERRORS, OF_MEAN_ROTOR, answer, name, open, returned, sentence, since_files, size,
    smallest_heading, spaced,
};
use crate::report::number::{significant, with_error};
use crate::study::{Change, CompareStudy, Compared};
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
    let warnings = study.notes.iter().filter(|note| note.is_warning());
    let warnings: Vec<String> =
        warnings.map(|note| format!("\n  {}", with_names(study, &note.to_string()))).collect();
    if !warnings.is_empty() {
        let _ = write!(page, "{}", warnings.concat());
    }
    page.trim_end().to_owned()
}

fn changes(page: &mut String, study: &CompareStudy, compared: &Compared) {
    if !compared.changes.is_empty() {
        page.push_str("\n  changed\n");
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
    let _ = writeln!(page, "    {}", name(study, change.what));
    let against = match change.moved {
        Some(moved) => {
            let unit = spaced(change.unit);
            let _ =
                writeln!(page, "      before {}{unit}, after {}{unit}", of(moved.before), of(moved.after));
            let _ = write!(page, "      difference {}{unit}, ", of(moved.by));
            ""
        }
        // three components moved, of which none is told alone
        None => {
            page.push_str("      ");
            " of what unchanged flights would show"
        }
    };
    let _ = writeln!(page, "{} standard deviations{against}", significant(change.sigmas, 2));
    let say = flight_names(study, &change.carried_by);
    let _ = writeln!(page, "      shown alone by: {}", if say.is_empty() { "none" } else { &say });
}

/// The flights by their numbers, with whole paths, and what each shows of itself.
fn flights(page: &mut String, study: &CompareStudy) {
    page.push_str("\n  flights\n");
    for (place, flight) in study.flights.iter().enumerate() {
        let group = group(study, place);
        let group = if group.is_empty() { String::new() } else { format!("{group:<6}  ") };
        let _ = writeln!(page, "    {:>3}  {group}{}", place + 1, flight.input.path);
    }
    for (place, flight) in study.flights.iter().enumerate() {
        if let Some(why) = flight.balance_only.as_ref().filter(|_| study.is_known) {
            let _ = writeln!(page, "    flight {}: its balance alone was compared: {why}", place + 1);
        }
    }
    page.push_str(
        "\n  balance in still air, share of the thrust: where it acts along x and y (arms), torque about z\n",
    );
    each_flight(page, study, &["x", "y", "about z"], |place| balance_cells(study, place).to_vec());
    page.push_str(
        "\n  each flight's own: full thrust over weight, voltage and power, and what is felt of the air: its push over the weight\n",
    );
    each_flight(page, study, &OWN_HEADS, |place| own_cells(study, place).to_vec());
}

/// A table with one flight a row.
fn each_flight(
    page: &mut String,
    study: &CompareStudy,
    heads: &[&str],
    cells: impl Fn(usize) -> Vec<String>,
) {
    let head = std::iter::once("flight").chain(heads.iter().copied()).map(str::to_owned).collect();
    let row = |place: usize| std::iter::once((place + 1).to_string()).chain(cells(place)).collect();
    let table: Vec<Vec<String>> = std::iter::once(head).chain((0..study.flights.len()).map(row)).collect();
    columns(page, &table);
}

fn along(page: &mut String, heading: &str, of: Option<&ByFlight>) {
    let Some(of) = of else { return };
    let _ = writeln!(page, "\n  {heading}");
    columns(page, &of.table());
    for remark in of.remarks() {
        let _ = writeln!(page, "    {remark}");
    }
}

fn rotors(page: &mut String, study: &CompareStudy) {
    let heading = format!("thrust of each rotor for a command along the flights, {OF_MEAN_ROTOR}");
    along(page, &heading, ByFlight::rotors(study).as_ref());
}

fn tracks(page: &mut String, study: &CompareStudy) {
    let heading = format!("parameters along the flights; {FLIGHTS_OWN_ERRORS}");
    along(page, &heading, ByFlight::parameters(study).as_ref());
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
