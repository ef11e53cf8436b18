//! The JSON document of `compare`.

use super::own::doubt;
use super::words::{answer, open, rival_name, sentence};
use crate::change::{Moved, Step, Undecided};
use crate::diagnose::Owner;
use crate::note::Note;
use crate::study::{Change, Changed, CompareStudy, Compared, InputFile, LeastChange};
use schemars::JsonSchema;
use serde::Serialize;

/// The JSON document of `compare`. Flights are named by their places, from 0, in the order in which they were given.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct ComparisonDocument {
    /// version of the document
    #[schemars(extend("const" = 1))]
    schema: u32,
    /// between the flights before and after; along all flights where no groups were given
    verdict: Verdict,
    /// the answer in a sentence or two
    answer: String,
    /// false: neither a vehicle nor a mass was given, and lengths are in arms
    known_vehicle: bool,
    /// the vehicle file; null: the vehicle was drafted
    vehicle_file: Option<InputFile>,
    /// what changed between the flights before and after, the strongest first; null where no groups were given
    changes: Option<Vec<ChangeEntry>>,
    /// parameters that moved by 3 to 4.5 standard deviations: no changes; null where no groups were given
    undecided: Option<Vec<UndecidedEntry>>,
    /// full thrust over weight before and after, where it and several parameters say that this is hardly one vehicle; null elsewhere
    other_vehicle: Option<OtherVehicle>,
    /// why the flights may be those of two vehicles: by full thrust over weight where no parameter tells, or by serial numbers of different
    /// sensors; no change. It is in the answer as well
    doubt: Option<String>,
    /// the smallest changes that would have been named: between the groups, or without groups in the middle of the row; null where no
    /// groups were given and something changed. Where the balance moved without a name, that of a rotor is the smallest that would be
    /// seen, named or not
    smallest_changes: Option<Vec<LeastEntry>>,
    /// one entry a flight
    flights: Vec<FlightEntry>,
    /// thrust of each rotor for a command along the flights, over that of the mean of all rotors: by the balance, with the centre of mass
    /// where the vehicle has it; of more than four rotors the smallest difference between them that makes it
    rotors: Vec<RotorEntry>,
    /// each parameter along the flights; empty where the balance alone was compared
    parameters: Vec<TrackEntry>,
    /// where along all flights something changed
    history: Vec<StepEntry>,
    /// flights that were given and cannot be used; they have no place
    left_out: Vec<LeftOutEntry>,
    /// warnings and remarks, a sentence each, with what they are about
    notes: Vec<String>,
}

#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
enum Verdict {
    NothingChanged,
    Changed,
}

/// Full thrust over weight of two vehicles.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
struct OtherVehicle {
    before: f64,
    after: f64,
}

/// What changed.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
enum Kind {
    /// a rotor's thrust for the same command over that before
    Rotor,
    /// where the centre of mass is along one axis of the body
    CenterOfMass,
    /// the torque about the vertical, over that of all rotors turning one way
    YawTorque,
    /// the balance, by nothing known alone: more than one thing changed
    Balance,
    /// a parameter of the vehicle
    Parameter,
}

#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
enum Group {
    Before,
    After,
}

#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
enum OwnerName {
    /// the same in every flight
    Vehicle,
    /// of the day: load, battery, wind; never a change
    Flight,
}

/// A value with its standard error.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
struct Estimate {
    value: f64,
    std: f64,
}

/// A value before and after.
#[derive(Debug, Clone, Serialize, JsonSchema)]
struct ChangeEntry {
    what: Kind,
    /// rotor's name, axis or parameter
    of: Option<String>,
    /// rotor's place in the vehicle's file, from 0
    rotor: Option<usize>,
    /// the same by the autopilot's number, from 1
    motor: Option<usize>,
    /// it in words
    sentence: String,
    /// of a rotor: 1, without an error
    before: Option<Estimate>,
    /// of a rotor: its thrust for the same command over that before
    after: Option<Estimate>,
    /// after less before
    by: Option<Estimate>,
    /// of the values; `-`: none
    unit: &'static str,
    /// size of the difference in its standard errors; of a balance without a name in standard deviations of what unchanged flights show
    sigmas: f64,
    /// places of the later flights that each show it alone
    carried_by: Vec<usize>,
    /// what else it may be
    may_be: Vec<String>,
}

/// A parameter that moved by more than chance and less than is certain.
#[derive(Debug, Clone, Serialize, JsonSchema)]
struct UndecidedEntry {
    #[serde(flatten)]
    change: ChangeEntry,
    /// flights on each side from which on a difference of this size would be certain
    flights_each_side: usize,
    /// most of the error is the spread between flights of one vehicle, not that of the flights themselves
    by_spread: bool,
}

/// A change along the flights.
#[derive(Debug, Clone, Serialize, JsonSchema)]
struct DatedEntry {
    #[serde(flatten)]
    change: ChangeEntry,
    /// place of the last flight that shows what was before; null: none of the earlier flights determines it
    last_before: Option<usize>,
    /// place of the first flight that shows what is since; those between do not determine it
    first_after: usize,
}

/// The smallest change that would have been named.
#[derive(Debug, Clone, Serialize, JsonSchema)]
struct LeastEntry {
    what: Kind,
    /// rotor's name, axis or parameter
    of: Option<String>,
    size: f64,
    /// of the size; `-`: none
    unit: &'static str,
}

/// A flight that cannot be used.
#[derive(Debug, Clone, Serialize, JsonSchema)]
struct LeftOutEntry {
    path: String,
    /// what was expected and what came
    why: String,
}

#[derive(Debug, Clone, Serialize, JsonSchema)]
struct FlightEntry {
    input: InputFile,
    /// null where no groups were given
    group: Option<Group>,
    /// in still air, shares of the thrust: where it acts along x and y (arms), the torque about z; the standard errors hold what wanders
    /// from flight to flight
    balance: [Estimate; 3],
    /// legs of 2 s that it rests on
    legs: usize,
    /// the air's push along body x and y, over the weight
    felt: [f64; 2],
    own: OwnEntry,
    /// why its motion was not compared, only its balance; null: it was
    balance_only: Option<String>,
}

/// Of the day, never a change of the vehicle.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
struct OwnEntry {
    full_thrust_over_weight: Option<Estimate>,
    voltage_v: Option<f64>,
    power_w: Option<f64>,
}

/// A rotor along the flights.
#[derive(Debug, Clone, Serialize, JsonSchema)]
struct RotorEntry {
    name: String,
    /// autopilot's number, from 1
    motor: usize,
    /// one entry a flight; the errors hold what wanders from flight to flight
    thrust_per_command: Vec<Estimate>,
    /// places of the flights from which on it is named as changed
    changed_from: Vec<usize>,
}

/// A parameter along the flights.
#[derive(Debug, Clone, Serialize, JsonSchema)]
struct TrackEntry {
    name: String,
    unit: &'static str,
    owner: OwnerName,
    /// standard deviation between flights of one vehicle beside their errors, share of the value: `changes` have it in their errors
    spread: f64,
    /// of each flight alone; null where it does not determine it
    values: Vec<Option<Estimate>>,
    /// of all flights, as of a vehicle that did not change
    together: Option<Estimate>,
    /// places of the flights from which on it is named as changed
    changed_from: Vec<usize>,
}

/// A place in the row of flights from which on something is otherwise.
#[derive(Debug, Clone, Serialize, JsonSchema)]
struct StepEntry {
    /// place of the first flight that shows one of the changes
    from: usize,
    changes: Vec<DatedEntry>,
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
            verdict: if study.has_changed() { Verdict::Changed } else { Verdict::NothingChanged },
            answer: answer(study),
            known_vehicle: study.is_known,
            vehicle_file: study.vehicle_file.clone(),
            changes: compared.map(|compared| entries(&compared.changes)),
            undecided: compared
                .map(|compared| compared.undecided.iter().map(|of| undecided_entry(study, of)).collect()),
            other_vehicle: compared
                .and_then(|compared| compared.other_vehicle)
                .map(|(before, after)| OtherVehicle { before, after }),
            doubt: doubt(study),
            smallest_changes: study
                .least()
                .map(|all| all.iter().map(|least| least_entry(study, least)).collect()),
            flights: (0..study.flights.len()).map(|place| flight(study, place)).collect(),
            rotors: (0..study.rotors.len()).map(|place| rotor(study, place)).collect(),
            parameters: (0..study.tracks.len()).map(|place| track(study, place)).collect(),
            history: study.history.iter().map(|step| step_entry(study, step)).collect(),
            left_out: study
                .left_out
                .iter()
                .map(|of| LeftOutEntry { path: of.path.clone(), why: of.why.clone() })
                .collect(),
            notes: study.notes.iter().map(Note::sentence).collect(),
        }
    }
}

fn estimate((value, std): (f64, f64)) -> Estimate {
    Estimate { value, std }
}

/// Kind, and which of it.
fn kind(study: &CompareStudy, what: Changed) -> (Kind, Option<String>) {
    match what {
        Changed::Rotor(place) => (Kind::Rotor, Some(study.rotor(place).to_owned())),
        Changed::CentreOfMass(axis) => {
            (Kind::CenterOfMass, Some(if axis == 0 { "x" } else { "y" }.to_owned()))
        }
        Changed::YawTorque => (Kind::YawTorque, None),
        Changed::Balance => (Kind::Balance, None),
        Changed::Parameter(place) => {
            (Kind::Parameter, study.tracks.get(place).map(|track| track.name.clone()))
        }
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

fn step_entry(study: &CompareStudy, step: &Step<Compared>) -> StepEntry {
    let dated = |change: &Change| {
        let (last_before, first_after) = study.dated(step, change.what);
        DatedEntry { change: entry(study, change), last_before, first_after }
    };
    let changes: Vec<DatedEntry> = step.change.changes.iter().map(dated).collect();
    let from = changes.iter().map(|change| change.first_after).min().unwrap_or(step.from);
    StepEntry { from, changes, as_before: step.as_before.clone() }
}

fn undecided_entry(study: &CompareStudy, of: &(Change, Undecided)) -> UndecidedEntry {
    let (change, why) = of;
    UndecidedEntry {
        change: ChangeEntry { sentence: open(study, of), ..entry(study, change) },
        flights_each_side: why.flights,
        by_spread: why.by_spread,
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
        group: study
            .groups
            .as_ref()
            .map(|groups| if is_before(groups) { Group::Before } else { Group::After }),
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

fn rotor(study: &CompareStudy, place: usize) -> RotorEntry {
    RotorEntry {
        name: study.rotor(place).to_owned(),
        motor: place + 1,
        thrust_per_command: study.rotors[place].iter().copied().map(estimate).collect(),
        changed_from: study.changed_from(Changed::Rotor(place)).collect(),
    }
}

fn track(study: &CompareStudy, place: usize) -> TrackEntry {
    let of = &study.tracks[place];
    let determined = |estimate: &(f64, f64)| of.is_determined(*estimate);
    TrackEntry {
        name: of.name.clone(),
        unit: of.unit,
        owner: if of.owner == Owner::Flight { OwnerName::Flight } else { OwnerName::Vehicle },
        spread: of.spread.relative,
        values: of.values.iter().map(|value| value.filter(determined).map(estimate)).collect(),
        together: of.pooled().filter(determined).map(estimate),
        changed_from: study.changed_from(Changed::Parameter(place)).collect(),
    }
}
