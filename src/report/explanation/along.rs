//! Several flights: what they have in common, what is each one's own, and which of them carry a name.

use crate::diagnose::{Named, NamedParameter, Owner, brief, called};
use crate::report::comparison::value_of;
use crate::report::html::{Cell, name, note, number, section, table, text};
use crate::study::{AlongFlights, ExplainStudy, Track};
use crate::text::capital;
use maud::{Markup, html};
use schemars::JsonSchema;
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt::Write;

/// What the errors of several flights hold, which are not those of a comparison.
const ERRORS_OF_FIT: &str = "standard errors of the fit, without the spread between flights of one vehicle, which `mavid compare` adds";

/// Several flights in JSON.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub(super) struct AlongValue {
    parameters: Vec<TrackValue>,
    /// places of the flights that each show a named effect alone
    carried_by: BTreeMap<&'static str, Option<Vec<usize>>>,
    /// places of the flights that the size of a named effect is of, where it differs between the flights
    sized_by: BTreeMap<&'static str, Vec<usize>>,
    /// what a flight has alone and the flights together have not
    of_one_flight: Vec<OfOneFlight>,
    /// north and west, m/s
    winds_m_s: Vec<Option<[f64; 2]>>,
}

#[derive(Debug, Clone, Serialize, JsonSchema)]
struct TrackValue {
    name: String,
    unit: &'static str,
    owner: &'static str,
    /// null where it is the flights' own, and where they do not determine it
    together: Option<EstimateValue>,
    /// of each flight alone; null where it does not determine it
    values: Vec<Option<EstimateValue>>,
}

/// A name that a flight has alone.
#[derive(Debug, Clone, Serialize, JsonSchema)]
struct OfOneFlight {
    /// place of the flight
    flight: usize,
    /// identifier of the effect
    id: &'static str,
    parameters: BTreeMap<&'static str, EstimateValue>,
}

impl OfOneFlight {
    fn new((flight, named): &(usize, Named)) -> Self {
        let value = |of: &NamedParameter| (of.name, EstimateValue { value: of.value, std: of.std });
        Self { flight: *flight, id: named.id, parameters: named.parameters.iter().map(value).collect() }
    }
}

#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
struct EstimateValue {
    value: f64,
    std: f64,
}

impl AlongValue {
    pub(super) fn new(study: &ExplainStudy, along: &AlongFlights) -> Self {
        let untold = untold(study);
        let estimate = |track: &Track, estimate: Option<(f64, f64)>| {
            let told = estimate.filter(|estimate| track.is_determined(*estimate));
            told.map(|(value, std)| EstimateValue { value, std })
        };
        let track = |track: &Track| TrackValue {
            name: track.name.clone(),
            unit: track.unit,
            owner: whose(track),
            together: estimate(track, told_together(along, track, &untold)),
            values: (0..track.values.len())
                .map(|flight| estimate(track, along.alone(track, flight)))
                .collect(),
        };
        Self {
            parameters: along.tracks.iter().map(track).collect(),
            carried_by: along.carried_by.iter().cloned().collect(),
            sized_by: along.sized_by.iter().cloned().collect(),
            of_one_flight: along.of_one_flight.iter().map(OfOneFlight::new).collect(),
            winds_m_s: along.winds_m_s.clone(),
        }
    }
}

fn whose(track: &Track) -> &'static str {
    if track.owner == Owner::Flight { "flight" } else { "vehicle" }
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
    let _ = writeln!(page, "\n  together, and each flight alone; {ERRORS_OF_FIT}");
    let untold = untold(study);
    for track in &along.tracks {
        let together = together(along, track, &untold);
        let each: Vec<String> =
            (0..track.values.len()).map(|flight| value_of(track, along.alone(track, flight))).collect();
        let _ = writeln!(page, "    {:<22} {together:<22} {}  {}", track.name, each.join(", "), track.unit);
    }
    if along.winds_m_s.iter().any(Option::is_some) {
        let _ =
            writeln!(page, "    wind to north, west (m/s), each flight's own: {}", winds(along).join("; "));
    }
    for (flight, named) in &along.of_one_flight {
        let path = &study.given.inputs[*flight].path;
        let _ = writeln!(page, "    {path} alone: {}", brief(named, study.vehicle(), true));
    }
    for (id, flights) in &along.carried_by {
        let path = |flight: &usize| study.given.inputs[*flight].path.clone();
        let _ = writeln!(page, "    {}", carried(id, flights.as_deref(), "", path));
    }
}

/// Which flights show a name alone.
fn carried(id: &str, flights: Option<&[usize]>, of: &str, name: impl Fn(&usize) -> String) -> String {
    let called = called(id);
    match flights {
        None => format!("{called}: fitted to all flights together only"),
        Some([]) => format!("{called}: shown by no flight alone, only by all of them together"),
        Some(flights) => {
            let names: Vec<String> = flights.iter().map(name).collect();
            format!("{called}: shown alone by {of}{}", names.join(", "))
        }
    }
}

/// The section of the report; nothing of one flight.
pub(super) fn along_section(study: &ExplainStudy) -> Markup {
    let Some(along) = &study.along else { return Markup::default() };
    let mut heads = vec!["parameter".to_owned(), "unit".to_owned(), "together|".to_owned()];
    heads.extend((0..study.given.inputs.len()).map(|flight| format!("flight {}|", flight + 1)));
    let heads: Vec<&str> = heads.iter().map(String::as_str).collect();
    let untold = untold(study);
    let mut rows: Vec<Vec<Cell>> = along.tracks.iter().map(|track| row(along, track, &untold)).collect();
    if along.winds_m_s.iter().any(Option::is_some) {
        let mut wind = vec![text("wind to north, west"), text("m/s"), number("each flight's own")];
        wind.extend(winds(along).into_iter().map(number));
        rows.push(wind);
    }
    let number = |flight: &usize| (flight + 1).to_string();
    let line = |(id, flights): &(&str, Option<Vec<usize>>)| {
        format!("{}.", capital(&carried(id, flights.as_deref(), "flight ", number)))
    };
    let alone = along.of_one_flight.iter().map(|(flight, named)| {
        format!(
            "Flight {} alone: {}. The model does not hold it.",
            flight + 1,
            brief(named, study.vehicle(), true)
        )
    });
    let carried: Vec<String> = along.carried_by.iter().map(line).chain(alone).collect();
    let caption = format!("The vehicle's parameters by all flights and by each alone; {ERRORS_OF_FIT}");
    section(
        "The flights together",
        &html! {
            (table(&caption, &heads, &rows))
            @for line in &carried { (note(line)) }
        },
    )
}

/// Entries of the rigid body that all flights together do not determine.
fn untold(study: &ExplainStudy) -> Vec<&'static str> {
    let body = study.body().into_iter();
    body.filter(|of| of.not_determined.is_some()).map(|of| of.name).collect()
}

/// A parameter by all flights; `None` where the answer does not have it.
fn told_together(along: &AlongFlights, track: &Track, untold: &[&str]) -> Option<(f64, f64)> {
    let is_told = track.effect.is_some() || !untold.contains(&track.name.as_str());
    along.together(track).filter(|_| is_told)
}

/// The same in words.
fn together(along: &AlongFlights, track: &Track, untold: &[&str]) -> String {
    if track.owner == Owner::Flight {
        "each flight's own".to_owned()
    } else {
        value_of(track, told_together(along, track, untold))
    }
}

fn row(along: &AlongFlights, track: &Track, untold: &[&str]) -> Vec<Cell> {
    let mut cells = vec![name(track.name.as_str()), text(track.unit), number(together(along, track, untold))];
    cells.extend((0..track.values.len()).map(|flight| number(value_of(track, along.alone(track, flight)))));
    cells
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flights_carry_a_name_and_not_an_identifier() {
        let said = |flights: Option<&[usize]>| carried("motor_lag", flights, "flight ", |at| at.to_string());
        assert_eq!(said(Some(&[1, 3])), "motor lag: shown alone by flight 1, 3");
        assert_eq!(said(Some(&[])), "motor lag: shown by no flight alone, only by all of them together");
        assert_eq!(said(None), "motor lag: fitted to all flights together only");
    }
}
