//! What a run leaves beside its report and its model: the appendix, and the model for simulators and for the aircraft itself.

use std::path::PathBuf;

use mavid::autopilot::Autopilot;
use mavid::report::identification_text;
use mavid::text;
use mavid::wire::SystemId;

use super::altitude::home_m;
use super::context::Context;
use super::step::Step;
use crate::commands::export::NotMade;
use crate::commands::{CommandError, export, identify, output};

/// Folder of the appendix: the rigid body alone, without effects.
const RIGID_BODY: &str = "rigid_body";
/// Folder of the model for simulators.
const EXPORT: &str = "export";

/// The simulator, and its file.
const FORMATS: [(&str, &str); 5] = [
    ("px4-sih", "px4-sih.params"),
    ("ardupilot-sitl", "ardupilot-sitl.json"),
    ("sdf", "model.sdf"),
    ("mjcf", "model.xml"),
    ("rotorpy", "rotorpy.py"),
];

/// The aircraft's own parameters, and their file; of the autopilots that have such a format.
fn aircraft_format(autopilot: Autopilot) -> Option<(&'static str, &'static str)> {
    match autopilot {
        Autopilot::Px4 => Some(("px4-params", "px4-aircraft.params")),
        Autopilot::ArduPilot => Some(("ardupilot-params", "ardupilot-aircraft.param")),
        Autopilot::Other | Autopilot::Unknown => None,
    }
}

/// The rigid body alone, into a folder of its own. That it cannot be had makes no run a failure.
pub fn rigid_body(context: &Context<'_>, logs: &[PathBuf]) {
    let folder = context.folder.of(RIGID_BODY);
    let step = logs.iter().fold(Step::of(&["identify"]), Step::word);
    let step = step.option("--vehicle", context.folder.vehicle()).option("--out", folder.join("model.toml"));
    let step = step.option("--report", folder.join("report.html"));
    let make = || {
        output::silent_folder(&folder)?;
        context.tell(&step);
        if !context.is_brief() {
            output::message(
                "for the appendix effects are searched once more, beside the rigid body and on the whole flight",
            );
        }
        let (study, targets) = identify::make(context.stderr, &step.identify()?)?;
        output::file(&folder.join("identification.txt"), &format!("{}\n", identification_text(&study)))?;
        targets.write(&study)
    };
    if let Err(error) = make() {
        output::warning(&format!("the rigid body alone is not written: {error}"));
    }
}

/// The model for each simulator; the files. A simulator that cannot hold it is said; what a model of such a vehicle file never
/// holds is no warning.
pub fn exports(context: &Context<'_>) -> Vec<String> {
    let mut files = Vec::new();
    let mut missing: Vec<(&str, Vec<&str>)> = Vec::new();
    for format in FORMATS {
        match exported(context, format, None) {
            Ok(file) => files.push(file),
            Err(NotMade::Missing { what, .. }) => {
                match missing.iter_mut().find(|(other, _)| *other == what) {
                    Some((_, formats)) => formats.push(format.0),
                    None => missing.push((what, vec![format.0])),
                }
            }
            Err(NotMade::Failed(error)) => {
                output::warning(&format!("not exported to {}: {error}", format.0));
            }
        }
    }
    for (what, formats) in missing {
        let formats = formats.join(" and ");
        output::message(&format!("no file for {formats}: the vehicle file does not state {what}"));
    }
    if !files.is_empty() {
        output::message("run an export command alone to see what its simulator cannot represent");
    }
    files
}

/// What follows from the model for the aircraft's own autopilot, in the air of the last flight; the file. That nothing does is
/// said, and for which air it is.
pub fn aircraft(
    context: &Context<'_>,
    autopilot: Option<Autopilot>,
    system: Option<SystemId>,
) -> Option<String> {
    let format = autopilot.and_then(aircraft_format)?;
    // the embedded vehicle's air is that at sea level, wherever its home is
    let is_real = !context.args.sitl;
    let last = context.folder.flights().pop().filter(|_| is_real);
    let altitude_m = last.and_then(|flight| home_m(&flight.radio, system));
    let made = exported(context, format, altitude_m);
    let said =
        |error| output::message(&format!("no parameters for the aircraft: {}", CommandError::from(error)));
    let file = made.map_err(said).ok()?;
    if is_real {
        output::message(&air_words(altitude_m));
    }
    Some(file)
}

/// For which air the parameters of the aircraft are.
fn air_words(altitude_m: Option<f64>) -> String {
    match altitude_m {
        Some(altitude_m) => format!(
            "the aircraft's parameters are for the air at {altitude_m:.0} m above the sea, where its home was in the recording"
        ),
        None => "the aircraft's parameters are for the air at sea level: the recording does not say how high home was. Repeat the \
                 last command with --altitude"
            .to_owned(),
    }
}

/// Writes the model in a format, into a file of this name; `altitude_m` is for parameters of an aircraft alone.
fn exported(
    context: &Context<'_>,
    (format, name): (&str, &str),
    altitude_m: Option<f64>,
) -> Result<String, NotMade> {
    let (folder, model) = (context.folder.of(EXPORT), context.folder.of("model.toml"));
    let file = folder.join(name);
    let step = Step::of(&["export"])
        .word(&model)
        .option("--to", format)
        .maybe("--altitude", altitude_m.map(|altitude_m| format!("{altitude_m:.0}")))
        .option("--out", &file);
    output::silent_folder(&folder)?;
    context.tell(&step);
    export::make(&step.export()?)?;
    Ok(text::path(&file))
}
