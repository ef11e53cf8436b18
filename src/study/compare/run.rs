//! Opens, conditions, balances, fits and compares.

use super::judge::Judge;
use super::motion::{Motion, motion};
use super::order::{REORDERED, out_of_order};
use super::request::CompareRequest;
use super::result::{CompareStudy, Compared, ComparedFlight, LeftOut};
use super::usable::{Given, Usable};
use crate::change::{Groups, Step};
use crate::config::LoadedVehicle;
use crate::draft::Given as GivenVehicle;
use crate::estimate::{Contradiction, NAMES, stated};
use crate::note::{About, Note, said_once};
use crate::recording::{Quantity, Recording};
use crate::signals::{Signals, best, other_settings};
use crate::study::flight::Flight;
use crate::study::flights::Prepared;
use crate::study::one_vehicle::{doubt_one_vehicle, refuse_others, serials_apart};
use crate::study::same_flight::refuse_same_flight;
use crate::study::vehicle_given::Known;
use crate::study::{InputFile, Progress, Stage, StudyError, Track, VehicleGiven, said_of};
use crate::text::with_error;
use crate::trim::{balance, rotor_tracks};
use crate::vehicle::Vehicle;

/// A vehicle of which nothing is known: its mass sets a scale that no result shows.
pub(in crate::study) const UNKNOWN: GivenVehicle = GivenVehicle { mass_kg: 1.0, size_m: None, frame: None };
/// What is said then.
const SHARES: &str = "neither mass nor lengths were given: thrusts are compared as shares, lengths in arms";

/// Why the balance alone is compared, and not the motion: asked for so, or nothing is known of the vehicle.
const UNASKED: &str = "the motion was not asked for";
/// See [`UNASKED`].
const UNWEIGHED: &str = "neither a vehicle nor a mass was given";

/// Says what changed of a vehicle between flights, and where along a row of them.
///
/// # Errors
/// [`StudyError`] where a file or a setting cannot be used, or a flight shows no balance.
pub fn compare(request: &CompareRequest, progress: &dyn Progress) -> Result<CompareStudy, StudyError> {
    let _stage = tracing::info_span!("compare").entered();
    let (given, known, vehicle_file) = given(request)?;
    progress.stage(Stage::Reading);
    let logs = Given::load(request, &given)?;
    refuse_same_flight(logs.groups.iter().flatten())?;
    refuse_others(logs.each())?;
    let mut notes = doubt_one_vehicle(logs.each());
    let serials_apart = serials_apart(logs.each());
    refuse_single(logs.each())?;
    let (Usable { flights, legs, starts_utc_us, first, reordered, left_out }, known) =
        logs.conditioned(known, progress)?;
    notes.splice(0..0, of_vehicle(request, &known));
    let Known { loaded: LoadedVehicle { vehicle, .. }, draft, .. } = known;
    notes.extend(left_out.iter().map(LeftOut::note));
    notes.extend(of_flights(&flights, &starts_utc_us, (first, reordered)));
    let balance = balance(&legs);
    progress.stage(Stage::Explaining);
    let Motion { tracks, alone, reasons, notes: of_motion } = moved(request, &flights, &vehicle, progress);
    notes.extend(of_motion);
    if draft.is_none() {
        notes.extend(contradictions(&tracks, &vehicle).iter().map(Contradiction::note));
    }
    let judge = Judge {
        vehicle: &vehicle,
        balance: &balance,
        tracks: &tracks,
        alone: &alone,
        is_known: request.vehicle.is_some(),
    };
    let count = flights.signals.len();
    let groups = (first < count).then(|| Groups::split(count, first));
    let compared = groups.as_ref().map(|groups| judge.compared(groups));
    let order: Vec<usize> = (0..count).collect();
    let history = judge.history(&order, 0.0);
    let is_unchanged = groups.is_none() && history.is_empty();
    let least_in_the_middle = is_unchanged.then(|| judge.least_in_the_middle(&order));
    let undecided_along = if is_unchanged { judge.undecided_along(&order) } else { None };
    let between = groups.as_ref();
    let (lifts_apart, scale) = (judge.lifts_apart(between), judge.scale(between));
    let balance_unnamed = judge.moved_without_name(between);
    if groups.is_none() {
        notes.extend(moved_by_loads(&judge, &flights.inputs, &history));
    }
    Ok(CompareStudy {
        flights: each_compared(&flights, reasons),
        is_known: request.vehicle.is_some(),
        rotors: rotor_tracks(&balance, &vehicle),
        vehicle_file,
        vehicle,
        balance,
        tracks,
        alone,
        groups,
        compared,
        history,
        least_in_the_middle,
        undecided_along,
        lifts_apart,
        serials_apart,
        scale,
        balance_unnamed,
        left_out,
        notes,
    })
}

/// How the vehicle of a request that can be met is given, and what of it is in a file.
fn given(request: &CompareRequest) -> Result<(VehicleGiven, Option<Known>, Option<InputFile>), StudyError> {
    request.check()?;
    let given = request
        .vehicle
        .clone()
        .unwrap_or(VehicleGiven::Weighed(GivenVehicle { frame: request.frame, ..UNKNOWN }));
    let known = given.of_file()?;
    let file = match &given {
        VehicleGiven::File(file) => Some(InputFile::of(file)?),
        VehicleGiven::Weighed(_) => None,
    };
    Ok((given, known, file))
}

/// What is to be known of the flights: their order, their logs, and what is doubtful about their data.
fn of_flights(
    flights: &Prepared,
    starts_utc_us: &[Option<u64>],
    (first, reordered): (usize, bool),
) -> Vec<Note> {
    let paths = flights.inputs.iter().map(|input| input.path.as_str());
    let begun: Vec<_> = starts_utc_us.iter().copied().zip(paths).collect();
    let mut notes: Vec<Note> = out_of_order(&begun, first).into_iter().collect();
    notes.extend(reordered.then(|| Note::warning(About::Estimate, REORDERED)));
    notes.extend(said_of(&flights.inputs));
    notes.extend(other_settings(&flights.recordings));
    notes.extend(doubts(flights));
    notes
}

/// What is to be known of the vehicle.
fn of_vehicle(request: &CompareRequest, known: &Known) -> Vec<Note> {
    match &request.vehicle {
        None => vec![Note::remark(About::Vehicle, SHARES)],
        Some(_) => known.notes(),
    }
}

/// What the motion says; nothing where it is not compared, with the reason.
fn moved(request: &CompareRequest, flights: &Prepared, vehicle: &Vehicle, progress: &dyn Progress) -> Motion {
    let why_not = match &request.vehicle {
        None => Some(UNWEIGHED),
        Some(_) => request.balance_only.then_some(UNASKED),
    };
    let Some(why) = why_not else {
        return motion((&flights.inputs, &flights.signals), vehicle, progress);
    };
    let reasons = vec![Some(why.to_owned()); flights.signals.len()];
    Motion { tracks: Vec::new(), alone: Vec::new(), reasons, notes: Vec::new() }
}

/// A remark for each flight whose balance differs from the flight's before it by no more than a load moves it, where nothing changed.
fn moved_by_loads(judge: &Judge<'_>, inputs: &[InputFile], history: &[Step<Compared>]) -> Vec<Note> {
    let of = |later: usize| {
        let groups = Groups { before: vec![later - 1], after: vec![later] };
        let balance = judge.compared(&groups).balance;
        let [x, y, _] = balance.moved.map(|moved| with_error(moved.by.0, moved.by.1));
        let text = format!(
            "its balance differs from that of {} by {x} of an arm along body x and {y} along y: a load or a battery that sits elsewhere \
             does the same and is the flight's own. The rotors along the flights have it in their values",
            inputs[later - 1].path
        );
        balance.by_a_load.then(|| Note::remark(About::File(inputs[later].path.clone()), text))
    };
    (1..inputs.len()).filter(|later| !history.iter().any(|step| step.from == *later)).filter_map(of).collect()
}

/// Mass and moments of inertia of all flights that are far from what the vehicle file states.
fn contradictions(tracks: &[Track], vehicle: &Vehicle) -> Vec<Contradiction> {
    let of = |track: &Track| {
        let index =
            NAMES.iter().position(|name| *name == track.name).filter(|index| MOMENTS.contains(index))?;
        Contradiction::of(NAMES[index], track.pooled()?, stated(vehicle, index))
    };
    tracks.iter().filter_map(of).collect()
}

/// Mass and the moments of inertia among [`NAMES`].
const MOMENTS: [usize; 4] = [0, 1, 4, 6];

/// What is doubtful about the flights' data.
fn doubts(flights: &Prepared) -> Vec<Note> {
    let of = |(input, signals): (&InputFile, &Signals)| -> Vec<Note> {
        let doubts = signals.quality.notes.iter().filter(|note| note.is_warning());
        doubts.map(|doubt| Note::warning(About::File(input.path.clone()), doubt.text.as_str())).collect()
    };
    said_once(flights.each().flat_map(of).collect())
}

fn each_compared(flights: &Prepared, reasons: Vec<Option<String>>) -> Vec<ComparedFlight> {
    let each = flights.inputs.iter().zip(&flights.recordings).zip(&flights.signals).zip(reasons);
    each.map(|(((input, recording), signals), balance_only)| ComparedFlight {
        input: input.clone(),
        power_w: power_w(recording, signals),
        balance_only,
    })
    .collect()
}

/// Two logs of one flight are one flight.
fn refuse_single<'a>(flights: impl Iterator<Item = &'a Flight>) -> Result<(), StudyError> {
    let flights: Vec<&Flight> = flights.collect();
    let [flight] = flights.as_slice() else { return Ok(()) };
    let files: Vec<&str> = flight.input.files().map(|(path, _)| path).collect();
    Err(StudyError::TooFewFlights {
        came: format!("but {} are logs of the same flight", files.join(" and ")),
    })
}

/// Mean electrical power in the air, W.
pub(in crate::study) fn power_w(recording: &Recording, signals: &Signals) -> Option<f64> {
    let (_, voltage) = best(recording, Quantity::BatteryVoltage, |stream| stream.width == 1)?;
    let (_, current) = best(recording, Quantity::BatteryCurrent, |stream| stream.width == 1)?;
    let flies = |at: &f64| signals.quality.airborne_s.iter().any(|(from, to)| (from..=to).contains(&at));
    let mean = |stream: &crate::recording::Stream| {
        let inside: Vec<f64> = (0..stream.len())
            .filter(|index| flies(&stream.time_s[*index]))
            .map(|index| stream.sample(index)[0])
            .filter(|value| value.is_finite())
            .collect();
        (!inside.is_empty()).then(|| inside.iter().sum::<f64>() / inside.len() as f64)
    };
    Some(mean(voltage)? * mean(current)?).filter(|power| *power > 0.0)
}
