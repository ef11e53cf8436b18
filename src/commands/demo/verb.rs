//! The run of `mavid demo`: `mavid run --sitl --yes` with something concealed.

use std::path::{Path, PathBuf};

use mavid::config::parse_vehicle;
use mavid::study::effects_file;

use crate::cli::{DemoArgs, RunArgs, ShapeArgs};
use crate::commands::live::{self, Work};
use crate::commands::read_once::is_read_once;
use crate::commands::run::{CONCEALED, Recipe, kept, story};
use crate::commands::sitl::DEFAULT_VEHICLE;
use crate::commands::standard_error::StandardError;
use crate::commands::{CommandError, Outcome, leftover, output};

/// What is concealed where nothing else is asked for.
const EFFECTS: &str = include_str!("../../../configs/demo/concealed.toml");
/// The room, and how lively it is flown.
const LIMITS: &str = include_str!("../../../configs/demo/limits.toml");
/// The folder where none is given.
const FOLDER: &str = "mavid-demo";

/// Runs the verb.
pub fn run(json: bool, stderr: &StandardError, args: &DemoArgs) -> Result<Outcome, CommandError> {
    let (args, stderr) = (args.clone(), stderr.clone());
    live::run(move |work| run_demo((json, &stderr), &args, work))
}

fn run_demo(out: (bool, &StandardError), args: &DemoArgs, work: &Work) -> Result<Outcome, CommandError> {
    if let Some(file) = args.effects.as_ref().filter(|file| !is_read_once(file)) {
        // a file that cannot be used is told before the work
        let vehicle = parse_vehicle(DEFAULT_VEHICLE, "the vehicle within the program")?.vehicle;
        effects_file(file, &vehicle)?;
    }
    let folder = folder(args)?;
    output::file(&folder.join("limits.toml"), LIMITS)?;
    let effects = match &args.effects {
        Some(file) => kept(file, &folder)?,
        None => {
            let file = folder.join(CONCEALED);
            output::file(&file, EFFECTS)?;
            file
        }
    };
    output::message("a simulated X500 is flown by PX4; something about it is concealed");
    let run = RunArgs {
        connect: None,
        sitl: true,
        autopilot: None,
        effects: Some(effects),
        mass: None,
        shape: ShapeArgs::default(),
        vehicle: None,
        room: None,
        out: Some(folder),
        flights: Some(1),
        yes: true,
        arm: false,
        rehearse: false,
        set_logging: false,
        restart: false,
        tracking_max: None,
        system_id: None,
        plain: args.plain,
    };
    story(out, (&run, Recipe { is_demo: true }), work)
}

/// Creates the folder of the arguments, or the first that is free: no demo is taken up again.
fn folder(args: &DemoArgs) -> Result<PathBuf, CommandError> {
    let numbered = (2_u32..).map(|number| PathBuf::from(format!("{FOLDER}-{number}")));
    let free = || std::iter::once(PathBuf::from(FOLDER)).chain(numbered).find(|path| !path.exists());
    let folder = args.out.clone().or_else(free).unwrap_or_else(|| PathBuf::from(FOLDER));
    leftover::make_way(Path::new(&folder.join("flight1")), leftover::STATION)?;
    Ok(folder)
}
