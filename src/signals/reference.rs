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

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test ends where it fails")]
    use super::*;

    const GRID: Grid = Grid { start_s: 0.0, step_s: 0.01, count: 2000 };
    /// rad/s
    const TURNING: f64 = 2.0;

    fn recording(autopilot: Autopilot, entries: &[(Quantity, &'static str, fn(f64) -> f64)]) -> Recording {
        let mut recording = Recording { autopilot, ..Recording::default() };
        for &(quantity, source, along) in entries {
            let time_s: Vec<f64> = (0..200).map(|index| 0.1 * f64::from(index)).collect();
            let values = time_s.iter().flat_map(|time_s| [along(*time_s), 0.0, 0.0]).collect();
            let key = StreamKey { quantity, source, instance: 0 };
            recording.streams.insert(key, Stream { time_s, width: 3, values });
        }
        recording
    }

    fn position_m(time_s: f64) -> f64 {
        (TURNING * time_s).sin()
    }

    /// m/s^2, that of the position and what a controller answers
    fn answering(time_s: f64) -> f64 {
        -TURNING.powi(2) * position_m(time_s) + (11.0 * time_s).cos()
    }

    fn nought(time_s: f64) -> f64 {
        if time_s < 7.0 { 0.0 } else { -0.0 }
    }

    #[test]
    fn what_a_controller_answers_is_no_reference() {
        const PX4: [(Quantity, &str, fn(f64) -> f64); 2] = [
            (Quantity::PositionSetpoint, "vehicle_local_position_setpoint", position_m),
            (Quantity::AccelerationSetpoint, "vehicle_local_position_setpoint", answering),
        ];
        let at = |found: &Reference, index: usize| {
            found.acceleration[index].x + TURNING.powi(2) * position_m(GRID.time_s(index))
        };
        let commanded = reference(&recording(Autopilot::Px4, &PX4), &GRID).unwrap();
        // of another autopilot, the acceleration is that of a path
        let other = reference(&recording(Autopilot::ArduPilot, &PX4), &GRID).unwrap();
        let alone = reference(&recording(Autopilot::Px4, &PX4[1..]), &GRID).unwrap();
        for index in (200..1700).step_by(37) {
            assert!(at(&commanded, index).abs() < 0.05, "{index}: {}", at(&commanded, index));
            for with_answer in [&other, &alone] {
                let left = at(with_answer, index) - (11.0 * GRID.time_s(index)).cos();
                assert!(left.abs() < 0.1, "{index}: {left}");
            }
        }
    }

    #[test]
    fn positions_alone_are_a_reference_and_nought_is_none() {
        const SOURCE: &str = "SET_POSITION_TARGET_LOCAL_NED";
        let positions = [
            (Quantity::PositionSetpoint, SOURCE, position_m as fn(f64) -> f64),
            (Quantity::AccelerationSetpoint, SOURCE, nought),
        ];
        let found = reference(&recording(Autopilot::Px4, &positions), &GRID).unwrap();
        let expected = -TURNING.powi(2) * position_m(GRID.time_s(900));
        assert!((found.acceleration[900].x - expected).abs() < 0.05, "{}", found.acceleration[900].x);
        assert!(reference(&recording(Autopilot::Px4, &positions[1..]), &GRID).is_none());
    }
}
