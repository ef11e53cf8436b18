//! `mavid plan VEHICLE`: plans an excitation trajectory, or checks one.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

use indicatif::{ProgressBar, ProgressStyle};
use mavid::config::{StoredTrajectory, read_limits, read_trajectory, read_vehicle, trajectory_to_toml};
use mavid::plan::{
    Assessment, Criterion, Margin, PARAMETERS, PlanError, PlanRequest, StartPlace, assess, bounds_of, plan,
    search_of,
};
use mavid::trajectory::FourierTrajectory;
use mavid::vehicle::{Limits, Vehicle};
use serde::Serialize;

use super::{CommandError, Outcome, output};
use crate::cli::{CriterionName, PlanArgs};

/// What `mavid plan` says.
#[derive(Debug, Serialize)]
struct Summary {
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
}

impl From<PlanError> for CommandError {
    fn from(error: PlanError) -> Self {
        match error {
            PlanError::Request { .. } | PlanError::Conflict(_) => Self::Input(error.to_string()),
            PlanError::OutsideLimits { .. } | PlanError::NotDetermined => Self::Failure(error.to_string()),
        }
    }
}

/// Runs the verb.
pub fn run(json: bool, args: &PlanArgs) -> Result<Outcome, CommandError> {
    let vehicle = read_vehicle(&args.vehicle)?.vehicle;
    let limits = args.limits.as_deref().map_or(Ok(vehicle.limits), read_limits)?;
    let mut request = request_of(args)?;
    let summary = if let Some(file) = &args.check {
        let stored = read_trajectory(file)?;
        request.repeats = stored.repeats;
        let worth = assess(&stored.series, &vehicle, &bounds_of(&limits, &vehicle), &request);
        summarize(&worth, request.criterion, None)
    } else {
        planned(&vehicle, &limits, &request, args.out.as_deref())?
    };
    if json {
        output::json(&summary)?;
    } else {
        output::text(&page(&summary))?;
    }
    Ok(if summary.first_violation.is_some() { Outcome::DoneWithLoss } else { Outcome::Done })
}

fn planned(
    vehicle: &Vehicle,
    limits: &Limits,
    request: &PlanRequest,
    out: Option<&Path>,
) -> Result<Summary, CommandError> {
    let bar = ProgressBar::new(search_of(request).work());
    if let Ok(style) = ProgressStyle::with_template("planning {bar:30} {pos}/{len} descents") {
        bar.set_style(style);
    }
    let result = plan(vehicle, limits, request, &|| bar.inc(1));
    bar.finish_and_clear();
    let plan = result?;
    let summary = summarize(&plan.assessment, request.criterion, Some(plan.criterion_value));
    if let Some(path) = out {
        store(path, plan.trajectory, (limits, request), &summary)?;
        output::message(&format!("wrote {}", path.display()));
    }
    Ok(summary)
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
    };
    std::fs::write(path, trajectory_to_toml(&stored)?)
        .map_err(|error| CommandError::Failure(format!("cannot write {}: {error}", path.display())))
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
