//! `report.html` of `compare`: each section is one function, and one call in [`comparison_html`].

use super::cells::{OWN_HEADS, balance_cells, change_cells, group, numbered, own_cells};
use super::drawing::{caption, drawing};
use super::flight_name::with_names;
use super::plots::{CAPTION, plots};
use super::words::{
    FLIGHTS_OWN_ERRORS, OF_MEAN_ROTOR, answer, changed_since, name, open, returned, sentence, since_files,
    size, smallest_heading, value_of,
};
use crate::change::Step;
use crate::diagnose::Owner;
use crate::report::html::{self, Cell, figure, note, number, paragraph, section, table, text, warning};
use crate::report::number::with_error;
use crate::report::page::page;
use crate::study::{Change, Changed, CompareStudy, Compared};
use crate::text::capital;
use maud::{Markup, html};

/// The report: one file, nothing loaded from anywhere.
#[must_use]
pub fn comparison_html(study: &CompareStudy) -> String {
    let _stage = tracing::info_span!("report").entered();
    let tags = [
        study.vehicle.name.clone(),
        format!("{} flights", study.flights.len()),
        if study.has_changed() { "changed" } else { "nothing changed" }.to_owned(),
    ];
    let sections = html! {
        (vehicle(study))
        (changed(study))
        (unseen(study))
        (flights(study))
        (rotors(study))
        (tracks(study))
        (history(study))
        (remarks(study))
        (provenance(study))
    };
    page("mavid compare", &answer(study), &tags, &sections)
}

fn vehicle(study: &CompareStudy) -> Markup {
    section("The vehicle", &figure(&drawing(study), &caption(study)))
}

fn changed(study: &CompareStudy) -> Markup {
    let Some(compared) = &study.compared else { return Markup::default() };
    let rows: Vec<Vec<Cell>> = compared.changes.iter().map(|change| row(study, change)).collect();
    let undecided: Vec<Vec<Cell>> = compared.undecided.iter().map(|(change, _)| row(study, change)).collect();
    let heads = ["", "unit", "before", "after", "difference", "standard deviations|", "shown alone by"];
    let caption = "Before and after, with standard errors and, in brackets, intervals of 95 %";
    html! {
        @if !rows.is_empty() { (section("What changed", &table(caption, &heads, &rows))) }
        @if !undecided.is_empty() {
            (section("Not decided", &html! {
                (table(caption, &heads, &undecided))
                @for of in &compared.undecided { (note(&open(study, of))) }
            }))
        }
    }
}

/// What changed as words, so that they are broken where there is no room.
fn row(study: &CompareStudy, change: &Change) -> Vec<Cell> {
    let [what, unit, before, after, by, sigmas, carried] = change_cells(study, change);
    let words = [what, unit, before, after, by].map(text);
    words.into_iter().chain([number(sigmas), text(carried)]).collect()
}

fn row_since(study: &CompareStudy, step: &Step<Compared>, change: &Change) -> Vec<Cell> {
    let since = text(since_files(study, step, change.what));
    std::iter::once(since).chain(row(study, change)).collect()
}

fn unseen(study: &CompareStudy) -> Markup {
    let Some(all) = study.least_named() else { return Markup::default() };
    let rows: Vec<Vec<Cell>> =
        all.iter().map(|least| vec![text(name(study, least.what)), number(size(least))]).collect();
    section("What would have shown", &table(&capital(smallest_heading(study)), &["", "size|"], &rows))
}

fn flights(study: &CompareStudy) -> Markup {
    let row = |place: usize| {
        let names = [text(numbered(study, place)), text(group(study, place))];
        let numbers = balance_cells(study, place).into_iter().chain(own_cells(study, place));
        names.into_iter().chain(numbers.map(number)).collect()
    };
    let heads = ["flight", "", "x, arms|", "y, arms|", "about z|"].map(str::to_owned);
    let heads: Vec<String> = heads.into_iter().chain(OWN_HEADS.map(|head| format!("{head}|"))).collect();
    let words = "The balance in still air: where the commanded thrust acts, and what turns about the vertical, as shares of the thrust. \
                 Full thrust over weight, voltage, power and what is felt of the air (its push over the weight) are the flight's own: \
                 battery, load and air are no change of the vehicle. Whole paths stand under Provenance.";
    let rows: Vec<Vec<Cell>> = (0..study.flights.len()).map(row).collect();
    section("Flights", &html! { (note(words)) (table_along("One flight a row", &heads, &rows)) })
}

/// Heads of a table along the flights: those given, one a flight, and where it changed.
fn heads_along(study: &CompareStudy, first: &[&str]) -> Vec<String> {
    let each = (0..study.flights.len()).map(|place| format!("flight {}|", place + 1));
    first.iter().map(|head| (*head).to_owned()).chain(each).chain([String::new()]).collect()
}

fn table_along(caption: &str, heads: &[String], rows: &[Vec<Cell>]) -> Markup {
    table(caption, &heads.iter().map(String::as_str).collect::<Vec<_>>(), rows)
}

fn rotors(study: &CompareStudy) -> Markup {
    if study.rotors.is_empty() {
        return Markup::default();
    }
    let rows: Vec<Vec<Cell>> = study
        .rotors
        .iter()
        .enumerate()
        .map(|(place, track)| {
            let what = Changed::Rotor(place);
            let mut cells = vec![text(name(study, what))];
            cells.extend(track.iter().map(|(value, std)| number(with_error(*value, *std))));
            cells.push(text(changed_since(study, what)));
            cells
        })
        .collect();
    let caption = format!("Thrust of each rotor for a command, {OF_MEAN_ROTOR}");
    section("Rotors along the flights", &table_along(&caption, &heads_along(study, &["rotor"]), &rows))
}

fn tracks(study: &CompareStudy) -> Markup {
    if study.tracks.is_empty() {
        return Markup::default();
    }
    let rows = study.tracks.iter().enumerate().map(|(place, track)| {
        let own = if track.owner == Owner::Flight { "the flight's own" } else { "the vehicle's" };
        let mut cells = vec![text(track.name.as_str()), text(track.unit), text(own)];
        cells.extend(track.values.iter().map(|value| number(value_of(track, *value))));
        cells.push(text(changed_since(study, Changed::Parameter(place))));
        cells
    });
    let caption = format!("With {FLIGHTS_OWN_ERRORS}");
    let heads = heads_along(study, &["parameter", "unit", "whose"]);
    section("Parameters along the flights", &table_along(&caption, &heads, &rows.collect::<Vec<_>>()))
}

fn history(study: &CompareStudy) -> Markup {
    if study.flights.len() < 3 {
        return Markup::default();
    }
    let changes: Vec<Vec<Cell>> = study
        .history
        .iter()
        .flat_map(|step| step.change.changes.iter().map(|change| row_since(study, step, change)))
        .collect();
    let heads =
        ["since", "", "unit", "before", "after", "difference", "standard deviations|", "shown alone by"];
    let caption = "Before and after each place, with standard errors and, in brackets, intervals of 95 %";
    let steps = html! {
        @if study.history.is_empty() { (paragraph("Nothing changed along the flights that they could show.")) }
        @for step in &study.history { @for change in &step.change.changes {
            (paragraph(&format!(
                "{}: {}{}.",
                capital(&since_files(study, step, change.what)),
                sentence(study, change),
                returned(study, step)
            )))
        } }
        @if !changes.is_empty() { (table(caption, &heads, &changes)) }
        @for plot in plots(study) { (figure(&plot, CAPTION)) }
    };
    section("History", &steps)
}

fn remarks(study: &CompareStudy) -> Markup {
    html! {
        @for remark in &study.notes {
            @let said = with_names(study, &remark.sentence());
            @if remark.is_warning() { (warning(&said)) } @else { (note(&said)) }
        }
    }
}

fn provenance(study: &CompareStudy) -> Markup {
    let vehicle = study.vehicle_file.iter().map(|file| ("vehicle", file));
    let files: Vec<_> =
        vehicle.chain(study.flights.iter().map(|flight| ("compared", &flight.input))).collect();
    html::provenance(&files, &[])
}
