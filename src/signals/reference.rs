//! The commanded trajectory on the grid.

use super::flight::{Reference, Series};
use super::grid::{Grid, cubic_onto};
use super::select::best;
use crate::recording::{Quantity, Recording, Stream};
use nalgebra::Vector3;

/// The commanded acceleration and yaw, by linear interpolation; `None` if they were not recorded.
pub(super) fn reference(recording: &Recording, grid: &Grid) -> Option<Reference> {
    let (key, acceleration) = best(recording, Quantity::AccelerationSetpoint, |s| s.width == 3)?;
    let acceleration = cubic_onto(acceleration, 0.0, grid)?;
    let yaw = best(recording, Quantity::YawSetpoint, |s| s.width == 1)
        .and_then(|(_, stream)| cubic_onto(&unwrapped(stream), 0.0, grid))
        .unwrap_or_else(|| vec![0.0; grid.count]);
    Some(Reference {
        acceleration: Series::new(
            acceleration.chunks_exact(3).map(|a| Vector3::new(a[0], a[1], a[2])).collect(),
        ),
        yaw: yaw.into(),
        message: key.source,
    })
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
