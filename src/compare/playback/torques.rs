//! What a model says of the torques along a recording.

use super::settings::PlaybackSettings;
use super::windows::{Played, played};
use crate::compare::CompareError;
use crate::physics::Model;
use crate::signals::{Grid, Signals};
use crate::vehicle::Vehicle;
use nalgebra::Vector3;

/// Torque about the centre of mass at each instant of the grid, body FLU, N m: of the rotors under the recorded commands and of the
/// effects, with the body as it was measured. The effects' own states (a rotor's lag) are carried along. Zero where the recording
/// cannot be used.
///
/// # Errors
/// As [`playback`](super::playback).
pub fn torques_along(
    (model, vehicle): (&Model, &Vehicle),
    signals: &Signals,
    settings: &PlaybackSettings,
) -> Result<Vec<Vector3<f64>>, CompareError> {
    let model = played(model, signals);
    let played = Played::of((&model, vehicle), None, signals, settings)?;
    let mut torques_nm = vec![Vector3::zeros(); signals.grid.count];
    for run in Grid::runs(&signals.usable, 1) {
        let mut plant = played.plant(run.start)?;
        for index in run {
            torques_nm[index] = played.torque_nm(&mut plant, index);
        }
    }
    Ok(torques_nm)
}
