//! Reads vehicle and limits, plans or assesses a series, and puts takeoff and landing around it.

use super::request::{Circle, PlannedSeries, PlanningRequest};
use super::result::{FlightExtremes, PlanStudy};
use crate::config::{StoredTransitions, read_limits, read_trajectory};
use crate::note::{About, Note};
use crate::plan::{
    Dynamics, FlightPlan, PlanError, RestInside, Roomed, assess, bounds_of, flight_path, floor_m, plan,
    too_narrow, with_room, work_of,
};
use crate::study::flights::file_notes;
use crate::study::{Progress, StudyError};
use crate::trajectory::{CirclePath, FlightPath, FourierTrajectory, Segment};
use crate::vehicle::{Limits, Vehicle};

/// Where the ways to the series and back cannot keep what the series keeps.
const BEYOND_ON_THE_WAY: &str = "expected transitions on which the vehicle comes to rest inside the room if setpoints \
                                 end, got a takeoff or a landing place that allows none: move it further inside";

/// s a turn of a circle, from and to.
const TURN_S: [f64; 2] = [0.1, 1000.0];

/// Plans an excitation trajectory for a vehicle, or assesses a given one, with the way from takeoff to landing.
///
/// # Errors
/// [`StudyError`] where a file or a setting cannot be used, or no trajectory keeps the limits.
pub fn plan_flight(request: &PlanningRequest, progress: &dyn Progress) -> Result<PlanStudy, StudyError> {
    let (loaded, origin) = request.vehicle.alone()?;
    let vehicle = loaded.vehicle;
    let mut notes = file_notes(&origin, &loaded.warnings);
    let stated = request.limits.as_deref().map_or(Ok(vehicle.limits), read_limits)?;
    let Roomed { limits, notes: of_room } = with_room(&stated, &vehicle);
    notes.extend(file_notes(request.limits.as_deref().unwrap_or(&origin), &of_room));
    notes.iter().for_each(|note| progress.note(note));
    let (mut study, rest) = planned(request, (&vehicle, &limits), (notes, progress))?;
    let flight = around(&study.series, request, study.repeats);
    let narrow = too_narrow(&limits, &vehicle).map(|(wall, wall_m, reach_m)| {
        format!("the rotors reach {reach_m:.2} m to each side, {} is at {wall_m:.2} m", wall.words())
    });
    if let Some(violation) = narrow.or_else(|| below_floor(&flight, &vehicle)) {
        study.first_violation.get_or_insert(violation);
    }
    let mut note = |note: Note| {
        progress.note(&note);
        study.notes.push(note);
    };
    rest_note(request, rest.as_ref()).into_iter().for_each(&mut note);
    let (bounds, dynamics) = (bounds_of(&limits, &vehicle), Dynamics::new(&vehicle));
    let calm = rest.and_then(|rest| {
        let calm = [bounds.as_slice(), &rest.bounds].concat();
        let path = flight_path(&study.series, &flight, &calm, &dynamics);
        if path.is_err() {
            note(Note::warning(About::Vehicle, BEYOND_ON_THE_WAY));
        }
        path.ok()
    });
    match calm.map_or_else(|| flight_path(&study.series, &flight, &bounds, &dynamics), Ok) {
        Ok(path) => {
            study.transitions = transitions(&path, &flight);
            study.flown = Some(FlightExtremes::of(&path, &vehicle));
        }
        Err(error) => {
            study.first_violation.get_or_insert(error.to_string());
        }
    }
    Ok(study)
}

/// What is to be known where a vehicle that hears nothing more may leave the room.
fn rest_note(request: &PlanningRequest, rest: Option<&RestInside>) -> Option<Note> {
    if !request.search.rests_inside || request.series != PlannedSeries::Searched {
        return None;
    }
    let remedy = "enlarge the room, or plan with a lower speed_max_m_s or a longer --period";
    let text = match rest.map(|rest| rest.inside_m) {
        Some(inside_m) if inside_m >= 0.0 => return None,
        Some(inside_m) => format!(
            "expected that the vehicle comes to rest inside the room if setpoints end, got up to {:.2} m outside \
             (its rotors, PX4's default parameters): {remedy}",
            -inside_m
        ),
        None => format!(
            "expected that the vehicle comes to rest inside the room if setpoints end, got no such plan: this one \
             ignores it; {remedy}"
        ),
    };
    Some(Note::warning(About::Vehicle, text))
}

/// The series and what it is worth; and what keeps a vehicle that hears nothing more inside the room, as far as the search
/// kept it.
fn planned(
    request: &PlanningRequest,
    (vehicle, limits): (&Vehicle, &Limits),
    (notes, progress): (Vec<Note>, &dyn Progress),
) -> Result<(PlanStudy, Option<RestInside>), StudyError> {
    let mut search = request.search.clone();
    let bounds = bounds_of(limits, vehicle);
    let (series, assessment, criterion_value, rest) = match &request.series {
        PlannedSeries::Searched => {
            progress.steps(work_of(&search));
            let plan = plan(vehicle, limits, &search, &|| progress.step())?;
            (plan.trajectory, plan.assessment, Some(plan.criterion_value), plan.rest)
        }
        PlannedSeries::Stored(file) => {
            let stored = read_trajectory(file)?;
            search.repeats = stored.repeats;
            let worth = assess(&stored.series, vehicle, &bounds, &search);
            (stored.series, worth, None, None)
        }
        PlannedSeries::Circle(circle) => {
            let series = turns(circle, limits)?;
            series.check_size(search.repeats).map_err(PlanError::from)?;
            let worth = assess(&series, vehicle, &bounds, &search);
            (series, worth, None, None)
        }
    };
    let study = PlanStudy {
        series,
        repeats: search.repeats,
        limits: *limits,
        first_violation: assessment.check.first_violation.map(|violation| violation.to_string()),
        assessment,
        criterion: search.criterion,
        criterion_value,
        transitions: None,
        flown: None,
        notes,
    };
    Ok((study, rest))
}

fn turns(circle: &Circle, limits: &Limits) -> Result<FourierTrajectory, StudyError> {
    let middle = match (limits.z_min_m, limits.z_max_m) {
        (Some(low), Some(high)) => f64::midpoint(low, high),
        (Some(low), None) => low + 1.0,
        (None, Some(high)) => high - 1.0,
        (None, None) => 1.0,
    };
    let Circle { radius_m, turn_s, height_m } = *circle;
    let sound = radius_m > 0.0
        && radius_m.is_finite()
        && (TURN_S[0]..=TURN_S[1]).contains(&turn_s)
        && height_m.is_none_or(f64::is_finite);
    if !sound {
        let mut came = vec![radius_m, turn_s];
        came.extend(height_m);
        let why = format!(
            "expected a radius above 0 m, a period of 0.1 to 1000 s and a finite height, got {came:?}"
        );
        return Err(StudyError::Setting { name: "circle", why });
    }
    Ok(CirclePath { radius_m, height_m: height_m.unwrap_or(middle) }.steady_turns(turn_s))
}

/// Where the flight begins and ends: unless prescribed, at the series' mean. A series may start on a bound,
/// and a transition to the very place would swing beyond it.
fn around(series: &FourierTrajectory, request: &PlanningRequest, repeats: u32) -> FlightPlan {
    let mean: [f64; 4] = std::array::from_fn(|i| series.axes[i].c);
    let takeoff = request.takeoff.unwrap_or(mean);
    FlightPlan { takeoff, landing: request.landing.unwrap_or(takeoff), hover_s: 0.0, repeats }
}

/// A hover before or after the series in which the rotors come near the ground.
fn below_floor(flight: &FlightPlan, vehicle: &Vehicle) -> Option<String> {
    let floor_m = floor_m(vehicle);
    let places = [("takeoff", flight.takeoff[2]), ("landing", flight.landing[2])];
    places
        .into_iter()
        .find(|(_, height_m)| *height_m < floor_m)
        .map(|(name, height_m)| format!("hover of {name} is at {height_m:.2} m, the floor at {floor_m:.2} m"))
}

/// Transitions before and after the series.
fn transitions(path: &FlightPath, flight: &FlightPlan) -> Option<StoredTransitions> {
    let mut durations = path
        .segments
        .iter()
        .filter(|(segment, _)| matches!(segment, Segment::Transition(_)))
        .map(|(_, duration)| *duration);
    let (to_start_s, to_landing_s) = (durations.next()?, durations.next()?);
    Some(StoredTransitions { takeoff: flight.takeoff, landing: flight.landing, to_start_s, to_landing_s })
}
