//! What the tables of a comparison hold, as words.

use super::flight_name::{flight_name, flight_names};
use super::words::{changed_since, name, value_of};
use crate::change::interval_95;
use crate::diagnose::Owner;
use crate::report::number::{interval, significant, with_error};
use crate::study::{Change, Changed, CompareStudy};

/// Most flights whose values stand side by side, one quantity a row: three do not fit a terminal beside long names. Of more each flight
/// has its row, and each quantity its column.
const SIDE_BY_SIDE: usize = 2;

/// Characters of a hash that tell one log from another.
const HASH_CHARS: usize = 12;

/// A change: what, unit, before, after, difference, standard deviations, and the flights that show it alone.
pub(super) fn change_cells(study: &CompareStudy, change: &Change) -> [String; 7] {
    let of = |(value, std): (f64, f64)| {
        let ends = || format!(" ({})", interval(interval_95((value, std)), std));
        let ends = if std > 0.0 { ends() } else { String::new() };
        format!("{}{ends}", with_error(value, std))
    };
    let none = || ["-"; 3].map(str::to_owned);
    let [before, after, by] =
        change.moved.map_or_else(none, |moved| [of(moved.before), of(moved.after), of(moved.by)]);
    let carried = flight_names(study, &change.carried_by);
    let sigmas = significant(change.sigmas, 2);
    [name(study, change.what), change.unit.to_owned(), before, after, by, sigmas, carried]
}

/// Which of the flights of `--with` a flight is of.
pub(super) fn group(study: &CompareStudy, place: usize) -> &'static str {
    let group = |before: bool| if before { "before" } else { "after" };
    study.groups.as_ref().map_or("", |groups| group(groups.before.contains(&place)))
}

/// The balance of a flight: along x, along y, about z.
pub(super) fn balance_cells(study: &CompareStudy, place: usize) -> [String; 3] {
    [0, 1, 2].map(|axis| {
        let (lean, std) = study.balance.lean(place, axis);
        with_error(lean, std)
    })
}

/// What is a flight's own: full thrust over weight, V, W, and the air's push along x and y.
pub(super) fn own_cells(study: &CompareStudy, place: usize) -> [String; 5] {
    let none = |value: Option<String>| value.unwrap_or_else(|| "-".to_owned());
    let (flight, of) = (&study.flights[place], &study.balance.flights[place]);
    let [x, y] = of.felt;
    [
        none(of.lift.map(|(lift, std)| with_error(lift, std))),
        none(of.voltage_v.map(|volts| format!("{volts:.1}"))),
        none(flight.power_w.map(|power| format!("{power:.0}"))),
        format!("{x:+.3}"),
        format!("{y:+.3}"),
    ]
}

/// Heads of [`own_cells`].
pub(super) const OWN_HEADS: [&str; 5] = ["full thrust over weight", "V", "W", "felt x", "felt y"];

/// A row of flights with values of several quantities.
pub(super) struct ByFlight {
    /// name and unit of each quantity
    pub(super) quantities: Vec<(String, &'static str)>,
    /// its values, one a flight
    pub(super) values: Vec<Vec<String>>,
    /// what is to be said of a quantity beside its values, as a clause
    pub(super) said: Vec<String>,
}

impl ByFlight {
    /// The rotors; `None` where none are told.
    pub(super) fn rotors(study: &CompareStudy) -> Option<Self> {
        let values = |track: &Vec<(f64, f64)>| track.iter().map(|of| with_error(of.0, of.1)).collect();
        let what = || (0..study.rotors.len()).map(Changed::Rotor);
        (!study.rotors.is_empty()).then(|| Self {
            quantities: what().map(|what| (name(study, what), "-")).collect(),
            values: study.rotors.iter().map(values).collect(),
            said: what().map(|what| changed_since(study, what)).collect(),
        })
    }

    /// The parameters; `None` where none are compared.
    pub(super) fn parameters(study: &CompareStudy) -> Option<Self> {
        let said = |place: usize| {
            let own = study.tracks[place].owner == Owner::Flight;
            let own = own.then(|| "the flight's own".to_owned());
            let since = Some(changed_since(study, Changed::Parameter(place)));
            let all: Vec<String> = own.into_iter().chain(since).filter(|said| !said.is_empty()).collect();
            all.join("; ")
        };
        (!study.tracks.is_empty()).then(|| Self {
            quantities: study.tracks.iter().map(|track| (track.name.clone(), track.unit)).collect(),
            values: study
                .tracks
                .iter()
                .map(|track| track.values.iter().map(|value| value_of(track, *value)).collect())
                .collect(),
            said: (0..study.tracks.len()).map(said).collect(),
        })
    }

    /// As a table, heads first: a quantity a row for few flights, and a flight a row for many. The first column says which.
    pub(super) fn table(&self) -> Vec<Vec<String>> {
        let flights = self.values.first().map_or(0, Vec::len);
        let with_unit = |(name, unit): &(String, &str)| match *unit {
            "-" => name.clone(),
            unit => format!("{name} ({unit})"),
        };
        let names: Vec<String> = self.quantities.iter().map(with_unit).collect();
        if flights <= SIDE_BY_SIDE {
            let head = (0..flights).map(|place| format!("flight {}", place + 1));
            let head = std::iter::once(String::new()).chain(head).collect();
            let row = |(name, values): (String, &Vec<String>)| {
                std::iter::once(name).chain(values.iter().cloned()).collect()
            };
            return std::iter::once(head).chain(names.into_iter().zip(&self.values).map(row)).collect();
        }
        let head = std::iter::once("flight".to_owned()).chain(names).collect();
        let row = |place: usize| {
            let values = self.values.iter().map(|values| values[place].clone());
            std::iter::once((place + 1).to_string()).chain(values).collect()
        };
        std::iter::once(head).chain((0..flights).map(row)).collect()
    }

    /// What is to be said beside the values, a line each.
    pub(super) fn remarks(&self) -> impl Iterator<Item = String> {
        let told = self.quantities.iter().zip(&self.said).filter(|(_, said)| !said.is_empty());
        told.map(|((name, _), said)| format!("{name}: {said}"))
    }
}

/// What tells the log of a flight from another one of its name.
pub(super) fn flight_hash(study: &CompareStudy, place: usize) -> String {
    let hash: String = study.flights[place].input.sha256.chars().take(HASH_CHARS).collect();
    format!("{hash}...")
}

/// A flight by its number and its name.
pub(super) fn numbered(study: &CompareStudy, place: usize) -> String {
    format!("{}: {}", place + 1, flight_name(study, place))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn by_flight(flights: usize) -> ByFlight {
        let values = |letter: &str| (1..=flights).map(|flight| format!("{letter}{flight}")).collect();
        ByFlight {
            quantities: vec![("ixx".to_owned(), "kg m^2"), ("motor 1 (front)".to_owned(), "-")],
            values: vec![values("i"), values("m")],
            said: vec![String::new(), "changed from flight 2 on".to_owned()],
        }
    }

    #[test]
    fn few_flights_stand_side_by_side_and_many_below_each_other() {
        assert_eq!(
            by_flight(2).table(),
            [["", "flight 1", "flight 2"], ["ixx (kg m^2)", "i1", "i2"], ["motor 1 (front)", "m1", "m2"]]
        );
        let many = by_flight(16).table();
        assert_eq!(many.len(), 17);
        assert_eq!(many[0], ["flight", "ixx (kg m^2)", "motor 1 (front)"]);
        assert_eq!(many[16], ["16", "i16", "m16"]);
        let remarks: Vec<String> = by_flight(2).remarks().collect();
        assert_eq!(remarks, ["motor 1 (front): changed from flight 2 on"]);
    }
}
