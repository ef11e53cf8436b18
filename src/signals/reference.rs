//! The commanded trajectory on the grid.

use super::flight::{Reference, Series};
use super::grid::{Grid, cubic_onto};
use super::select::{best, best_of};
use crate::autopilot::Autopilot;
use crate::recording::{Quantity, Recording, Stream, StreamKey};
use nalgebra::Vector3;

/// PX4's setpoint for its own attitude. Its acceleration has the controller's answer to the velocity in it, and with it the noise of the
/// velocity. Its position is the commanded one.
const FED_BACK: [&str; 2] = ["vehicle_local_position_setpoint", "POSITION_TARGET_LOCAL_NED"];
/// Half of the span of a second difference of the commanded position, s. A position that is held from one command to the next has steps; over
/// this span they are small, and 97 % of an acceleration of 1 Hz are left.
const APART_S: f64 = 0.1;
/// Longest gap in the commanded positions, s. A spline through a longer one has an acceleration that nobody commanded.
const LONGEST_GAP_S: f64 = 1.0;

/// The commanded acceleration and yaw, by a spline; `None` if they were not recorded. Where no acceleration was commanded, or the one that
/// is recorded is fed back, it is that of the commanded position.
pub(super) fn reference(recording: &Recording, grid: &Grid) -> Option<Reference> {
    let is_fed_back =
        |key: &StreamKey| recording.autopilot == Autopilot::Px4 && FED_BACK.contains(&key.source);
    let commanded = |fed_back: bool| {
        let fits = |key: &StreamKey, stream: &Stream| stream.width == 3 && is_fed_back(key) == fed_back;
        let (key, stream) = best_of(recording, Quantity::AccelerationSetpoint, fits)?;
        Some((cubic_onto(stream, 0.0, grid)?, key.source))
    };
    let direct = commanded(false);
    let of_positions = if direct.is_none() { of_position(recording, grid) } else { None };
    let is_of_positions = of_positions.is_some();
    let (acceleration, message) = direct.or(of_positions).or_else(|| commanded(true))?;
    let yaw = best(recording, Quantity::YawSetpoint, |s| s.width == 1)
        .and_then(|(_, stream)| cubic_onto(&unwrapped(stream), 0.0, grid))
        .unwrap_or_else(|| vec![0.0; grid.count]);
    Some(Reference {
        acceleration: Series::new(
            acceleration.chunks_exact(3).map(|a| Vector3::new(a[0], a[1], a[2])).collect(),
        ),
        is_of_positions,
        yaw: yaw.into(),
        message,
    })
}

/// The acceleration of the commanded position, m/s^2, three values an instant, and its message.
fn of_position(recording: &Recording, grid: &Grid) -> Option<(Vec<f64>, &'static str)> {
    let (key, stream) = best(recording, Quantity::PositionSetpoint, |s| s.width == 3)?;
    let whole = (0..stream.len()).filter(|&index| stream.sample(index).iter().all(|value| value.is_finite()));
    let times_s: Vec<f64> = whole.map(|index| stream.time_s[index]).collect();
    if times_s.windows(2).any(|pair| pair[1] - pair[0] > LONGEST_GAP_S) {
        return None;
    }
    let [before, here, after] = [-APART_S, 0.0, APART_S].map(|shift_s| cubic_onto(stream, shift_s, grid));
    let (before, here, after) = (before?, here?, after?);
    let each = before.iter().zip(&here).zip(&after);
    let second = each.map(|((before, here), after)| (before - 2.0 * here + after) / APART_S.powi(2));
    Some((second.collect(), key.source))
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

    /// A quantity, its message, and its first component along time, s.
    type Entry = (Quantity, &'static str, fn(f64) -> f64);

    fn recording(autopilot: Autopilot, entries: &[Entry]) -> Recording {
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
        const PX4: [Entry; 2] = [
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
        let positions: [Entry; 2] = [
            (Quantity::PositionSetpoint, SOURCE, position_m),
            (Quantity::AccelerationSetpoint, SOURCE, nought),
        ];
        let found = reference(&recording(Autopilot::Px4, &positions), &GRID).unwrap();
        let expected = -TURNING.powi(2) * position_m(GRID.time_s(900));
        assert!((found.acceleration[900].x - expected).abs() < 0.05, "{}", found.acceleration[900].x);
        assert!(reference(&recording(Autopilot::Px4, &positions[1..]), &GRID).is_none());
    }
}
