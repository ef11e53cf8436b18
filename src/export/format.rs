//! The formats of simulators, and the export of a model to each.

use super::error::ExportError;
use super::source::{Exported, Source};
use super::{ardupilot, mjcf, px4, rotorpy, sdf};
use crate::physics::ActiveEffect;
use crate::vehicle::Vehicle;
use toml::Table;

/// A simulator's file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// parameters of PX4's simulation in hardware
    Px4Sih,
    /// frame of ArduPilot's simulator, `--model "x:frame.json"`
    ArdupilotSitl,
    /// Gazebo, with the multicopter motor model
    Sdf,
    /// MuJoCo
    Mjcf,
    /// RotorPy's parameter dictionary
    Rotorpy,
}

/// The model in a simulator's form; `identified` is the table of that name in its file, and says what it costs to leave an effect
/// out.
///
/// # Errors
/// [`ExportError`] where the simulator cannot take such a vehicle.
pub fn export(
    vehicle: &Vehicle,
    effects: &[ActiveEffect],
    identified: Option<&Table>,
    format: Format,
) -> Result<Exported, ExportError> {
    let mut source = Source::new(vehicle, effects, identified)?;
    source.tell_unsure(identified);
    match format {
        Format::Px4Sih => px4::write(source),
        Format::ArdupilotSitl => ardupilot::write(source),
        Format::Sdf => sdf::write(source),
        Format::Mjcf => mjcf::write(source),
        Format::Rotorpy => rotorpy::write(source),
    }
}
