//! Several flights: what they have in common, what is each one's own, and which of them carry a name.

use crate::diagnose::Owner;
use crate::report::html::{Cell, note, number, section, table, text};
use crate::report::number::with_error;
use crate::study::{AlongFlights, ExplainStudy, Track};
use maud::{Markup, html};
use schemars::JsonSchema;
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt::Write;

/// Several flights in JSON.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub(super) struct AlongValue {
    parameters: Vec<TrackValue>,
    /// places of the flights that each show a named effect alone
    carried_by: BTreeMap<&'static str, Option<Vec<usize>>>,
    /// north and west, m/s
    winds_m_s: Vec<Option<[f64; 2]>>,
}

#[derive(Debug, Clone, Serialize, JsonSchema)]
struct TrackValue {
    name: String,
    unit: &'static str,
    owner: &'static str,
    together: Option<EstimateValue>,
    values: Vec<Option<EstimateValue>>,
}

#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
struct EstimateValue {
    value: f64,
    std: f64,
}

impl AlongValue {
    pub(super) fn new(along: &AlongFlights) -> Self {
        let estimate = |(value, std)| EstimateValue { value, std };
        let track = |track: &Track| TrackValue {
            name: track.name.clone(),
            unit: track.unit,
            owner: whose(track),
            together: track.pooled().filter(|_| track.owner == Owner::Vehicle).map(estimate),
            values: (0..track.values.len()).map(|flight| track.alone(flight).map(estimate)).collect(),
        };
        Self {
            parameters: along.tracks.iter().map(track).collect(),
            carried_by: along.carried_by.iter().cloned().collect(),
            winds_m_s: along.winds_m_s.clone(),
        }
    }
}

fn whose(track: &Track) -> &'static str {
    if track.owner == Owner::Flight { "flight" } else { "vehicle" }
}

fn said(estimate: Option<(f64, f64)>) -> String {
    estimate.map_or_else(|| "-".to_owned(), |(value, std)| with_error(value, std))
}

fn winds(along: &AlongFlights) -> Vec<String> {
    along
        .winds_m_s
        .iter()
        .map(|wind| wind.map_or_else(|| "-".to_owned(), |[north, west]| format!("{north:+.1}, {west:+.1}")))
        .collect()
}

/// The lines for the terminal; none of one flight.
pub(super) fn along_lines(page: &mut String, study: &ExplainStudy) {
    let Some(along) = &study.along else { return };
    page.push_str("\n  together, and each flight alone\n");
    for track in &along.tracks {
        let together =
            if track.owner == Owner::Flight { "each flight's own".to_owned() } else { said(track.pooled()) };
        let each: Vec<String> = (0..track.values.len()).map(|flight| said(track.alone(flight))).collect();
        let _ = writeln!(page, "    {:<22} {together:<22} {}  {}", track.name, each.join(", "), track.unit);
    }
    if along.winds_m_s.iter().any(Option::is_some) {
        let _ =
            writeln!(page, "    wind to north, west (m/s), each flight's own: {}", winds(along).join("; "));
    }
    for (id, flights) in &along.carried_by {
        let path = |flight: &usize| study.given.inputs[*flight].path.clone();
        let _ = writeln!(page, "    {}", carried(id, flights.as_deref(), "", path));
    }
}

/// Which flights show a name alone.
fn carried(id: &str, flights: Option<&[usize]>, of: &str, name: impl Fn(&usize) -> String) -> String {
    match flights {
        None => format!("{id} is fitted to all flights together only"),
        Some([]) => format!("{id} is shown by no flight alone: only by all of them together"),
        Some(flights) => {
            let names: Vec<String> = flights.iter().map(name).collect();
            format!("{id} is shown alone by {of}{}", names.join(", "))
        }
    }
}

/// The section of the report; nothing of one flight.
pub(super) fn along_section(study: &ExplainStudy) -> Markup {
    let Some(along) = &study.along else { return Markup::default() };
    let mut heads = vec!["parameter".to_owned(), "unit".to_owned(), "together|".to_owned()];
    heads.extend((0..study.given.inputs.len()).map(|flight| format!("flight {}|", flight + 1)));
    let heads: Vec<&str> = heads.iter().map(String::as_str).collect();
    let mut rows: Vec<Vec<Cell>> = along.tracks.iter().map(row).collect();
    if along.winds_m_s.iter().any(Option::is_some) {
        let mut wind = vec![text("wind to north, west"), text("m/s"), number("each flight's own")];
        wind.extend(winds(along).into_iter().map(number));
        rows.push(wind);
    }
    let number = |flight: &usize| (flight + 1).to_string();
    let line = |(id, flights): &(&str, Option<Vec<usize>>)| {
        format!("{}.", carried(id, flights.as_deref(), "flight ", number))
    };
    let carried: Vec<String> = along.carried_by.iter().map(line).collect();
    section(
        "The flights together",
        &html! {
            (table("The vehicle's parameters by all flights and by each alone, with standard errors", &heads, &rows))
            @for line in &carried { (note(line)) }
        },
    )
}

fn row(track: &Track) -> Vec<Cell> {
    let together =
        if track.owner == Owner::Flight { "each flight's own".to_owned() } else { said(track.pooled()) };
    let mut cells = vec![text(track.name.as_str()), text(track.unit), number(together)];
    cells.extend((0..track.values.len()).map(|flight| number(said(track.alone(flight)))));
    cells
}
