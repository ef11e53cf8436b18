//! `mavid export MODEL --to FORMAT`: the model for another simulator, or for the aircraft's own autopilot.

use std::iter;
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

use mavid::autopilot::Autopilot;
use mavid::config::effects_of;
use mavid::export::{
    AircraftParameter, AircraftParameters, EffectsProgram, ExportError, Exported, Format,
    aircraft_parameters, export,
};
use mavid::note::Note;
use mavid::text;
use serde::Serialize;

use super::{CommandError, Outcome, output};
use crate::cli::{ExportArgs, ExportFormat};

/// Heights above the sea at which multirotors fly, m.
pub const ALTITUDES_M: RangeInclusive<f64> = -500.0..=9000.0;

#[derive(Debug, Serialize)]
struct Document {
    schema: u32,
    file: Option<String>,
    text: String,
    /// a program in Python that does what the file cannot hold
    #[serde(skip_serializing_if = "Option::is_none")]
    callback: Option<String>,
    /// of the aircraft's autopilot; none for a simulator
    #[serde(skip_serializing_if = "Vec::is_empty")]
    parameters: Vec<ParameterLine>,
    left_out: Vec<String>,
}

#[derive(Debug, Serialize)]
struct ParameterLine {
    name: String,
    value: f64,
    std: Option<f64>,
    unit: &'static str,
    why: String,
}

impl From<AircraftParameter> for ParameterLine {
    fn from(parameter: AircraftParameter) -> Self {
        let AircraftParameter { name, value, std, unit, why, .. } = parameter;
        Self { name, value, std, unit, why }
    }
}

/// What the format stands for.
enum Target {
    Simulator(Format),
    Aircraft(Autopilot),
}

impl From<ExportFormat> for Target {
    fn from(to: ExportFormat) -> Self {
        match to {
            ExportFormat::Px4Sih => Self::Simulator(Format::Px4Sih),
            ExportFormat::ArdupilotSitl => Self::Simulator(Format::ArdupilotSitl),
            ExportFormat::Sdf => Self::Simulator(Format::Sdf),
            ExportFormat::Mjcf => Self::Simulator(Format::Mjcf),
            ExportFormat::Rotorpy => Self::Simulator(Format::Rotorpy),
            ExportFormat::Px4Params => Self::Aircraft(Autopilot::Px4),
            ExportFormat::ArdupilotParams => Self::Aircraft(Autopilot::ArduPilot),
        }
    }
}

/// What the model's file is called where none is asked for.
const UNNAMED: &str = "model.xml";

/// The program's file beside that of the model.
fn callback_of(path: &Path) -> PathBuf {
    path.with_file_name(EffectsProgram::file_name(path))
}

/// Whether there is a program beside the model's file that an earlier export of this file wrote.
fn has_earlier(path: &Path) -> bool {
    let text = std::fs::read_to_string(callback_of(path));
    text.is_ok_and(|text| EffectsProgram::is_of(&text, path))
}

/// Refuses to write the program over what is not this file's: two models whose files differ in their ending only have one name for it.
fn refuse_other_program(path: &Path) -> Result<(), CommandError> {
    let beside = callback_of(path);
    if !beside.exists() || has_earlier(path) {
        return Ok(());
    }
    Err(CommandError::Input(format!(
        "--out: the program that makes the effects of {} is written to {}; expected that this file is not there, or is the program of an \
         earlier export to the same file. It is neither: give --out another name",
        text::path(&path),
        text::path(&beside)
    )))
}

/// Runs the verb.
pub fn run(json: bool, args: &ExportArgs) -> Result<Outcome, CommandError> {
    let Made { text, left_out, callback, outdated, parameters, origin, warnings } = make(args)?;
    output::warnings(&origin, &warnings);
    left_out.iter().for_each(|note| output::message(&format!("note: {note}")));
    outdated.iter().for_each(|told| output::message(told));
    match (&args.out, &callback) {
        (Some(path), Some(_)) => {
            output::message(&format!("wrote {}, which makes the effects", text::path(&callback_of(path))));
        }
        (None, Some(_)) if !json => {
            output::message("--out FILE writes the program that makes the effects beside the file");
        }
        _ => {}
    }
    if json {
        let file = args.out.as_ref().map(|path| text::path(&path));
        output::json(&Document { schema: 1, file, text, callback, parameters, left_out })?;
    } else if args.out.is_none() {
        output::file_text(text.trim_end())?;
    }
    Ok(Outcome::Done)
}

/// A model that was exported.
#[derive(Debug)]
pub struct Made {
    text: String,
    /// what of the model is not in it
    left_out: Vec<String>,
    /// a program that does what the file cannot hold
    callback: Option<String>,
    /// that such a program of an earlier export was removed
    outdated: Option<String>,
    /// of the aircraft's autopilot; none for a simulator
    parameters: Vec<ParameterLine>,
    /// what messages call the model
    origin: PathBuf,
    /// what is doubtful about it
    warnings: Vec<Note>,
}

/// Why no file was made.
#[derive(Debug)]
pub enum NotMade {
    /// the model does not hold what the format needs: every model of such a vehicle file is so
    Missing {
        /// in words
        what: &'static str,
        /// the whole sentence
        why: String,
    },
    /// anything else
    Failed(CommandError),
}

impl From<CommandError> for NotMade {
    fn from(error: CommandError) -> Self {
        Self::Failed(error)
    }
}

impl From<NotMade> for CommandError {
    fn from(error: NotMade) -> Self {
        match error {
            NotMade::Missing { why, .. } => Self::Input(why),
            NotMade::Failed(error) => error,
        }
    }
}

/// The altitude is one, and counts for the format.
fn checked(args: &ExportArgs) -> Result<(), CommandError> {
    let Some(altitude_m) = args.altitude else { return Ok(()) };
    let expected = match Target::from(args.to) {
        Target::Simulator(_) => {
            "px4-params or ardupilot-params beside it: a simulator has its own air".to_owned()
        }
        Target::Aircraft(_) if !ALTITUDES_M.contains(&altitude_m) => {
            format!("a height above the sea of {} to {} m", ALTITUDES_M.start(), ALTITUDES_M.end())
        }
        Target::Aircraft(_) => return Ok(()),
    };
    Err(CommandError::Input(format!("--altitude: expected {expected}, got {altitude_m}")))
}

/// Writes the file, and its program beside it. The program of an earlier export of the same file is removed where there is none now:
/// returns that it was.
fn write(
    (path, text): (&PathBuf, &str),
    program: Option<&str>,
    args: &ExportArgs,
) -> Result<Option<String>, CommandError> {
    let beside = program.is_some().then(|| callback_of(path));
    let read: Vec<&PathBuf> = args.model.iter().collect();
    output::refuse_overwriting(&read, &iter::once(path).chain(&beside).collect::<Vec<_>>())?;
    if program.is_some() {
        refuse_other_program(path)?;
    }
    let is_outdated = program.is_none() && has_earlier(path);
    output::file(path, text)?;
    if let (Some(program), Some(beside)) = (program, &beside) {
        output::file(beside, program)?;
    }
    if is_outdated { output::outdated(&callback_of(path)) } else { Ok(None) }
}

/// Exports, and writes the file that is asked for.
pub fn make(args: &ExportArgs) -> Result<Made, NotMade> {
    checked(args)?;
    let (loaded, origin) = args.draft.given(args.model.as_ref()).alone().map_err(CommandError::from)?;
    let refuse = |error: ExportError| {
        let why = format!("{}: {error}", text::path(&origin));
        match error {
            ExportError::Missing { what, .. } => NotMade::Missing { what, why },
            _ => NotMade::Failed(CommandError::Input(why)),
        }
    };
    let active = effects_of(&loaded.model.effects, &text::path(&origin), &loaded.vehicle)
        .map_err(CommandError::from)?;
    let identified = loaded.model.identified.as_ref();
    let (text, left_out, parameters, callback) = match Target::from(args.to) {
        Target::Simulator(format) => {
            let Exported { text, left_out, callback } =
                export(&loaded.vehicle, &active, identified, format).map_err(refuse)?;
            (text, left_out, Vec::new(), callback)
        }
        Target::Aircraft(autopilot) => {
            let AircraftParameters { parameters, left_out, text } =
                aircraft_parameters(&loaded.vehicle, &active, identified, (autopilot, args.altitude))
                    .map_err(refuse)?;
            (text, left_out, parameters.into_iter().map(ParameterLine::from).collect(), None)
        }
    };
    let file = args.out.as_deref().unwrap_or(Path::new(UNNAMED));
    let callback = callback.map(|program| program.text(file));
    let mut outdated = None;
    if let Some(path) = &args.out {
        outdated = write((path, &text), callback.as_deref(), args)?;
    }
    let warnings = loaded.warnings;
    Ok(Made { text, left_out, callback, outdated, parameters, origin, warnings })
}
