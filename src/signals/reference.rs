//! The commanded trajectory on the grid.

use super::filter::central_difference;
use super::flight::{Reference, Series};
use super::grid::{Grid, cubic_onto};
use super::select::best;
use crate::autopilot::Autopilot;
use crate::recording::{Quantity, Recording, Stream, StreamKey};
use nalgebra::Vector3;

/// PX4's setpoint for its own attitude: its acceleration holds what the controller answers to the velocity, and with it the noise of that;
/// its position is the commanded one.
const FED_BACK: [&str; 2] = ["vehicle_local_position_setpoint", "POSITION_TARGET_LOCAL_NED"];

/// The commanded acceleration and yaw, by a spline; `None` if they were not recorded. Where the acceleration was not commanded, or is fed
/// back, it is that of the commanded position.
pub(super) fn reference(recording: &Recording, grid: &Grid) -> Option<Reference> {
    let commanded = best(recording, Quantity::AccelerationSetpoint, |s| s.width == 3);
    let is_fed_back =
        |key: &StreamKey| recording.autopilot == Autopilot::Px4 && FED_BACK.contains(&key.source);
    let (acceleration, message) = match commanded {
        Some((key, stream)) if !is_fed_back(key) => (cubic_onto(stream, 0.0, grid)?, key.source),
        other => of_position(recording, grid)
            .or_else(|| other.and_then(|(key, stream)| Some((cubic_onto(stream, 0.0, grid)?, key.source))))?,
    };
    let yaw = best(recording, Quantity::YawSetpoint, |s| s.width == 1)
        .and_then(|(_, stream)| cubic_onto(&unwrapped(stream), 0.0, grid))
        .unwrap_or_else(|| vec![0.0; grid.count]);
    Some(Reference {
        acceleration: Series::new(
            acceleration.chunks_exact(3).map(|a| Vector3::new(a[0], a[1], a[2])).collect(),
        ),
        yaw: yaw.into(),
        message,
    })
}

/// The acceleration of the commanded position, m/s^2, three values an instant, and its message.
fn of_position(recording: &Recording, grid: &Grid) -> Option<(Vec<f64>, &'static str)> {
    let (key, stream) = best(recording, Quantity::PositionSetpoint, |s| s.width == 3)?;
    let position = cubic_onto(stream, 0.0, grid)?;
    let mut out = vec![0.0; position.len()];
    for axis in 0..3 {
        let along: Vec<f64> = position.iter().skip(axis).step_by(3).copied().collect();
        let twice = central_difference(&central_difference(&along, grid.step_s), grid.step_s);
        out.iter_mut().skip(axis).step_by(3).zip(twice).for_each(|(out, value)| *out = value);
    }
    Some((out, key.source))
}

/// An angle without its jumps of a full turn.
fn unwrapped(stream: &Stream) -> Stream {
    let mut out = stream.clone();
    for i in 1..out.values.len() {
        let turns = ((out.values[i] - out.values[i - 1]) / std::f64::consts::TAU).round();
        if turns.is_finite() {
            out.values[i] -= turns * std::f64::consts::TAU;
        }
    }
    out
}
