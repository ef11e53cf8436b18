//! The flights of each vehicle in their order, as `compare` knows them.

use std::collections::BTreeMap;

use super::rows::{FlightRow, LegRow, LogRows, ParameterRow};
use crate::config::parse_vehicle;
use crate::diagnose::Owner;
use crate::note::{About, Note};
use crate::study::{CompareStudy, ComparedFlight, InputFile, Track};
use crate::trim::{Leg, balance, rotor_tracks};
use crate::vehicle::Vehicle;

/// Flights of a vehicle that its history has at most, the latest: time grows with the square of their number. It
/// bounds the time.
pub const MOST_FLIGHTS: usize = 200;

/// A vehicle along its flights.
#[derive(Debug)]
pub struct VehicleHistory {
    /// name
    pub name: String,
    /// vehicles of one type are compared
    pub kind: String,
    /// its flights, their balance and parameters; the changes are found with [`crate::study::Judge`]
    pub study: CompareStudy,
    /// beginnings of the flights, microseconds since 1970 UTC, where all logs have one
    pub start_utc_us: Option<Vec<i64>>,
    /// flights of it that show no balance
    pub left_out: usize,
}

/// A flight's name: its log and its place in it.
type Key<'a> = (&'a str, i64);

/// The vehicles of the rows, by name, each with at least one flight that shows a balance; and the names of those without one.
#[must_use]
pub fn histories(rows: &LogRows) -> (Vec<VehicleHistory>, Vec<String>) {
    let mut by_vehicle: BTreeMap<&str, Vec<&FlightRow>> = BTreeMap::new();
    rows.flights.iter().for_each(|flight| by_vehicle.entry(&flight.vehicle).or_default().push(flight));
    let mut legs: BTreeMap<Key<'_>, Vec<&LegRow>> = BTreeMap::new();
    rows.legs.iter().for_each(|leg| legs.entry((&leg.log, leg.flight)).or_default().push(leg));
    let mut parameters: BTreeMap<Key<'_>, Vec<&ParameterRow>> = BTreeMap::new();
    rows.parameters.iter().for_each(|row| parameters.entry((&row.log, row.flight)).or_default().push(row));
    let uris: BTreeMap<&str, &str> =
        rows.logs.iter().map(|log| (log.log.as_str(), log.uri.as_str())).collect();
    let described: BTreeMap<&str, (&str, bool)> = rows
        .provenance
        .iter()
        .filter_map(|row| Some((row.log.as_str(), (row.vehicle_toml.as_deref()?, row.vehicle_given))))
        .collect();
    let all = All { legs, parameters, uris, described };
    let (mut found, mut without) = (Vec::new(), Vec::new());
    for (name, flights) in by_vehicle {
        match all.history(name, flights) {
            Some(history) => found.push(history),
            None => without.push(name.to_owned()),
        }
    }
    (found, without)
}

/// All rows by what they are looked up by.
struct All<'a> {
    legs: BTreeMap<Key<'a>, Vec<&'a LegRow>>,
    parameters: BTreeMap<Key<'a>, Vec<&'a ParameterRow>>,
    uris: BTreeMap<&'a str, &'a str>,
    /// the vehicle's description of a log, and whether it was given
    described: BTreeMap<&'a str, (&'a str, bool)>,
}

impl All<'_> {
    fn history(&self, name: &str, mut flights: Vec<&FlightRow>) -> Option<VehicleHistory> {
        let of_vehicle = flights.len();
        let uri = |flight: &FlightRow| self.uris.get(flight.log.as_str()).copied().unwrap_or("");
        // by the clock where all logs have one; by their names otherwise
        let is_dated = flights.iter().all(|flight| flight.start_utc_us.is_some());
        let start = |flight: &FlightRow| flight.start_utc_us.filter(|_| is_dated);
        flights.sort_by(|a, b| (start(a), uri(a), a.flight).cmp(&(start(b), uri(b), b.flight)));
        let shown = |flight: &&FlightRow| self.legs.contains_key(&(flight.log.as_str(), flight.flight));
        flights.retain(shown);
        // the latest description has the rotors that all flights are looked at by
        let (vehicle, is_known) = flights.iter().rev().find_map(|flight| {
            let (text, given) = self.described.get(flight.log.as_str())?;
            Some((parse_vehicle(text, name).ok()?.vehicle, *given))
        })?;
        let (places, legs) = self.legs_of(&flights, &vehicle);
        let from = places.len().saturating_sub(MOST_FLIGHTS);
        let (places, legs) = (&places[from..], &legs[from..]);
        if places.is_empty() {
            return None;
        }
        let kept: Vec<&FlightRow> = places.iter().map(|place| flights[*place]).collect();
        let dates: Option<Vec<i64>> = kept.iter().map(|flight| start(flight)).collect();
        let left_out = of_vehicle - kept.len();
        let mut notes = Vec::new();
        if dates.is_none() {
            let text = "not every log says when it began: the flights are in the order of their names";
            notes.push(Note::warning(About::Vehicle, text));
        }
        if from > 0 {
            notes.push(Note::remark(
                About::Vehicle,
                format!("of its flights the latest {MOST_FLIGHTS} are shown"),
            ));
        }
        let balance = balance(legs);
        let study = CompareStudy {
            is_known,
            vehicle_file: None,
            flights: kept.iter().map(|flight| self.flight(flight, uri(flight))).collect(),
            rotors: rotor_tracks(&balance, &vehicle),
            balance,
            tracks: self.tracks(&kept),
            alone: Vec::new(),
            groups: None,
            compared: None,
            history: Vec::new(),
            least_in_the_middle: None,
            undecided_along: None,
            lifts_apart: None,
            serials_apart: None,
            scale: None,
            balance_unnamed: false,
            left_out: Vec::new(),
            notes,
            vehicle,
        };
        let kind = kept.last().map(|flight| flight.vehicle_type.clone()).unwrap_or_default();
        Some(VehicleHistory { name: name.to_owned(), kind, study, start_utc_us: dates, left_out })
    }

    /// Places of the flights whose legs have as many rotors as the vehicle, and these legs.
    fn legs_of(&self, flights: &[&FlightRow], vehicle: &Vehicle) -> (Vec<usize>, Vec<Vec<Leg>>) {
        let of = |flight: &FlightRow| -> Option<Vec<Leg>> {
            let rows = self.legs.get(&(flight.log.as_str(), flight.flight))?;
            let mut legs: Vec<Leg> = rows.iter().map(|row| leg(row)).collect::<Option<_>>()?;
            legs.sort_by(|a, b| a.time_s.total_cmp(&b.time_s));
            legs.iter().all(|leg| leg.shares.len() == vehicle.rotors.len()).then_some(legs)
        };
        flights.iter().enumerate().filter_map(|(place, flight)| Some((place, of(flight)?))).unzip()
    }

    fn flight(&self, flight: &FlightRow, uri: &str) -> ComparedFlight {
        let own = self.parameters.get(&(flight.log.as_str(), flight.flight));
        let power = own.and_then(|rows| rows.iter().find(|row| row.name == "power"));
        let path =
            if flight.flight > 0 { format!("{uri}, flight {}", flight.flight + 1) } else { uri.to_owned() };
        ComparedFlight {
            input: InputFile { path, sha256: flight.log.clone(), other_logs: Vec::new(), notes: Vec::new() },
            power_w: power.map(|row| row.value),
            balance_only: flight.motion_error.clone(),
        }
    }

    /// Each parameter that has an error along the flights.
    fn tracks(&self, flights: &[&FlightRow]) -> Vec<Track> {
        let mut by_name: BTreeMap<&str, Vec<(usize, &ParameterRow)>> = BTreeMap::new();
        for (place, flight) in flights.iter().enumerate() {
            for row in self.parameters.get(&(flight.log.as_str(), flight.flight)).into_iter().flatten() {
                if row.std.is_some() {
                    by_name.entry(&row.name).or_default().push((place, row));
                }
            }
        }
        let track = |(name, rows): (&str, Vec<(usize, &ParameterRow)>)| {
            let mut values = vec![None; flights.len()];
            let mut common = vec![0.0; flights.len()];
            for (place, row) in &rows {
                values[*place] = row.std.map(|std| (row.value, std));
                common[*place] = row.common_std;
            }
            let (_, first) = rows.first()?;
            let owner = if first.owner == "flight" { Owner::Flight } else { Owner::Vehicle };
            Track::stored((name, &first.unit), (owner, first.effect.as_deref()), values, common)
        };
        by_name.into_iter().filter_map(track).collect()
    }
}

fn leg(row: &LegRow) -> Option<Leg> {
    Some(Leg {
        time_s: row.time_s,
        lean: row.lean.as_slice().try_into().ok()?,
        felt: row.felt.as_slice().try_into().ok()?,
        turning: row.turning.as_slice().try_into().ok()?,
        rate: row.rate.as_slice().try_into().ok()?,
        shares: row.shares.clone(),
        lift: row.lift,
        voltage_v: row.voltage_v,
    })
}
