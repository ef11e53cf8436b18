//! Actuation of the body: rotors, or force and torque of the log.

use super::actuators::{thrusts_from_commands, thrusts_from_speeds};
use super::rotor_count::{channels_that_move, refuse_stated_count};
use super::rotor_thrusts::{RotorThrusts, ThrustSource, with_mean_of_curve};
use super::select::{best, too_short};
use super::stated_rotors::rotor_difference;
use super::sufficient::{LEAST_TORQUE_HZ, flowing_rate_hz};
use super::{Grid, SignalsError, linear_onto};
use crate::note::{About, Note};
use crate::recording::{Quantity, Recording, Stream};
use crate::vehicle::Vehicle;
use nalgebra::Vector4;

/// Commands or measured rotor speeds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ThrustPreference {
    /// measured speeds if they are recorded, unless they are too slow and the commands are not
    #[default]
    Measured,
    /// commands only
    Commands,
    /// measured speeds if they are sampled at least as fast as the commands, otherwise commands
    BestSampled,
}

/// Ratio of two rates from which streams count as equally sampled: lost frames explain the difference. A real
/// difference of rates is a factor of two and more.
const SAMPLED_ALIKE: f64 = 0.95;

/// The rotors' thrusts by this preference.
fn rotor_thrusts(
    recording: &Recording,
    vehicle: &Vehicle,
    preference: ThrustPreference,
) -> Result<RotorThrusts, SignalsError> {
    let speeds = || thrusts_from_speeds(recording, vehicle);
    let commands = || thrusts_from_commands(recording, vehicle);
    match preference {
        ThrustPreference::Measured => match speeds() {
            // a link that hardly carries them may carry the commands
            Some(speeds) if flowing_rate_hz(&speeds.stream) < LEAST_TORQUE_HZ => {
                let speeds_hz = flowing_rate_hz(&speeds.stream);
                let faster = |of: &RotorThrusts| speeds_hz < SAMPLED_ALIKE * flowing_rate_hz(&of.stream);
                let faster = commands().ok().filter(faster);
                Ok(faster.unwrap_or(speeds))
            }
            Some(speeds) => Ok(speeds),
            None => commands(),
        },
        ThrustPreference::Commands => commands(),
        ThrustPreference::BestSampled => match (speeds(), commands()) {
            (Some(speeds), Ok(commands))
                if flowing_rate_hz(&speeds.stream) < SAMPLED_ALIKE * flowing_rate_hz(&commands.stream) =>
            {
                Ok(commands)
            }
            (Some(speeds), _) => Ok(speeds),
            (None, commands) => commands,
        },
    }
}

/// Actuation of the body.
pub(super) enum Actuation {
    /// one thrust for each rotor
    Rotors(RotorThrusts),
    /// force and torque as recorded
    Wrench(&'static str, Stream),
}

impl Actuation {
    pub(super) fn from(
        recording: &Recording,
        vehicle: &Vehicle,
        preference: ThrustPreference,
    ) -> Result<Self, SignalsError> {
        if let Some((key, stream)) = best(recording, Quantity::Wrench, |s| s.width == 4) {
            return Ok(Self::Wrench(key.source, stream.clone()));
        }
        refuse_stated_count(recording, vehicle)?;
        rotor_thrusts(recording, vehicle, preference).map(Self::Rotors).map_err(|error| match error {
            SignalsError::NoActuators { .. } => too_short(recording, Quantity::Wrench, |_, s| s.width == 4)
                .or_else(|| {
                    let rotors = vehicle.rotors.len();
                    too_short(recording, Quantity::RotorSpeed, |_, s| s.width >= rotors)
                })
                .unwrap_or(error),
            other => other,
        })
    }

    pub(super) fn stream(&self) -> &Stream {
        match self {
            Self::Rotors(rotors) => &rotors.stream,
            Self::Wrench(_, stream) => stream,
        }
    }

    pub(super) fn command(&self) -> Option<&Stream> {
        match self {
            Self::Rotors(rotors) => rotors.command.as_ref(),
            Self::Wrench(..) => None,
        }
    }

    /// Relative standard error that all torques about x and y have in common.
    pub(super) fn torque_std(&self) -> f64 {
        match self {
            Self::Rotors(rotors) => rotors.torque_std,
            Self::Wrench(..) => 0.0,
        }
    }

    pub(super) fn source(&self) -> ThrustSource {
        match self {
            Self::Rotors(rotors) => rotors.source,
            Self::Wrench(..) => ThrustSource::Wrench,
        }
    }

    pub(super) fn quantity(&self) -> Quantity {
        match self.source() {
            ThrustSource::MeasuredSpeed => Quantity::RotorSpeed,
            ThrustSource::Command => Quantity::ActuatorCommand,
            ThrustSource::Wrench => Quantity::Wrench,
        }
    }

    pub(super) fn message(&self) -> &'static str {
        match self {
            Self::Rotors(rotors) => rotors.message,
            Self::Wrench(message, _) => message,
        }
    }

    /// Notes on the source of the thrusts.
    pub(super) fn notes(&self, recording: &Recording, vehicle: &Vehicle) -> Vec<Note> {
        let Self::Rotors(rotors) = self else { return Vec::new() };
        let mut notes = rotors.notes.clone();
        let other = rotor_difference(recording.autopilot, &recording.parameters, vehicle);
        notes.extend(other.map(|other| Note::warning(About::Vehicle, other.to_string())));
        let needed = vehicle.rotors.len();
        let recorded = |quantity: Quantity| {
            let streams = recording.streams.iter().filter(move |(key, _)| key.quantity == quantity);
            streams.map(|(_, stream)| stream.width).max()
        };
        match recorded(Quantity::RotorSpeed) {
            Some(width) if rotors.source == ThrustSource::Command && width < needed => notes.push(Note::warning(
                About::Actuators,
                format!(
                    "expected the speeds of all {needed} rotors, got those of {width}: thrust is taken from the commands instead, by the \
                     vehicle's thrust law"
                ),
            )),
            _ => {}
        }
        let moving = recording.streams.iter().filter(|(key, _)| key.quantity == Quantity::ActuatorCommand);
        let moving = moving.map(|(_, stream)| channels_that_move(stream)).max();
        if let Some(count) = moving.filter(|count| *count > needed) {
            notes.push(Note::remark(
                About::Actuators,
                format!("the log has {count} actuator channels in use, the vehicle {needed} rotors: is it this vehicle's?"),
            ));
        }
        notes
    }

    /// Total thrust at each of the stream's own samples, N.
    pub(super) fn collective_n(&self, index: usize) -> f64 {
        match self {
            Self::Rotors(rotors) => rotors.stream.sample(index).iter().sum(),
            Self::Wrench(_, stream) => stream.sample(index)[0],
        }
    }

    /// Rotor thrusts and `F` on the grid, by first-order hold. Samples of rotors are mended for what that takes. A recorded wrench is taken
    /// as it is: nothing says whether its samples are those of an instant.
    pub(super) fn onto(&self, grid: &Grid, vehicle: &Vehicle) -> Felt {
        let held = |stream: &Stream| linear_onto(stream, 0.0, grid).unwrap_or_default();
        let rotors = match self {
            Self::Rotors(rotors) => rotors,
            Self::Wrench(_, stream) => {
                let wrench = held(stream).chunks_exact(4).map(Vector4::from_column_slice).collect();
                return Felt { rotor_thrust_n: Vec::new(), wrench, jitter_wrench: None };
            }
        };
        let flat = held(&with_mean_of_curve(&rotors.stream, grid.step_s));
        let mixer = vehicle.mixer();
        let mixed = |flat: &[f64]| -> Vec<Vector4<f64>> {
            flat.chunks_exact(rotors.stream.width).map(|thrusts| mixer.wrench(thrusts)).collect()
        };
        let mut wrench = mixed(&flat);
        let jitter = rotors.jitter.as_ref().and_then(|jitter| linear_onto(jitter, 0.0, grid));
        let jitter_wrench = jitter.map(|jitter| mixed(&jitter));
        for (wrench, jitter) in wrench.iter_mut().zip(jitter_wrench.iter().flatten()) {
            *wrench -= 0.5 * jitter;
        }
        Felt { rotor_thrust_n: flat, wrench, jitter_wrench }
    }
}

/// Force and torque of the rotors on the grid.
pub(super) struct Felt {
    pub(super) rotor_thrust_n: Vec<f64>,
    pub(super) wrench: Vec<Vector4<f64>>,
    pub(super) jitter_wrench: Option<Vec<Vector4<f64>>>,
}
