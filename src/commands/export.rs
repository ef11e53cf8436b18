//! `mavid export MODEL --to FORMAT`: the model for another simulator, or for the aircraft's own autopilot.

use std::iter;
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

use mavid::autopilot::Autopilot;
use mavid::config::effects_of;
use mavid::export::{
    AircraftParameter, AircraftParameters, ExportError, Exported, Format, aircraft_parameters, export,
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

/// The program's file beside that of the model: `model.xml` has `model_effects.py`.
fn callback_of(path: &Path) -> PathBuf {
    let mut name = path.file_stem().unwrap_or_default().to_owned();
    name.push("_effects.py");
    path.with_file_name(name)
}

/// Runs the verb.
pub fn run(json: bool, args: &ExportArgs) -> Result<Outcome, CommandError> {
    let Made { text, left_out, callback, parameters, origin, warnings } = make(args)?;
    output::warnings(&origin, &warnings);
    left_out.iter().for_each(|note| output::message(&format!("note: {note}")));
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
    if let Some(path) = &args.out {
        let beside = callback.is_some().then(|| callback_of(path));
        let read: Vec<&PathBuf> = args.model.iter().collect();
        output::refuse_overwriting(&read, &iter::once(path).chain(&beside).collect::<Vec<_>>())?;
        output::file(path, &text)?;
        if let (Some(callback), Some(beside)) = (&callback, &beside) {
            output::file(beside, callback)?;
        }
    }
    let warnings = loaded.warnings;
    Ok(Made { text, left_out, callback, parameters, origin, warnings })
}
