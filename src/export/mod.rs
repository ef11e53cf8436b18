//! A model for the simulators people use.
//!
//! Signs, frames and units are converted here and nowhere else: body forward-left-up becomes
//! forward-right-down for PX4 and ArduPilot. What a simulator has no place for is told, never dropped in
//! silence.

mod ardupilot;
mod mjcf;
mod px4;
mod rotorpy;
mod sdf;

use crate::physics::{ActiveEffect, Airframe, PhysicsError};
use crate::text::{line_comment, markup_comment};
use crate::vehicle::{ThrustLaw, Vehicle};
use nalgebra::Vector3;

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

/// A file, and what of the model is not in it.
#[derive(Debug, Clone, PartialEq)]
pub struct Exported {
    /// the file
    pub text: String,
    /// sentence by sentence; they stand in the file as comments too
    pub left_out: Vec<String>,
}

/// Why a model has no form in a simulator.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ExportError {
    /// it needs what the model does not say
    #[error("{format} needs {what}, and the model does not say it")]
    Missing {
        /// simulator
        format: &'static str,
        /// what
        what: &'static str,
    },
    /// not such a vehicle
    #[error("{format} expects {expected}, the model has {got}")]
    Unfit {
        /// simulator
        format: &'static str,
        /// what it takes
        expected: &'static str,
        /// what came
        got: String,
    },
    /// the vehicle itself
    #[error(transparent)]
    Physics(#[from] PhysicsError),
}

/// The model in a simulator's form.
///
/// # Errors
/// [`ExportError`] where the simulator cannot take such a vehicle.
pub fn export(vehicle: &Vehicle, effects: &[ActiveEffect], format: Format) -> Result<Exported, ExportError> {
    let source = Source::new(vehicle, effects)?;
    match format {
        Format::Px4Sih => px4::write(source),
        Format::ArdupilotSitl => ardupilot::write(source),
        Format::Sdf => sdf::write(source),
        Format::Mjcf => mjcf::write(source),
        Format::Rotorpy => rotorpy::write(source),
    }
}

/// The model as the writers read it; what they do not take is told at the end.
struct Source<'a> {
    vehicle: &'a Vehicle,
    airframe: Airframe,
    effects: &'a [ActiveEffect],
    taken: Vec<&'static str>,
    left_out: Vec<String>,
}

impl<'a> Source<'a> {
    fn new(vehicle: &'a Vehicle, effects: &'a [ActiveEffect]) -> Result<Self, ExportError> {
        let airframe = Airframe::new(vehicle)?;
        Ok(Self { vehicle, airframe, effects, taken: Vec::new(), left_out: Vec::new() })
    }

    /// An effect's parameter, 0 where the model does not have the effect; it counts as carried over.
    fn take(&mut self, id: &'static str, parameter: &str) -> f64 {
        self.taken.push(id);
        let active = self.effects.iter().find(|active| active.effect().id() == id);
        active.map_or(0.0, |active| {
            let names = active.effect().parameters().iter().chain(active.effect().finer_parameters());
            names.zip(active.parameters()).find(|(p, _)| p.name == parameter).map_or(0.0, |(_, value)| *value)
        })
    }

    fn has(&self, id: &str) -> bool {
        self.effects.iter().any(|active| active.effect().id() == id)
    }

    fn note(&mut self, text: impl Into<String>) {
        self.left_out.push(text.into());
    }

    /// s, lag of the rotors: of the effect, else what the vehicle's file knows.
    fn time_constant_s(&mut self) -> Option<f64> {
        if self.has("motor_lag") {
            return Some(self.take("motor_lag", "time_constant"));
        }
        self.vehicle.propulsion.time_constant_s.filter(|time_constant_s| *time_constant_s > 0.0)
    }

    /// Centre of mass in the frame of the rotor positions, m, with the offset that was found.
    fn center_of_mass_m(&mut self) -> Vector3<f64> {
        let offset = ["x", "y", "z"].map(|axis| self.take("com_offset", axis));
        self.vehicle.body.center_of_mass_m + Vector3::from(offset)
    }

    /// Hubs from the centre of mass, m, body FLU.
    fn arms_m(&mut self) -> Vec<Vector3<f64>> {
        let center = self.center_of_mass_m();
        self.vehicle.rotors.iter().map(|rotor| rotor.position_m - center).collect()
    }

    /// N, one rotor at full command.
    fn thrust_max_n(&self) -> f64 {
        self.vehicle.propulsion.thrust_from_command_n(1.0)
    }

    /// N/(rad/s)^2 and rad/s at full command.
    fn speeds(&self, format: &'static str) -> Result<(f64, f64), ExportError> {
        let missing = |what| ExportError::Missing { format, what };
        let coefficient = self
            .vehicle
            .propulsion
            .thrust_coefficient
            .ok_or_else(|| missing("thrust_coefficient (thrust by rotor speed)"))?;
        let speed_max = match self.vehicle.propulsion.law {
            ThrustLaw::Speed { speed_max_rad_s } => speed_max_rad_s,
            ThrustLaw::Curve { thrust_max_n, .. } => (thrust_max_n / coefficient).sqrt(),
        };
        Ok((coefficient, speed_max))
    }

    /// rad/s of each rotor at hover.
    fn hover_rad_s(&self, format: &'static str) -> Result<f64, ExportError> {
        let (coefficient, _) = self.speeds(format)?;
        Ok((self.airframe.hover_thrust_n / coefficient).sqrt())
    }

    /// Done: what was not taken is told.
    fn finish(mut self, write: impl FnOnce(&[String]) -> String) -> Exported {
        for active in self.effects {
            let id = active.effect().id();
            if !self.taken.contains(&id) {
                let values: Vec<String> = active
                    .effect()
                    .parameters()
                    .iter()
                    .zip(active.parameters())
                    .map(|(p, value)| format!("{} = {value} {}", p.name, p.unit))
                    .collect();
                self.left_out.push(format!("{id} has no place here: {}", values.join(", ")));
            }
        }
        Exported { text: write(&self.left_out), left_out: self.left_out }
    }
}

/// Body forward-left-up to forward-right-down.
fn frd(v: &Vector3<f64>) -> [f64; 3] {
    // no minus zero
    [v.x, 0.0 - v.y, 0.0 - v.z]
}

/// Notes as comments of XML.
fn xml_comments(notes: &[String]) -> String {
    notes.iter().map(|note| format!("{}\n", markup_comment(note))).collect()
}

/// Notes as lines after `mark`.
fn line_comments(mark: &str, notes: &[String]) -> String {
    notes.iter().map(|note| line_comment(mark, note)).collect()
}
