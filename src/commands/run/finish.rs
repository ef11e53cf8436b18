//! What a run leaves beside its report and its model: the appendix, and the model for simulators.

use std::path::PathBuf;

use mavid::report::identification_text;
use mavid::text;

use super::context::Context;
use super::step::Step;
use crate::commands::{export, identify, output};

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

/// The rigid body alone, into a folder of its own. That it cannot be had makes no run a failure.
pub fn rigid_body(context: &Context<'_>, logs: &[PathBuf]) {
    let folder = context.folder.of(RIGID_BODY);
    let step = logs.iter().fold(Step::of(&["identify"]), Step::word);
    let step = step.option("--vehicle", context.folder.vehicle()).option("--out", folder.join("model.toml"));
    let step = step.option("--report", folder.join("report.html"));
    let make = || {
        output::silent_folder(&folder)?;
        context.tell(&step);
        let (study, targets) = identify::make(context.stderr, &step.identify()?)?;
        output::file(&folder.join("identification.txt"), &format!("{}\n", identification_text(&study)))?;
        targets.write(&study)
    };
    if let Err(error) = make() {
        output::warning(&format!("the rigid body alone is not written: {error}"));
    }
}

/// The model for each simulator; the files. A simulator that cannot hold it is said.
pub fn exports(context: &Context<'_>) -> Vec<String> {
    let (folder, model) = (context.folder.of(EXPORT), context.folder.of("model.toml"));
    let mut files = Vec::new();
    for (format, name) in FORMATS {
        let file = folder.join(name);
        let step = Step::of(&["export"]).word(&model).option("--to", format).option("--out", &file);
        let make = || {
            output::silent_folder(&folder)?;
            context.tell(&step);
            export::make(&step.export()?).map(|_| ())
        };
        match make() {
            Ok(()) => files.push(text::path(&file)),
            Err(error) => output::warning(&format!("not exported to {format}: {error}")),
        }
    }
    if !files.is_empty() {
        output::message("run an export command alone to see what its simulator cannot represent");
    }
    files
}
