//! The JSON document of `compare`.

use super::words::{answer, rival_name, sentence};
use crate::change::Moved;
use crate::diagnose::Owner;
use crate::note::Note;
use crate::study::{Change, Changed, CompareStudy, InputFile, LeastChange, Track};
use serde::Serialize;

/// The JSON document of `compare`.
#[derive(Debug, Clone, Serialize)]
pub struct ComparisonDocument {
    schema: u32,
    verdict: &'static str,
    answer: String,
    /// mass and lengths are known; otherwise lengths are in arms
    known_vehicle: bool,
    /// between the flights before and after; none where no groups were given
    changes: Option<Vec<ChangeEntry>>,
    smallest_changes: Option<Vec<LeastEntry>>,
    flights: Vec<FlightEntry>,
    parameters: Vec<TrackEntry>,
    history: Vec<StepEntry>,
    notes: Vec<String>,
}

#[derive(Debug, Clone, Copy, Serialize)]
struct Estimate {
    value: f64,
    std: f64,
}

#[derive(Debug, Clone, Serialize)]
struct ChangeEntry {
    what: &'static str,
    /// rotor's name, axis or parameter
    of: Option<String>,
    /// rotor's place, from 0
    rotor: Option<usize>,
    /// the same by the autopilot's number, from 1
    motor: Option<usize>,
    sentence: String,
    before: Option<Estimate>,
    after: Option<Estimate>,
    by: Option<Estimate>,
    unit: &'static str,
    sigmas: f64,
    /// places of the later flights that each show it alone
    carried_by: Vec<usize>,
    may_be: Vec<String>,
}

#[derive(Debug, Clone, Serialize)]
struct LeastEntry {
    what: &'static str,
    of: Option<String>,
    size: f64,
    unit: &'static str,
}

#[derive(Debug, Clone, Serialize)]
struct FlightEntry {
    input: InputFile,
    group: Option<&'static str>,
    /// shares of thrust: along x and y in arms, about z
    balance: [Estimate; 3],
    legs: usize,
    felt: [f64; 2],
    own: OwnEntry,
    balance_only: Option<String>,
}

/// Of the day, never a change of the vehicle.
#[derive(Debug, Clone, Copy, Serialize)]
struct OwnEntry {
    full_thrust_over_weight: Option<Estimate>,
    voltage_v: Option<f64>,
    power_w: Option<f64>,
}

#[derive(Debug, Clone, Serialize)]
struct TrackEntry {
    name: String,
    unit: &'static str,
    owner: &'static str,
    values: Vec<Option<Estimate>>,
    /// of all flights, where nothing changed of it
    together: Option<Estimate>,
}

#[derive(Debug, Clone, Serialize)]
struct StepEntry {
    /// place of the first flight that is otherwise
    from: usize,
    changes: Vec<ChangeEntry>,
    /// places of earlier flights that it is as again; empty where it is as none of them
    as_before: Vec<usize>,
}

impl ComparisonDocument {
    /// The document of a study.
    #[must_use]
    pub fn new(study: &CompareStudy) -> Self {
        let compared = study.compared.as_ref();
        let entries =
            |changes: &[Change]| changes.iter().map(|change| entry(study, change)).collect::<Vec<_>>();
        Self {
            schema: 1,
            verdict: if study.has_changed() { "changed" } else { "nothing_changed" },
            answer: answer(study),
            known_vehicle: study.is_known,
            changes: compared.map(|compared| entries(&compared.changes)),
            smallest_changes: compared
                .map(|compared| compared.least.iter().map(|least| least_entry(study, least)).collect()),
            flights: (0..study.flights.len()).map(|place| flight(study, place)).collect(),
            parameters: study.tracks.iter().map(track).collect(),
            history: study
                .history
                .iter()
                .map(|step| StepEntry {
                    from: step.from,
                    changes: entries(&step.change.changes),
                    as_before: step.as_before.clone(),
                })
                .collect(),
            notes: study.notes.iter().map(Note::sentence).collect(),
        }
    }
}

fn estimate((value, std): (f64, f64)) -> Estimate {
    Estimate { value, std }
}

/// Kind, and which of it.
fn kind(study: &CompareStudy, what: Changed) -> (&'static str, Option<String>) {
    match what {
        Changed::Rotor(place) => ("rotor", Some(study.rotor(place).to_owned())),
        Changed::CentreOfMass(axis) => ("center_of_mass", Some(if axis == 0 { "x" } else { "y" }.to_owned())),
        Changed::YawTorque => ("yaw_torque", None),
        Changed::Balance => ("balance", None),
        Changed::Parameter(place) => ("parameter", study.tracks.get(place).map(|track| track.name.clone())),
    }
}

fn entry(study: &CompareStudy, change: &Change) -> ChangeEntry {
    let (what, of) = kind(study, change.what);
    let rotor = if let Changed::Rotor(place) = change.what { Some(place) } else { None };
    let part = |of: fn(Moved) -> (f64, f64)| change.moved.map(|moved| estimate(of(moved)));
    ChangeEntry {
        what,
        of,
        rotor,
        motor: rotor.map(|place| place + 1),
        sentence: sentence(study, change),
        before: part(|moved| moved.before),
        after: part(|moved| moved.after),
        by: part(|moved| moved.by),
        unit: change.unit,
        sigmas: change.sigmas,
        carried_by: change.carried_by.clone(),
        may_be: change.rivals.iter().map(|rival| rival_name(study, *rival)).collect(),
    }
}

fn least_entry(study: &CompareStudy, least: &LeastChange) -> LeastEntry {
    let (what, of) = kind(study, least.what);
    LeastEntry { what, of, size: least.size, unit: least.unit }
}

fn flight(study: &CompareStudy, place: usize) -> FlightEntry {
    let (of, balance) = (&study.flights[place], &study.balance.flights[place]);
    let is_before = |groups: &crate::change::Groups| groups.before.contains(&place);
    FlightEntry {
        input: of.input.clone(),
        group: study.groups.as_ref().map(|groups| if is_before(groups) { "before" } else { "after" }),
        balance: std::array::from_fn(|axis| estimate(study.balance.lean(place, axis))),
        legs: balance.legs,
        felt: balance.felt,
        own: OwnEntry {
            full_thrust_over_weight: balance.lift.map(estimate),
            voltage_v: balance.voltage_v,
            power_w: of.power_w,
        },
        balance_only: of.balance_only.clone(),
    }
}

fn track(of: &Track) -> TrackEntry {
    TrackEntry {
        name: of.name.clone(),
        unit: of.unit,
        owner: if of.owner == Owner::Flight { "flight" } else { "vehicle" },
        values: of.values.iter().map(|value| value.map(estimate)).collect(),
        together: of.pooled().map(estimate),
    }
}
