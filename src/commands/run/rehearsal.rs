//! The whole of a flight on the embedded twin of the vehicle, before anything is ordered from the vehicle itself.

use std::path::Path;

use mavid::plan::{Extremes, Reach};
use mavid::report::explanation_answer;
use mavid::text;
use mavid::vehicle::Vehicle;

use super::context::Context;
use super::embedded::Embedded;
use super::explained;
use super::flying::{fly, step_of};
use super::follows::course;
use super::logging::Logging;
use super::phases::{durations, phases};
use super::step::Step;
use super::target::{Target, WARM_UP_S};
use super::vehicle::{asked, autopilot};
use crate::commands::columns::columns;
use crate::commands::{CommandError, leftover, output};

/// Flies the trajectory with the twin, and says how it went and what would be learnt.
///
/// # Errors
/// The twin cannot fly it: neither could the vehicle.
pub fn rehearse(context: &Context<'_>, vehicle: &Vehicle, trajectory: &Path) -> Result<(), CommandError> {
    let folder = &context.folder;
    let stack = autopilot(context).and_then(mavid::autopilot::Autopilot::stack);
    let stack = stack.ok_or_else(|| {
        let name = text::path(&folder.parameters());
        CommandError::Input(format!("--rehearse: expected the autopilot's parameters in {name}, got none"))
    })?;
    let step = Step::of(&["sitl"])
        .option("--vehicle", folder.vehicle())
        .option("--autopilot", stack.id)
        .option("--parameters", folder.parameters())
        .option("--warm-up", WARM_UP_S)
        .word("--esc-telemetry")
        .word("--transmitter");
    let (embedded, step) = Embedded::start(&step)?;
    context.tell(&step);
    let twin = Target { connect: embedded.address(), system: None, embedded: Some(embedded), is_twin: true };
    let out = free(context)?;
    let step = step_of(context, &twin, (trajectory, &out), Logging::Left);
    let flown = fly(context, &twin, &step);
    twin.embedded.into_iter().for_each(Embedded::stop);
    let flight = flown.map_err(|error| {
        let kept = format!("its recording is in {}", text::path(&out));
        failed(error, &kept)
    })?;
    let flown = &flight.record.outcome.flown;
    output::message(&format!(
        "rehearsed: {} periods; at most {:.2} m off the trajectory (the flight is aborted at {} m), {:.1} degrees of tilt where \
         {:.1} were planned",
        flown.periods,
        flown.tracking_max_m,
        context.args.tracking_max.unwrap_or(1.0),
        flown.tilt_max_deg,
        flown.tilt_planned_deg
    ));
    durations(&phases(&out)).iter().for_each(|took| output::message(took));
    output::message(&reserve(context, vehicle, trajectory, flown.tracking_max_m)?);
    if !flight.record.outcome.is_whole() {
        let cause = flight.record.outcome.cause.as_ref().map_or_else(String::new, ToString::to_string);
        let why =
            format!("the rehearsal on the embedded twin was ended early: {cause}; the vehicle is not flown");
        let is_interrupted = flight.record.outcome.is_interrupted();
        return Err(if is_interrupted { CommandError::Ended(why) } else { CommandError::Failure(why) });
    }
    let study = explained::alone(context, &flight.recorded.radio, &out)?;
    let would = format!(
        "of a vehicle that is as its file says, the flight would say: {}",
        explanation_answer(&study)
    );
    text::wrapped(&would, columns()).iter().for_each(|line| output::message(line));
    Ok(())
}

/// Why there was no rehearsal: somebody ended it, or the twin cannot fly.
fn failed(error: CommandError, kept: &str) -> CommandError {
    match error {
        CommandError::Ended(why) => {
            CommandError::Ended(format!("the rehearsal on the embedded twin: {why}; {kept}"))
        }
        error => CommandError::Failure(format!("the rehearsal on the embedded twin failed: {error}; {kept}")),
    }
}

/// What is left of the room when the vehicle was so far off its trajectory: to the next wall, and to ceiling and floor, m.
fn reserve(
    context: &Context<'_>,
    vehicle: &Vehicle,
    trajectory: &Path,
    off_m: f64,
) -> Result<String, CommandError> {
    let (course, limits) = course(context, vehicle, trajectory)?;
    let (extremes, reach) = (Extremes::of(course.path(), vehicle), Reach::of(vehicle));
    let side = |wall: Option<f64>, axis: usize| {
        wall.map(|wall_m| wall_m - extremes.high_m[axis].max(-extremes.low_m[axis]) - reach.side_m - off_m)
    };
    let wall_m = [side(limits.x_max_m, 0), side(limits.y_max_m, 1)].into_iter().flatten();
    let above_m = limits.z_max_m.map(|ceiling_m| ceiling_m - extremes.high_m[2] - reach.up_m - off_m);
    Ok(format!(
        "that far off the trajectory the rotors have {:.2} m left to a wall and {:.2} m to the ceiling, and the vehicle is {:.2} m \
         above the ground at least",
        wall_m.fold(f64::INFINITY, f64::min),
        above_m.unwrap_or(f64::INFINITY),
        extremes.low_m[2] - off_m
    ))
}

/// Asks the vehicle for the parameters that its twin flies by, unless it was asked for them before.
///
/// # Errors
/// It does not answer.
pub fn prepare(context: &Context<'_>, target: &mut Target, mass_kg: f64) -> Result<(), CommandError> {
    if target.system.is_some() && context.folder.parameters().exists() {
        return Ok(());
    }
    asked(context, target, &context.args.shape.given(mass_kg)).map(|_| ())
}

/// A folder for the rehearsal: an earlier one stays.
fn free(context: &Context<'_>) -> Result<std::path::PathBuf, CommandError> {
    let names = (2_u32..).map(|number| format!("rehearsal{number}"));
    let mut folders =
        std::iter::once("rehearsal".to_owned()).chain(names).map(|name| context.folder.of(&name));
    let folder = folders.find(|folder| leftover::is_free(folder, leftover::STATION));
    let folder = folder.unwrap_or_else(|| context.folder.of("rehearsal"));
    output::silent_folder(&folder)?;
    Ok(folder)
}
