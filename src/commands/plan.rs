//! `mavid plan VEHICLE`: plans an excitation trajectory, or checks one.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

use indicatif::{ProgressBar, ProgressStyle};
use mavid::config::{
    StoredTrajectory, StoredTransitions, read_limits, read_trajectory, read_vehicle, trajectory_to_toml,
};
use mavid::fly::preflight::Extremes;
use mavid::plan::{
    Assessment, Criterion, Dynamics, FlightPlan, Margin, PARAMETERS, Plan, PlanError, PlanRequest, Roomed,
    StartPlace, assess, bounds_of, flight_path, floor_m, plan, search_of, with_room,
};
use mavid::text;
use mavid::trajectory::{CirclePath, FlightPath, FourierTrajectory, Segment};
use mavid::units::deg_from_rad;
use mavid::vehicle::{Limits, Vehicle};
use serde::Serialize;

use super::standard_error::StandardError;
use super::{CommandError, Outcome, output};
use crate::cli::{CriterionName, PlanArgs};

/// What `mavid plan` says.
#[derive(Debug, Serialize)]
pub struct Summary {
    schema: u32,
    criterion: Criterion,
    criterion_value: Option<f64>,
    condition_number: f64,
    scaled_condition_number: f64,
    /// relative, of what the flight will determine; none where it cannot determine all seven
    standard_errors: Option<BTreeMap<&'static str, f64>>,
    flight_s: f64,
    /// what is left to each bound on 2 ms samples, SI
    margins: BTreeMap<String, f64>,
    first_violation: Option<String>,
    /// share of the rotor commands at a rotor's bound when it is flown in simulation; none where it cannot be flown
    share_at_rotor_bound: Option<f64>,
    /// from takeoff to the series and back; none where no transition keeps the limits
    transitions: Option<Transitions>,
    /// of the whole flight from takeoff to landing; none where no transition keeps the limits
    flown: Option<Flown>,
}

/// The box round a flight and its extremes.
#[derive(Debug, Clone, Copy, Serialize)]
struct Flown {
    /// x, y, z
    low_m: [f64; 3],
    high_m: [f64; 3],
    horizontal_speed_m_s: f64,
    vertical_speed_m_s: f64,
    tilt_deg: f64,
}

impl Flown {
    fn of(path: &FlightPath, vehicle: &Vehicle) -> Self {
        let extremes = Extremes::of(path, vehicle);
        Self {
            low_m: extremes.low_m,
            high_m: extremes.high_m,
            horizontal_speed_m_s: extremes.horizontal_speed_m_s,
            vertical_speed_m_s: extremes.up_speed_m_s.max(extremes.down_speed_m_s),
            tilt_deg: deg_from_rad(extremes.tilt_rad),
        }
    }
}

/// What is flown before and after the series.
#[derive(Debug, Clone, Copy, Serialize)]
struct Transitions {
    /// x, y, z (m), yaw (rad)
    takeoff: [f64; 4],
    /// the same before landing
    landing: [f64; 4],
    to_start_s: f64,
    to_landing_s: f64,
}

impl From<PlanError> for CommandError {
    fn from(error: PlanError) -> Self {
        match error {
            PlanError::Request { .. } | PlanError::Size(_) | PlanError::Conflict(_) => {
                Self::Input(error.to_string())
            }
            PlanError::OutsideLimits { .. } | PlanError::NotDetermined => Self::Failure(error.to_string()),
        }
    }
}

/// Runs the verb.
pub fn run(json: bool, stderr: &StandardError, args: &PlanArgs) -> Result<Outcome, CommandError> {
    let summary = make(stderr, args)?;
    if json {
        output::json(&summary)?;
    } else {
        output::text(&page(&summary))?;
    }
    Ok(if summary.first_violation.is_some() { Outcome::DoneWithLoss } else { Outcome::Done })
}

/// Plans or checks, and writes the trajectory where one is asked for.
pub fn make(stderr: &StandardError, args: &PlanArgs) -> Result<Summary, CommandError> {
    let loaded = read_vehicle(&args.vehicle)?;
    output::warnings(&args.vehicle, &loaded.warnings);
    let vehicle = loaded.vehicle;
    let stated = args.limits.as_deref().map_or(Ok(vehicle.limits), read_limits)?;
    let Roomed { limits, notes } = with_room(&stated, &vehicle);
    let file = args.limits.as_deref().unwrap_or(&args.vehicle);
    output::warnings(file, &notes);
    let mut request = request_of(args)?;
    let bounds = bounds_of(&limits, &vehicle);
    let (series, worth, criterion_value) = if let Some(file) = &args.check {
        let stored = read_trajectory(file)?;
        request.repeats = stored.repeats;
        let worth = assess(&stored.series, &vehicle, &bounds, &request);
        (stored.series, worth, None)
    } else if let Some(circle) = &args.circle {
        let series = circle_of(circle, &limits)?;
        series.check_size(request.repeats).map_err(PlanError::from)?;
        let worth = assess(&series, &vehicle, &bounds, &request);
        (series, worth, None)
    } else {
        let plan = planned(stderr, (&vehicle, &limits), &request)?;
        (plan.trajectory, plan.assessment, Some(plan.criterion_value))
    };
    let mut summary = summarize(&worth, request.criterion, criterion_value);
    let flight = around(&series, args, request.repeats)?;
    if let Some(violation) = below_floor(&flight, &vehicle) {
        summary.first_violation.get_or_insert(violation);
    }
    match flight_path(&series, &flight, &bounds, &Dynamics::new(&vehicle)) {
        Ok(path) => {
            summary.transitions = transitions_of(&path, &flight);
            summary.flown = Some(Flown::of(&path, &vehicle));
        }
        Err(error) => {
            summary.first_violation.get_or_insert(error.to_string());
        }
    }
    if let Some(path) = &args.out {
        store(path, series, (&limits, &request), &summary)?;
        output::message(&format!("wrote {}", text::path(&path)));
    }
    Ok(summary)
}

fn planned(
    stderr: &StandardError,
    (vehicle, limits): (&Vehicle, &Limits),
    request: &PlanRequest,
) -> Result<Plan, CommandError> {
    let bar = stderr.bar(ProgressBar::new(search_of(request).work()));
    if let Ok(style) = ProgressStyle::with_template("planning {bar:30} {pos}/{len} descents") {
        bar.set_style(style);
    }
    let result = plan(vehicle, limits, request, &|| bar.inc(1));
    bar.finish_and_clear();
    Ok(result?)
}

/// The circle of `--circle`.
fn circle_of(numbers: &[f64], limits: &Limits) -> Result<FourierTrajectory, CommandError> {
    let middle = match (limits.z_min_m, limits.z_max_m) {
        (Some(low), Some(high)) => f64::midpoint(low, high),
        (Some(low), None) => low + 1.0,
        (None, Some(high)) => high - 1.0,
        (None, None) => 1.0,
    };
    let (radius_m, turn_s, height_m) = match numbers {
        [radius, turn] => (*radius, *turn, middle),
        [radius, turn, height] => (*radius, *turn, *height),
        other => {
            let message = format!("--circle: expected RADIUS,PERIOD[,HEIGHT], came {other:?}");
            return Err(CommandError::Input(message));
        }
    };
    let sound =
        radius_m > 0.0 && radius_m.is_finite() && (0.1..=1000.0).contains(&turn_s) && height_m.is_finite();
    if !sound {
        return Err(CommandError::Input(format!(
            "--circle: expected a radius above 0 m, a period of 0.1 to 1000 s and a finite height, came {numbers:?}"
        )));
    }
    Ok(CirclePath { radius_m, height_m }.steady_turns(turn_s))
}

/// Where the flight begins and ends: unless prescribed, at the series' mean. A series may start on a bound,
/// and a transition to the very place would swing beyond it.
fn around(series: &FourierTrajectory, args: &PlanArgs, repeats: u32) -> Result<FlightPlan, CommandError> {
    let place: [f64; 4] = std::array::from_fn(|i| series.axes[i].c);
    let takeoff = args.takeoff.as_deref().map_or(Ok(place), |numbers| place_of("--takeoff", numbers))?;
    let landing = args.landing.as_deref().map_or(Ok(takeoff), |numbers| place_of("--landing", numbers))?;
    Ok(FlightPlan { takeoff, landing, hover_s: 0.0, repeats })
}

fn place_of(option: &str, numbers: &[f64]) -> Result<[f64; 4], CommandError> {
    match numbers {
        [x, y, z, rest @ ..] if rest.len() <= 1 && numbers.iter().all(|value| value.is_finite()) => {
            Ok([*x, *y, *z, rest.first().map_or(0.0, |deg| deg.to_radians())])
        }
        other => Err(CommandError::Input(format!("{option}: expected X,Y,Z[,YAW], came {other:?}"))),
    }
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
fn transitions_of(path: &FlightPath, flight: &FlightPlan) -> Option<Transitions> {
    let mut durations = path
        .segments
        .iter()
        .filter(|(segment, _)| matches!(segment, Segment::Transition(_)))
        .map(|(_, duration)| *duration);
    let (to_start_s, to_landing_s) = (durations.next()?, durations.next()?);
    Some(Transitions { takeoff: flight.takeoff, landing: flight.landing, to_start_s, to_landing_s })
}

fn store(
    path: &Path,
    series: FourierTrajectory,
    (limits, request): (&Limits, &PlanRequest),
    summary: &Summary,
) -> Result<(), CommandError> {
    let errors = summary.standard_errors.clone().unwrap_or_default();
    let name = serde_json::to_value(summary.criterion).ok();
    let name = name.as_ref().and_then(|name| name.as_str()).unwrap_or_default().to_owned();
    let stored = StoredTrajectory {
        series,
        repeats: request.repeats,
        limits: *limits,
        criterion: summary.criterion_value.map(|value| (name, value)),
        margins: summary.margins.clone(),
        standard_errors: errors.into_iter().map(|(name, value)| (name.to_owned(), value)).collect(),
        transitions: summary.transitions.map(|t| StoredTransitions {
            takeoff: t.takeoff,
            landing: t.landing,
            to_start_s: t.to_start_s,
            to_landing_s: t.to_landing_s,
        }),
    };
    std::fs::write(path, trajectory_to_toml(&stored)?)
        .map_err(|error| CommandError::Failure(format!("cannot write {}: {error}", text::path(&path))))
}

fn request_of(args: &PlanArgs) -> Result<PlanRequest, CommandError> {
    let start = match args.start.as_deref() {
        None => StartPlace::default(),
        Some([x_m, y_m, rest @ ..]) => StartPlace {
            x_m: *x_m,
            y_m: *y_m,
            z_m: rest.first().copied(),
            yaw_rad: rest.get(1).map_or(0.0, |deg| deg.to_radians()),
        },
        Some(other) => {
            return Err(CommandError::Input(format!("--start: expected X,Y[,Z[,YAW]], came {other:?}")));
        }
    };
    Ok(PlanRequest {
        period_s: args.period,
        harmonics: args.harmonics,
        repeats: args.repeats,
        start,
        criterion: match args.criterion {
            CriterionName::Cond => Criterion::Cond,
            CriterionName::ScaledCond => Criterion::ScaledCond,
            CriterionName::DOpt => Criterion::DOpt,
            CriterionName::AOpt => Criterion::AOpt,
        },
        seed: args.seed,
        starts: args.starts,
        ..PlanRequest::default()
    })
}

fn summarize(worth: &Assessment, criterion: Criterion, criterion_value: Option<f64>) -> Summary {
    let errors = worth.standard_errors.map(|errors| PARAMETERS.into_iter().zip(errors).collect());
    let margins = worth.check.margins.iter();
    Summary {
        schema: 1,
        criterion,
        criterion_value,
        condition_number: worth.condition_number,
        scaled_condition_number: worth.scaled_condition_number,
        standard_errors: errors,
        flight_s: worth.flight_s,
        margins: margins.map(|margin| (margin_name(margin), margin.spare())).collect(),
        first_violation: worth.check.first_violation.map(|violation| violation.to_string()),
        share_at_rotor_bound: worth.share_at_bound,
        transitions: None,
        flown: None,
    }
}

fn margin_name(margin: &Margin) -> String {
    format!("{}_{}", margin.quantity.name(), if margin.upper { "max" } else { "min" })
}

/// The summary for people.
fn page(summary: &Summary) -> String {
    let mut page = format!(
        "cond(W) {:.3}, with scaled columns {:.3}\n",
        summary.condition_number, summary.scaled_condition_number
    );
    // writing to a String cannot fail
    match &summary.standard_errors {
        None => {
            let _ = writeln!(page, "this flight does not determine all seven parameters");
        }
        Some(errors) => {
            let _ = writeln!(page, "expected standard errors after {} s", summary.flight_s);
            for name in PARAMETERS {
                let share = errors.get(name).copied().unwrap_or(f64::NAN);
                let _ = writeln!(page, "  {name:<5} {:.2} %{}", 100.0 * share, of_what(name));
            }
        }
    }
    let _ = writeln!(page, "left to each bound on 2 ms samples");
    for (name, spare) in &summary.margins {
        let (spare, name) = in_degrees(*spare, name);
        let _ = writeln!(page, "  {name:<30} {spare:.6}");
    }
    if let Some(Flown { low_m, high_m, horizontal_speed_m_s, vertical_speed_m_s, tilt_deg }) = summary.flown {
        let _ = writeln!(
            page,
            "flown: north {:.2} to {:.2} m, west {:.2} to {:.2} m, up {:.2} to {:.2} m; at most {horizontal_speed_m_s:.2} m/s along the ground, {vertical_speed_m_s:.2} m/s up or down, {tilt_deg:.1} degrees of tilt",
            low_m[0], high_m[0], low_m[1], high_m[1], low_m[2], high_m[2],
        );
    }
    let _ = match summary.share_at_rotor_bound {
        Some(share) => {
            writeln!(
                page,
                "flown in simulation, {:.1} % of the rotors' commands are at a bound",
                100.0 * share
            )
        }
        None => writeln!(page, "the simulated controller cannot fly it"),
    };
    if let Some(around) = &summary.transitions {
        // no minus zero
        let shown = |place: [f64; 4]| place.map(|value| if value.abs() < 0.005 { 0.0 } else { value });
        let [x, y, z, _] = shown(around.takeoff);
        let (to_start_s, to_landing_s) = (around.to_start_s, around.to_landing_s);
        let _ = writeln!(page, "from hover at ({x:.2}, {y:.2}, {z:.2}) m to the start in {to_start_s:.2} s");
        let [x, y, z, _] = shown(around.landing);
        let _ = writeln!(page, "from the end to hover at ({x:.2}, {y:.2}, {z:.2}) m in {to_landing_s:.2} s");
    }
    match &summary.first_violation {
        Some(violation) => {
            let _ = write!(page, "first violation: {violation}");
        }
        None => {
            let _ = write!(page, "every bound is kept");
        }
    }
    page
}

/// A product of inertia is small against the moments that it couples.
fn of_what(name: &str) -> &'static str {
    match name {
        "ixy" => " of sqrt(ixx iyy)",
        "ixz" => " of sqrt(ixx izz)",
        "iyz" => " of sqrt(iyy izz)",
        _ => "",
    }
}

fn in_degrees(value: f64, name: &str) -> (f64, String) {
    if name.contains("_rad") {
        (value.to_degrees(), name.replace("_rad", "_deg"))
    } else {
        (value, name.to_owned())
    }
}
