//! A summary in Markdown, to paste into a forum or an issue: files by their names alone.

use super::cells::{ByFlight, OWN_HEADS, balance_cells, change_cells, flight_hash, group, own_cells};
use super::flight_name::{flight_name, with_names};
use super::words::{
    FLIGHTS_OWN_ERRORS, OF_MEAN_ROTOR, answer, name, open, since_files, size, smallest_heading,
};
use crate::change::Step;
use crate::report::bare::bare;
use crate::report::markdown::{escaped, quoted, table};
use crate::study::{Change, CompareStudy, Compared};
use crate::text::capital;
use std::fmt::Write;

/// Heads of the tables of changes.
const CHANGE_HEADS: [&str; 7] =
    ["what", "before", "after", "difference", "unit", "standard deviations", "shown alone by"];

/// The summary.
#[must_use]
pub fn comparison_markdown(study: &CompareStudy) -> String {
    let mut page = format!("**{}**\n", escaped(&bare(&answer(study), &[])));
    changed(&mut page, study);
    unseen(&mut page, study);
    flights(&mut page, study);
    let rotors = format!("Thrust of each rotor for a command, {OF_MEAN_ROTOR}");
    along(&mut page, &rotors, ByFlight::rotors(study).as_ref());
    let parameters = format!("Parameters along the flights, with {FLIGHTS_OWN_ERRORS}");
    along(&mut page, &parameters, ByFlight::parameters(study).as_ref());
    let left_out: Vec<&str> = study.left_out.iter().map(|of| of.path.as_str()).collect();
    for note in &study.notes {
        quoted(&mut page, &bare(&with_names(study, &note.sentence()), &left_out));
    }
    // writing to a String cannot fail
    let _ = write!(
        page,
        "\nVehicle: {}. Program: mavid {}, `mavid compare`.\n",
        escaped(&study.vehicle.name),
        env!("CARGO_PKG_VERSION")
    );
    page
}

fn heading(page: &mut String, words: &str) {
    let _ = write!(page, "\n{}:\n", escaped(words));
}

fn row(study: &CompareStudy, change: &Change) -> Vec<String> {
    let [what, unit, before, after, by, sigmas, carried] = change_cells(study, change);
    vec![what, before, after, by, unit, sigmas, carried]
}

/// What changed between the groups and along the flights, and what is not decided.
fn changed(page: &mut String, study: &CompareStudy) {
    if let Some(compared) = &study.compared {
        let rows: Vec<Vec<String>> = compared.changes.iter().map(|change| row(study, change)).collect();
        if !rows.is_empty() {
            heading(page, "What changed, with standard errors and, in brackets, intervals of 95 %");
            table(page, &CHANGE_HEADS, &rows);
        }
        for of in &compared.undecided {
            let _ = write!(page, "\nNot decided: {}\n", escaped(&open(study, of)));
        }
    }
    // between two flights it is the same again
    if study.history.is_empty() || study.compared.is_some() && study.flights.len() < 3 {
        return;
    }
    heading(page, "Along the flights, with standard errors and, in brackets, intervals of 95 %");
    let since = |step: &Step<Compared>, change: &Change| {
        std::iter::once(since_files(study, step, change.what)).chain(row(study, change)).collect()
    };
    let steps = study.history.iter();
    let rows: Vec<Vec<String>> =
        steps.flat_map(|step| step.change.changes.iter().map(move |change| since(step, change))).collect();
    table(page, &[&["since"][..], &CHANGE_HEADS].concat(), &rows);
}

fn unseen(page: &mut String, study: &CompareStudy) {
    let Some(all) = study.least_named() else { return };
    let rows: Vec<Vec<String>> = all.iter().map(|least| vec![name(study, least.what), size(least)]).collect();
    heading(page, &capital(smallest_heading(study)));
    table(page, &["what", "size"], &rows);
}

fn flights(page: &mut String, study: &CompareStudy) {
    let row = |place: usize| {
        let of = [(place + 1).to_string(), flight_name(study, place).to_owned(), flight_hash(study, place)];
        let group = study.groups.as_ref().map(|_| group(study, place).to_owned());
        let numbers = balance_cells(study, place).into_iter().chain(own_cells(study, place));
        of.into_iter().chain(group).chain(numbers).collect()
    };
    let rows: Vec<Vec<String>> = (0..study.flights.len()).map(row).collect();
    let group: &[&str] = if study.groups.is_some() { &["group"] } else { &[] };
    let heads = [&["flight", "log", "SHA-256"][..], group, &["x, arms", "y, arms", "about z"], &OWN_HEADS];
    heading(
        page,
        "The flights: balance in still air as shares of the thrust (where it acts along x and y, torque about z), and what is each \
         flight's own (felt: the air's push over the weight)",
    );
    table(page, &heads.concat(), &rows);
}

fn along(page: &mut String, words: &str, of: Option<&ByFlight>) {
    let Some(of) = of else { return };
    let all = of.table();
    let Some((heads, rows)) = all.split_first() else { return };
    heading(page, words);
    let heads: Vec<String> = heads.iter().map(|head| escaped(head)).collect();
    table(page, &heads.iter().map(String::as_str).collect::<Vec<_>>(), rows);
    for remark in of.remarks() {
        let _ = write!(page, "\n{}\n", escaped(&remark));
    }
}
