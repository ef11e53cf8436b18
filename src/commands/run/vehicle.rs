//! The vehicle's file: the one that is there, a given one, or a draft from the vehicle's parameters.

use std::collections::{BTreeMap, BTreeSet};
use std::iter;
use std::path::{Path, PathBuf};

use mavid::autopilot::{Autopilot, Stack};
use mavid::config::read_vehicle;
use mavid::draft::{Draft, Given, parameters_of};
use mavid::files::write_whole;
use mavid::fly::PARAMETERS;
use mavid::fly::parameters::{Parameters, requested_parameters};
use mavid::study::{draft_from_parameters, implausible};
use mavid::text;
use mavid::vehicle::{Guessed, Vehicle};
use mavid::wire::SystemId;

use super::ask::number;
use super::context::Context;
use super::step::Step;
use super::target::Target;
use crate::commands::log::{Answered, PATIENCE, parameters_of_vehicle};
use crate::commands::progress::Spinner;
use crate::commands::sitl::DEFAULT_VEHICLE;
use crate::commands::{CommandError, output, vehicle};

/// Masses and sizes that are taken at a question.
const MASSES_KG: (f64, f64) = (0.01, 200.0);
const SIZES_M: (f64, f64) = (0.05, 5.0);
/// Rotors whose parameters are asked for: those that are not there do not answer.
const ROTORS: usize = 8;

/// Sees to it that `vehicle.toml` is in the folder, and reads it.
///
/// # Errors
/// The vehicle does not answer, or what it says does not suffice and nobody can be asked.
pub fn of_folder(context: &Context<'_>, target: &mut Target) -> Result<Vehicle, CommandError> {
    let path = context.folder.vehicle();
    let args = context.args;
    if path.exists() {
        output::message(&format!("vehicle: {}, which is there", text::path(&path)));
    } else if let Some(file) = &args.vehicle {
        read_vehicle(file)?;
        let text = std::fs::read(file);
        let copied = text.and_then(|text| write_whole(&path, &text));
        copied.map_err(|error| CommandError::Input(format!("cannot copy {}: {error}", text::path(file))))?;
        if target.embedded.is_none() {
            let mass_kg = read_vehicle(&path)?.vehicle.body.mass_kg;
            asked(context, target, &args.shape.given(mass_kg))?;
        }
    } else if target.embedded.is_some() && args.mass.is_none() {
        output::file(&path, DEFAULT_VEHICLE)?;
    } else {
        drafted(context, target, &path)?;
    }
    let loaded = read_vehicle(&path)?;
    output::warnings(&path, &loaded.warnings);
    Ok(loaded.vehicle)
}

/// Drafts the file from the vehicle's parameters; what they do not say is asked.
fn drafted(context: &Context<'_>, target: &mut Target, path: &Path) -> Result<(), CommandError> {
    let mass_kg = mass(context)?;
    let given = context.args.shape.given(mass_kg);
    let found = asked(context, target, &given)?;
    let draft_of = |given: &Given| {
        draft_from_parameters((found.autopilot, found.parameters.clone()), given, &target.connect)
            .map_err(CommandError::from)
    };
    let first = draft_of(&given)?;
    let size_m = match given.size_m {
        None if first.vehicle.guesses.iter().any(|guess| guess.of == Guessed::Arms) => size(context, &first)?,
        stated => stated,
    };
    let step = Step::of(&["vehicle", "init"])
        .option("--from", &target.connect)
        .option("--system-id", found.system.to_string())
        .option("--mass", mass_kg.to_string())
        .maybe("--size", size_m.map(|size_m| size_m.to_string()))
        .maybe("--frame", given.frame.map(mavid::autopilot::Frame::id))
        .option("--out", path);
    context.tell(&step);
    let init = step.init()?;
    let draft = draft_of(&init.shape.given(init.mass))?;
    vehicle::write(&init, &draft)?;
    output::message(&basis(&draft));
    doubtless(context, &draft, path)
}

/// The parameters of the vehicle, which are written into the folder. From now on it is the vehicle of the run.
pub fn asked(context: &Context<'_>, target: &mut Target, given: &Given) -> Result<Answered, CommandError> {
    let needed = |stack: &'static Stack, known: &BTreeMap<String, f64>| -> BTreeSet<String> {
        let of_flight =
            requested_parameters(stack.autopilot, ROTORS).into_iter().flat_map(|wanted| wanted.names);
        let rehearsed = context.args.rehearse.then_some(of_flight).into_iter().flatten();
        // a plan keeps to them
        let newer = |name| stack.parameters.renames_of(name).map(|renamed| renamed.new);
        let limits = stack.limits.iter().flat_map(|(_, name)| iter::once(*name).chain(newer(name)));
        let limits = limits.map(str::to_owned);
        parameters_of(stack, given, known).into_iter().chain(rehearsed).chain(limits).collect()
    };
    let link = target.link();
    context.work.ends_itself();
    let waiting = format!("waiting at most {} s for a vehicle at {}", PATIENCE.as_secs(), target.connect);
    output::message(&waiting);
    let shown = Spinner::of(context.stderr, waiting);
    let heard = |system: SystemId, autopilot: Autopilot| {
        let name = autopilot.stack().map_or("an unknown autopilot", |stack| stack.name);
        let connect = &target.connect;
        output::message(&format!("found system {}, {name}, at {connect}; reading its parameters", system.0));
        shown.say("reading its parameters");
    };
    let found = parameters_of_vehicle(&link, heard, |stack, known| {
        stack.autopilot.stack().map_or_else(BTreeSet::new, |stack| needed(stack, known))
    })?;
    drop(shown);
    context.work.waits();
    target.system = Some(found.system);
    let all =
        Parameters { autopilot: found.autopilot, values: found.parameters.clone(), ..Parameters::default() };
    let text = all.to_toml().map_err(|error| CommandError::Failure(error.to_string()))?;
    output::file(&context.folder.parameters(), &text)?;
    Ok(found)
}

/// The autopilot of the parameters in the folder.
pub fn autopilot(context: &Context<'_>) -> Option<Autopilot> {
    autopilot_of(&context.folder.parameters())
}

/// The same; where the vehicle's file was given, that of the parameters beside a flight's log.
pub fn autopilot_flown(context: &Context<'_>, logs: &[PathBuf]) -> Option<Autopilot> {
    let beside = |log: &PathBuf| autopilot_of(&log.with_file_name(PARAMETERS));
    autopilot(context).or_else(|| logs.iter().find_map(beside))
}

pub(super) fn autopilot_of(path: &Path) -> Option<Autopilot> {
    let text = std::fs::read_to_string(path).ok()?;
    Parameters::from_toml(&text, PARAMETERS).ok().map(|parameters| parameters.autopilot)
}

fn mass(context: &Context<'_>) -> Result<f64, CommandError> {
    let missing = || {
        CommandError::Input(
            "--mass: expected the mass with battery and payload in kg, got none: weigh the vehicle"
                .to_owned(),
        )
    };
    match context.args.mass {
        Some(mass_kg) => Ok(mass_kg),
        None => {
            let parse = |text: &str| number(text, "kg", MASSES_KG);
            let question = "Mass with battery and payload, in kg? (weigh it; no default)";
            context.ask.value((question, " with --mass"), parse, || Err(missing()))?.ok_or_else(missing)
        }
    }
}

/// The size, where the vehicle states no lengths; `None` leaves the guess.
fn size(context: &Context<'_>, draft: &Draft) -> Result<Option<f64>, CommandError> {
    let usual_m = (200.0 * draft.vehicle.size().arm_m).round() / 100.0;
    let question = format!(
        "Distance from motor to motor across the centre, in m? The vehicle states no lengths [{usual_m}: usual for its mass]"
    );
    let alone = || {
        Err(CommandError::Input(format!(
            "--size: expected the distance from motor to motor across the centre in m, got none: the vehicle states no \
             lengths ({usual_m} m is usual for its mass)"
        )))
    };
    context.ask.value((&question, " with --size"), |text| number(text, "m", SIZES_M), alone)
}

/// One line on what the file rests on.
fn basis(draft: &Draft) -> String {
    let guesses: Vec<&str> = draft.vehicle.guesses.iter().map(|guess| guess.of.words()).collect();
    let rests = if guesses.is_empty() { String::new() } else { format!("; guessed: {}", guesses.join(", ")) };
    format!("{} rotors, {} kg{rests}", draft.vehicle.rotors.len(), draft.vehicle.body.mass_kg)
}

/// A vehicle that contradicts itself is flown only where a person agrees.
fn doubtless(context: &Context<'_>, draft: &Draft, path: &Path) -> Result<(), CommandError> {
    let implausible = implausible(draft);
    if implausible.is_empty() && draft.doubts.is_empty() {
        return Ok(());
    }
    output::warnings(path, &implausible);
    if context.ask.agreed("The vehicle is doubtful, see above. Use it as it is?", false)? {
        return Ok(());
    }
    let why =
        draft.doubts.iter().map(String::as_str).chain(implausible.iter().map(|note| note.text.as_str()));
    let why = why.collect::<Vec<_>>().join("; ");
    let kept = format!("{}.doubtful", text::path(path));
    // the next run begins with what is stated anew
    let moved = std::fs::rename(path, &kept);
    moved.map_err(|error| CommandError::Failure(format!("cannot rename {}: {error}", text::path(path))))?;
    Err(CommandError::Input(format!(
        "the vehicle is doubtful: {why}. State mass and size anew, or correct {kept} and give it with --vehicle"
    )))
}
