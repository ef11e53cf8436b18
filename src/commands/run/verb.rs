//! The run of `mavid run`, from the arguments to the answer.

use std::path::PathBuf;
use std::time::Instant;

use mavid::config::{parse_vehicle, read_vehicle};
use mavid::fly::Record;
use mavid::fly::view::TWIN;
use mavid::link::Address;
use mavid::study::{ExplainStudy, check_given};
use mavid::vehicle::Vehicle;

use super::ask::Ask;
use super::concealed::{acting, compare, kept, table};
use super::context::{Context, Recipe};
use super::embedded::Embedded;
use super::explained::{Explained, answer, explained};
use super::folder::{Folder, Recorded};
use super::logging::{self, Logging};
use super::page::{Document, Made, places};
use super::same_vehicle::same_vehicle;
use super::target::Target;
use super::{finish, flying, planned, rehearsal, room, taken_up, vehicle};
use crate::cli::RunArgs;
use crate::commands::fly::{TRACKING_MOST_M, within};
use crate::commands::live::{self, Work};
use crate::commands::read_once::{is_read_once, keep};
use crate::commands::sitl::DEFAULT_VEHICLE;
use crate::commands::standard_error::StandardError;
use crate::commands::{CommandError, Outcome, explain, fly, output};

/// The folder where none is given.
const FOLDER: &str = "mavid-run";
/// The file of `--vehicle` in the folder of a run, where it came through a pipe.
const GIVEN: &str = "given_vehicle.toml";

/// Runs the verb.
pub fn run(json: bool, stderr: &StandardError, args: &RunArgs) -> Result<Outcome, CommandError> {
    let (args, stderr) = (args.clone(), stderr.clone());
    live::run(move |work| story((json, &stderr), (&args, Recipe::default()), work))
}

/// Does it, step by step.
///
/// # Errors
/// A step failed, or a doubt needs a person.
pub fn story(
    (json, stderr): (bool, &StandardError),
    (args, recipe): (&RunArgs, Recipe),
    work: &Work,
) -> Result<Outcome, CommandError> {
    let since = Instant::now();
    let args = &with_kept(args)?;
    checked(args)?;
    let ask = Ask::new(args.yes)?;
    let folder = folder_of(args)?;
    let context = Context::new((args, recipe), (folder, ask), (stderr, work));
    work.continues_by(context.again());
    let flown = all_flights(&context).inspect_err(|_| context.tell_kept())?;
    let FlownFlights { explained: Explained { study, logs }, record, flights, is_told } = &flown;
    // the verdict is written: only now is it read what was concealed
    let concealed = match &args.effects {
        Some(file) => compare(&acting(file, &flying_vehicle(args)?)?, &study.effects),
        None => Vec::new(),
    };
    if !json {
        // before all that is made of it, which takes a while
        let answer = (!is_told).then(|| answer(study));
        let shown = (!concealed.is_empty()).then(|| table(&concealed, study.vehicle()));
        tell_first(&context, &[answer, shown].into_iter().flatten().collect::<Vec<_>>())?;
    }
    context.stage("Model and report");
    finish::rigid_body(&context, logs);
    let exports = finish::exports(&context);
    let system = record.as_ref().and_then(|record| record.system);
    let parameters = finish::aircraft(&context, vehicle::autopilot_flown(&context, logs), system);
    let took_s = since.elapsed().as_secs_f64();
    let made =
        Made { study, record: record.as_ref(), flights: *flights, exports, parameters, concealed, took_s };
    if json {
        output::json(&Document::new(&context, made))?;
    } else {
        // on a terminal the steps of the last stage stand below the answer
        let again = (output::is_one_terminal() && !context.is_brief()).then(|| answer(study));
        let parts = [again, Some(places(&context, &made))];
        output::text(&format!("\n{}", parts.into_iter().flatten().collect::<Vec<_>>().join("\n\n")))?;
    }
    match record {
        Some(record) => fly::outcome(record, Some(Ok(explain::outcome(study)))),
        None => Ok(explain::outcome(study)),
    }
}

/// Says the answer, and what was concealed beside it, with a line free before and after.
fn tell_first(context: &Context<'_>, parts: &[String]) -> Result<(), CommandError> {
    if parts.is_empty() {
        return Ok(());
    }
    output::message("");
    output::text(&parts.join("\n\n"))?;
    if context.is_brief() {
        // elsewhere the next heading has one before it
        output::message("");
    }
    Ok(())
}

fn folder_of(args: &RunArgs) -> Result<Folder, CommandError> {
    Folder::at(args.out.clone().unwrap_or_else(|| PathBuf::from(FOLDER)))
}

/// The arguments with files of the folder in the place of what can be read once only.
fn with_kept(args: &RunArgs) -> Result<RunArgs, CommandError> {
    let mut kept_args = args.clone();
    if let Some(file) = args.effects.as_ref().filter(|file| is_read_once(file)) {
        kept_args.effects = Some(kept(file, folder_of(args)?.path())?);
    }
    if let Some(file) = args.vehicle.as_ref().filter(|file| is_read_once(file)) {
        let given = folder_of(args)?.of(GIVEN);
        keep(file, &given)?;
        kept_args.vehicle = Some(given);
    }
    Ok(kept_args)
}

/// What can be told before anybody is spoken to.
fn checked(args: &RunArgs) -> Result<(), CommandError> {
    let sides_m = args.room.as_deref().map(room::sides).transpose();
    let sides_m = sides_m.map_err(|why| CommandError::Input(format!("--room: expected {why}")))?;
    if let Some(mass_kg) = args.mass {
        check_given(&args.shape.given(mass_kg))?;
    }
    within(("--tracking-max", args.tracking_max, TRACKING_MOST_M))?;
    if let Some(Err(error)) = args.connect.as_deref().map(str::parse::<Address>) {
        return Err(CommandError::Input(format!("--connect: {error}")));
    }
    if let Some(file) = &args.effects {
        acting(file, &flying_vehicle(args)?)?;
    }
    if let (Some(file), Some(sides_m)) = (&args.vehicle, sides_m) {
        room::fits(sides_m, &read_vehicle(file)?.vehicle)?;
    } else if let Some(file) = &args.vehicle {
        read_vehicle(file)?;
    }
    Ok(())
}

/// The embedded vehicle as it is described.
fn flying_vehicle(args: &RunArgs) -> Result<Vehicle, CommandError> {
    Ok(match &args.vehicle {
        Some(file) => read_vehicle(file)?.vehicle,
        None => parse_vehicle(DEFAULT_VEHICLE, "the vehicle within the program")?.vehicle,
    })
}

/// All flights, explained.
struct FlownFlights {
    explained: Explained,
    /// of the last flight, where one was flown now
    record: Option<Record>,
    flights: usize,
    /// the answer stands on the terminal already, above the question whether to fly on
    is_told: bool,
}

/// Flies until a further flight would bring nothing that is needed, or nobody wants one.
fn all_flights(context: &Context<'_>) -> Result<FlownFlights, CommandError> {
    context.stage("Vehicle");
    same_vehicle(&context.folder, context.args)?;
    room::same_room(&context.folder, context.args.room.as_deref())?;
    taken_up::take_up(context)?;
    let flights = context.folder.flights();
    let is_over = flights.len() >= context.flights_max();
    let mut target = if is_over { None } else { Some(Target::of(context)?) };
    let vehicle = match &mut target {
        Some(target) => vehicle::of_folder(context, target)?,
        None => read_vehicle(&context.folder.vehicle())?.vehicle,
    };
    let is_simulated = context.args.sitl;
    context.stage("Room and trajectory");
    room::of_folder((&context.folder, context.ask), context.args.room.as_deref(), &vehicle, is_simulated)?;
    let mut logging = None;
    let flown = fly_all(context, &vehicle, (target.as_mut(), &mut logging), flights);
    if let (Some(Logging::UntilTheEnd), Some(target)) = (logging, &target) {
        logging::put_back(context, target);
    }
    target.and_then(|target| target.embedded).into_iter().for_each(Embedded::stop);
    flown
}

/// Flies and explains, until that is enough.
fn fly_all(
    context: &Context<'_>,
    vehicle: &Vehicle,
    (mut target, logging): (Option<&mut Target>, &mut Option<Logging>),
    mut flights: Vec<Recorded>,
) -> Result<FlownFlights, CommandError> {
    let mut record = None;
    let mut done = None;
    let mut is_told;
    if flights.is_empty() {
        let trajectory = planned::first(context, vehicle)?;
        let Some(target) = target.as_deref_mut() else { return Err(nothing_flown()) };
        if context.args.rehearse {
            context.stage(&format!("Rehearsal with {TWIN}"));
            rehearsal::prepare(context, target, vehicle.body.mass_kg)?;
            rehearsal::rehearse(context, vehicle, &trajectory)?;
        }
        record = Some(fly_one(context, target, (&trajectory, logging), &mut flights)?);
    }
    loop {
        context.stage(if flights.len() == 1 { "Explanation" } else { "Explanation of all flights together" });
        let study = &done.insert(explained(context, &flights, record.as_ref())?).study;
        is_told = false;
        let goes_on = record.as_ref().is_none_or(|record: &Record| record.outcome.is_whole());
        let Some(target) = target.as_deref().filter(|_| goes_on && flights.len() < context.flights_max())
        else {
            break;
        };
        if !study.would_gain() {
            break;
        }
        is_told = output::is_one_terminal() && !context.stderr.is_quiet();
        if !wants_next_flight(context, study)? {
            break;
        }
        context.stage("Next flight");
        let trajectory = planned::further(context, vehicle, flights.len() + 1)?;
        record = Some(fly_one(context, target, (&trajectory, logging), &mut flights)?);
    }
    Ok(FlownFlights { explained: done.ok_or_else(nothing_flown)?, record, flights: flights.len(), is_told })
}

fn nothing_flown() -> CommandError {
    CommandError::Input("--flights: expected a flight, or one in the folder, got none".to_owned())
}

/// Whether a further flight is wanted.
fn wants_next_flight(context: &Context<'_>, study: &ExplainStudy) -> Result<bool, CommandError> {
    answer(study).lines().for_each(output::message);
    context.ask.agreed("Fly it?", true)
}

/// One flight, which joins the others.
fn fly_one(
    context: &Context<'_>,
    target: &Target,
    (trajectory, logging): (&std::path::Path, &mut Option<Logging>),
    flights: &mut Vec<Recorded>,
) -> Result<Record, CommandError> {
    context.stage("Flight");
    let logging = match *logging {
        Some(known) => known,
        None => *logging.insert(logging::decided(context, target)?),
    };
    let out = context.folder.new_flight();
    let step = flying::step_of(context, target, (trajectory, &out), logging);
    let flight = flying::fly(context, target, &step)?;
    flights.push(flight.recorded);
    Ok(flight.record)
}
