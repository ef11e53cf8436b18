//! `mavid plan VEHICLE`: plans an excitation trajectory, or checks one.

use mavid::config::trajectory_to_toml;
use mavid::plan::{Criterion, PlanRequest, StartPlace};
use mavid::report::{PlanDocument, plan_text};
use mavid::study::{Circle, PlanStudy, PlannedSeries, PlanningRequest, plan_flight};
use mavid::text;

use super::progress::Steps;
use super::standard_error::StandardError;
use super::{CommandError, Outcome, output};
use crate::cli::{CriterionName, PlanArgs};

/// Runs the verb.
pub fn run(json: bool, stderr: &StandardError, args: &PlanArgs) -> Result<Outcome, CommandError> {
    let study = make(stderr, args)?;
    if json {
        output::json(&PlanDocument::new(&study))?;
    } else {
        output::text(&plan_text(&study))?;
    }
    Ok(if study.first_violation.is_some() { Outcome::DoneWithLoss } else { Outcome::Done })
}

/// Plans or checks, and writes the trajectory where one is asked for.
pub fn make(stderr: &StandardError, args: &PlanArgs) -> Result<PlanStudy, CommandError> {
    let (read, written): (Vec<_>, Vec<_>) =
        (args.check.iter().chain(&args.vehicle).chain(&args.limits).collect(), args.out.iter().collect());
    output::refuse_overwriting(&read, &written)?;
    let study = plan_flight(
        &request(args)?,
        &Steps::new(stderr, "planning {bar:30} {pos} of {len} steps, about {eta} left"),
    )?;
    if let Some(path) = &args.out {
        let text = trajectory_to_toml(&study.stored())?;
        output::file(path, &text)?;
        output::message(&format!("wrote {}", text::path(&path)));
    }
    Ok(study)
}

fn request(args: &PlanArgs) -> Result<PlanningRequest, CommandError> {
    let place = |option: &str, numbers: &Option<Vec<f64>>| {
        numbers.as_deref().map(|numbers| place(option, numbers)).transpose()
    };
    Ok(PlanningRequest {
        vehicle: args.draft.given(args.vehicle.as_ref()),
        limits: args.limits.clone(),
        series: match (&args.check, &args.circle) {
            (Some(file), _) => PlannedSeries::Stored(file.clone()),
            (None, Some(numbers)) => PlannedSeries::Circle(circle(numbers)?),
            (None, None) => PlannedSeries::Searched,
        },
        search: search(args)?,
        takeoff: place("--takeoff", &args.takeoff)?,
        landing: place("--landing", &args.landing)?,
    })
}

fn search(args: &PlanArgs) -> Result<PlanRequest, CommandError> {
    let start = match args.start.as_deref() {
        None => StartPlace::default(),
        Some([x_m, y_m, rest @ ..]) => StartPlace {
            x_m: Some(*x_m),
            y_m: Some(*y_m),
            z_m: rest.first().copied(),
            yaw_rad: rest.get(1).map_or(0.0, |deg| deg.to_radians()),
        },
        Some(other) => return Err(came("--start", "X,Y[,Z[,YAW]]", other)),
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
        rests_inside: true,
        ..PlanRequest::default()
    })
}

fn circle(numbers: &[f64]) -> Result<Circle, CommandError> {
    match numbers {
        [radius_m, turn_s, rest @ ..] if rest.len() <= 1 => {
            Ok(Circle { radius_m: *radius_m, turn_s: *turn_s, height_m: rest.first().copied() })
        }
        other => Err(came("--circle", "RADIUS,PERIOD[,HEIGHT]", other)),
    }
}

fn place(option: &str, numbers: &[f64]) -> Result<[f64; 4], CommandError> {
    match numbers {
        [x, y, z, rest @ ..] if rest.len() <= 1 && numbers.iter().all(|value| value.is_finite()) => {
            Ok([*x, *y, *z, rest.first().map_or(0.0, |deg| deg.to_radians())])
        }
        other => Err(came(option, "X,Y,Z[,YAW]", other)),
    }
}

fn came(option: &str, expected: &str, numbers: &[f64]) -> CommandError {
    let got: Vec<String> = numbers.iter().map(ToString::to_string).collect();
    CommandError::Input(format!("{option}: expected {expected}, got `{}`", got.join(",")))
}
