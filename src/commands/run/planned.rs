//! The trajectories of a run: the first, and each next one with its ways from takeoff and to landing.

use std::path::{Path, PathBuf};

use mavid::config::read_limits;
use mavid::plan::Extremes;
use mavid::report::EXPECTED_ERRORS;
use mavid::study::PlanStudy;
use mavid::text;
use mavid::vehicle::Vehicle;

use super::context::Context;
use super::follows;
use super::room;
use super::step::Step;
use crate::commands::{CommandError, output, plan};

/// The demo's flight is short.
const SHORT: [&str; 6] = ["--period", "6", "--repeats", "4", "--starts", "8"];

/// A trajectory is made calmer at most so often until the autopilot follows it.
const CALMER: u32 = 4;

/// Products of inertia are near zero: their relative errors say nothing.
const PRODUCTS: [&str; 3] = ["ixy", "ixz", "iyz"];

/// The trajectory of the first flight: the one that is there, or a new one.
///
/// # Errors
/// No trajectory keeps the room.
pub fn first(context: &Context<'_>, vehicle: &Vehicle) -> Result<PathBuf, CommandError> {
    let path = context.folder.plan(1);
    if path.exists() {
        inside(context, vehicle, &path)?;
        output::message(&format!("trajectory: {}, which is there", text::path(&path)));
        return Ok(path);
    }
    let step = begun(context, vehicle)?.option("--criterion", "d-opt");
    let step = if context.recipe.is_demo { SHORT.iter().fold(step, Step::word) } else { step };
    let step = step.option("--out", &path);
    let mut study = made(context, step.clone(), &path)?;
    for time in 0..CALMER {
        let shortfalls = follows::calmed(context, vehicle, &path)?;
        if shortfalls.is_empty() {
            break;
        }
        if time == 0 {
            output::warning(&follows::words(&shortfalls));
        }
        study = made(context, step.clone(), &path)?;
    }
    let flight_s = study.series.period_s * f64::from(study.repeats);
    let shown = |(name, _): &&(&str, f64)| !PRODUCTS.contains(name);
    let one = |(name, relative): &(&str, f64)| format!("{name} {:.2} %", 100.0 * relative);
    let whole = study.hover_to_hover_s().map_or_else(String::new, |whole_s| {
        format!(": {whole_s:.0} s from hover to hover, and takeoff and landing beside it")
    });
    output::message(&format!("{flight_s:.0} s of trajectory inside the room{whole}"));
    if let Some(errors) = study.standard_errors() {
        let all: Vec<String> = errors.iter().filter(shown).map(one).collect();
        output::message(&format!("standard errors {EXPECTED_ERRORS}: {}", all.join(", ")));
    }
    Ok(path)
}

/// A trajectory that is there keeps the room of the folder.
fn inside(context: &Context<'_>, vehicle: &Vehicle, path: &Path) -> Result<(), CommandError> {
    let (course, limits) = follows::course(context, vehicle, path)?;
    room::holds(&limits, &Extremes::of(course.path(), vehicle), vehicle).map_err(|why| {
        let (plan, limits) = (text::path(path), text::path(&context.folder.limits()));
        CommandError::Input(format!(
            "{plan}: expected a trajectory inside the room of {limits}, got a wider one ({why}): remove {plan}, so that one is \
             planned for this room"
        ))
    })
}

/// The trajectory of a further flight, from the one that `explain --next` designed.
///
/// # Errors
/// It does not keep the room with its ways.
pub fn further(context: &Context<'_>, vehicle: &Vehicle, number: usize) -> Result<PathBuf, CommandError> {
    let path = context.folder.plan(number);
    let step = begun(context, vehicle)?.option("--check", context.folder.next()).option("--out", &path);
    made(context, step, &path)?;
    Ok(path)
}

/// What both have in common: the vehicle stands in the middle of the room.
fn begun(context: &Context<'_>, vehicle: &Vehicle) -> Result<Step, CommandError> {
    let limits = context.folder.limits();
    let hover_m = room::hover_m(&read_limits(&limits)?, vehicle);
    Ok(Step::of(&["plan"])
        .word(context.folder.vehicle())
        .option("--limits", limits)
        .option("--takeoff", format!("0,0,{hover_m}")))
}

fn made(context: &Context<'_>, step: Step, path: &Path) -> Result<PlanStudy, CommandError> {
    context.tell(&step);
    let study = plan::make(context.stderr, &step.plan()?).map_err(|error| match error {
        CommandError::Failure(why) => CommandError::Failure(format!(
            "{why}: state a larger room (remove {} first)",
            text::path(&context.folder.limits())
        )),
        other => other,
    })?;
    if let Some(violation) = &study.first_violation {
        // it would be taken for a plan that is there
        output::outdated(path)?;
        let limits = text::path(&context.folder.limits());
        return Err(CommandError::Failure(format!(
            "no trajectory with its ways keeps the room of {limits}: {violation}; state a larger one (remove the file first)"
        )));
    }
    Ok(study)
}
