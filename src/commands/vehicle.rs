//! `mavid vehicle FILE`: checks a vehicle file and says what it means. `mavid vehicle init`: writes a first one.

use std::path::Path;

use mavid::config::read_vehicle;
use mavid::draft::{Draft, parameters_of};
use mavid::link::Address;
use mavid::report::vehicle_text;
use mavid::study::{
    check_given, draft_from_log, draft_from_parameters, draft_text, vehicle_summary, with_thrust_stand,
};
use mavid::text;
use mavid::vehicle::{Guess, Guessed};

use super::log::{Answered, parameters_of_vehicle};
use super::standard_error::StandardError;
use super::{CommandError, Outcome, output};
use crate::cli::{InitArgs, VehicleArgs, VehicleLinkArgs, VehicleVerb};

/// Runs the verb.
pub fn run(json: bool, stderr: &StandardError, args: &VehicleArgs) -> Result<Outcome, CommandError> {
    match (&args.verb, &args.file) {
        (Some(VehicleVerb::Init(init)), _) => draft(json, init),
        (Some(VehicleVerb::Load(load)), _) => super::load::run(json, stderr, load),
        (None, Some(file)) => check(json, file),
        (None, None) => Ok(Outcome::Done),
    }
}

fn check(json: bool, file: &Path) -> Result<Outcome, CommandError> {
    let summary = vehicle_summary(&read_vehicle(file)?);
    output::warnings(file, &summary.warnings);
    if json {
        output::json(&summary)?
    } else {
        output::text(&vehicle_text(&summary))?
    }
    Ok(Outcome::Done)
}

/// The vehicle's address, if the vehicle is to come from a link and not from a log.
fn link(args: &InitArgs) -> Option<VehicleLinkArgs> {
    let connect = args.from.to_str().filter(|_| !args.from.exists())?;
    connect.parse::<Address>().ok()?;
    let system_id = args.read.settings().system.map(|system| system.0);
    Some(VehicleLinkArgs { connect: connect.to_owned(), system_id, signing_key_file: None })
}

/// Writes a first vehicle file, and says what it means.
fn draft(json: bool, args: &InitArgs) -> Result<Outcome, CommandError> {
    let inputs: Vec<_> = [&args.from].into_iter().chain(&args.thrust_stand).collect();
    output::refuse_overwriting(&inputs, &[&args.out])?;
    output::refuse_replacing(&args.out, args.force)?;
    let given = args.shape.given(args.mass);
    check_given(&given)?;
    let mut draft = match link(args) {
        Some(link) => {
            let Answered { autopilot, parameters, .. } =
                parameters_of_vehicle(&link, |_, _| {}, |stack, known| parameters_of(stack, &given, known))?;
            draft_from_parameters((autopilot, parameters), &given, &link.connect)?
        }
        None => draft_from_log(&args.from, &args.read.settings(), &given)?,
    };
    if let Some(table) = &args.thrust_stand {
        draft = with_thrust_stand(draft, table)?;
    }
    write(args, &draft)?;
    guessed(&draft, args).iter().for_each(|guessed| output::message(guessed));
    check(json, &args.out)
}

/// What of a draft nobody measured, and where it stands; `None` where nothing is guessed.
fn guessed(draft: &Draft, args: &InitArgs) -> Option<String> {
    let one = |guess: &Guess| format!("{} +- {:.0} %", guess.of.words(), 100.0 * guess.relative);
    let all: Vec<String> = draft.vehicle.guesses.iter().map(one).collect();
    let size = draft.vehicle.guesses.iter().any(|guess| guess.of == Guessed::Arms);
    let size = if size { "; --size states the length of the arms" } else { "" };
    (!all.is_empty())
        .then(|| format!("guessed, not measured: {} (see {}){size}", all.join(", "), text::path(&args.out)))
}

/// Writes the draft, and says what contradicts it.
pub fn write(args: &InitArgs, draft: &Draft) -> Result<(), CommandError> {
    draft.doubts.iter().for_each(|doubt| output::warning(doubt));
    output::file(&args.out, &draft_text(draft)?)
}
