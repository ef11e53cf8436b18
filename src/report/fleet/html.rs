//! `report.html` of a fleet: each section is one function, and one call in [`fleet_html`].

use super::words::{alarms, answer, change_sentence, differs, logs};
use crate::diagnose::Owner;
use crate::fleet::{FleetReport, ReportedVehicle};
use crate::report::comparison::{CAPTION, plots};
use crate::report::html::{self, Cell, figure, note, number, paragraph, section, table, text, warning};
use crate::report::number::with_error;
use crate::report::page::page;
use maud::{Markup, html};

/// Vehicles whose histories are drawn although they did not change; the others are in the table.
const MOST_DRAWN: usize = 100;

/// The report: one file, nothing loaded from anywhere.
#[must_use]
pub fn fleet_html(report: &FleetReport) -> String {
    let _stage = tracing::info_span!("report").entered();
    let flights: usize = report.vehicles.iter().map(|vehicle| vehicle.history.study.flights.len()).sum();
    let tags = [format!("{} vehicles", report.vehicles.len()), format!("{flights} flights")];
    let sections = html! {
        (changed(report))
        (differing(report))
        (vehicles(report))
        (unchanged(report))
        (read(report))
        (provenance(report))
    };
    page("mavid fleet", &answer(report), &tags, &sections)
}

fn changed(report: &FleetReport) -> Markup {
    let each = html! {
        @for vehicle in report.changed() {
            (paragraph(&change_sentence(vehicle)))
            @for plot in plots(&vehicle.history.study) { (figure(&plot, CAPTION)) }
            (remarks(vehicle))
        }
        (note(&alarms(report)))
    };
    section("What changed", &each)
}

fn remarks(vehicle: &ReportedVehicle) -> Markup {
    html! {
        @for remark in &vehicle.history.study.notes {
            @if remark.is_warning() { (warning(&remark.sentence())) } @else { (note(&remark.sentence())) }
        }
    }
}

fn differing(report: &FleetReport) -> Markup {
    if report.outliers.is_empty() {
        return Markup::default();
    }
    let each = html! { @for outlier in &report.outliers { (paragraph(&differs(outlier))) } };
    section("Different from the others of their type", &each)
}

/// Every vehicle in a row: its latest values.
fn vehicles(report: &FleetReport) -> Markup {
    let rows: Vec<Vec<Cell>> = report.vehicles.iter().map(row).collect();
    let heads = ["vehicle", "type", "flights|", "changed", "rotors, thrust for a command|", "of the vehicle"];
    let words = "The latest flight: what each rotor gives for its command over the mean rotor, and the parameters of the motion.";
    section("Vehicles", &html! { (note(words)) (table("One vehicle a row", &heads, &rows)) })
}

fn row(vehicle: &ReportedVehicle) -> Vec<Cell> {
    let study = &vehicle.history.study;
    let last = |track: &Vec<(f64, f64)>| track.last().map(|(value, std)| with_error(*value, *std));
    let rotors: Vec<String> = study.rotors.iter().filter_map(last).collect();
    let own = study.tracks.iter().filter(|track| track.owner == Owner::Vehicle);
    let latest = own.filter_map(|track| {
        let (value, std) = track.values.iter().rev().flatten().next()?;
        Some(format!("{} {} {}", track.name, with_error(*value, *std), track.unit))
    });
    vec![
        text(vehicle.history.name.as_str()),
        text(vehicle.history.kind.as_str()),
        number(study.flights.len().to_string()),
        text(if vehicle.has_changed() { "changed" } else { "" }),
        number(rotors.join(", ")),
        text(latest.collect::<Vec<_>>().join("; ")),
    ]
}

fn unchanged(report: &FleetReport) -> Markup {
    let shown = report
        .vehicles
        .iter()
        .filter(|vehicle| !vehicle.has_changed() && vehicle.history.study.flights.len() > 1);
    let each = html! {
        @for vehicle in shown.take(MOST_DRAWN) {
            details {
                summary { (vehicle.history.name) }
                @for plot in plots(&vehicle.history.study) { (figure(&plot, "Bands: 95 % intervals.")) }
                (remarks(vehicle))
            }
        }
    };
    section("Histories of the others", &each)
}

fn read(report: &FleetReport) -> Markup {
    let rows: Vec<Vec<Cell>> =
        report.errors.iter().map(|(uri, why)| vec![text(uri.as_str()), text(why.as_str())]).collect();
    let content = html! {
        (paragraph(&logs(report)))
        (table("Logs that could not be read", &["log", "why"], &rows))
        @if !report.without_history.is_empty() {
            (note(&format!("Without a flight that shows a balance: {}", report.without_history.join(", "))))
        }
    };
    section("Logs", &content)
}

fn provenance(report: &FleetReport) -> Markup {
    let alarms = &report.alarms;
    let settings = [
        ("most false alarms", alarms.allowed.to_string()),
        ("shuffled histories", alarms.shuffled.to_string()),
        ("standard deviations that a change needs", alarms.least_sigmas.to_string()),
    ];
    html::provenance(&[], &settings)
}
