//! The slow error of the velocity estimate, by the position of the same estimate.
//!
//! An estimator that integrates a noisy accelerometer leaves the velocity wrong by 0.1 to 0.3 m/s for ten seconds and more, while a
//! receiver, a barometer or a camera keeps its position right. The change of the position tells such an error: of motion that is
//! slower than the crossover the position gives the velocity, and of faster motion the velocity itself. Against the velocity of a
//! satellite receiver, over half a second, the velocity of 48 simulated flights of PX4 was wrong by 0.18, 0.28 and 0.19 m/s (north,
//! east, down), with the position 0.07, 0.10 and 0.11; that of a real quadrotor by 0.10, 0.13 and 0.14 m/s, with the position
//! 0.09, 0.11 and 0.11. ArduPilot's estimate agrees with its position to 0.01 m/s, and stays as it is.

use super::Grid;
use super::filter::{Butterworth, central_difference};
use crate::recording::Stream;
use nalgebra::Vector3;

/// Frequency at which position and velocity tell the motion equally well, Hz. In simulated flights of PX4 0.2 to 0.8 Hz served
/// alike, in flights of two real quadrotors 0.1 to 0.2 Hz.
const CROSSOVER_HZ: f64 = 0.2;
/// A position that departs from its velocity by more than this jumped, m/s: no estimate is so wrong in flight.
const MOST_M_S: f64 = 3.0;

/// What the velocity exceeds the true one by slower than the crossover, m/s, one a grid instant; `None` where the grid is too coarse
/// or empty. Position (m) and velocity (m/s) are on the grid, in the same axes.
pub(super) fn slow_error_m_s(
    grid: &Grid,
    position: &[Vector3<f64>],
    velocity: &[Vector3<f64>],
) -> Option<Vec<Vector3<f64>>> {
    let filter = Butterworth::new(CROSSOVER_HZ, grid.step_s.recip())?;
    let apart = [0, 1, 2].map(|axis| {
        let of = |vectors: &[Vector3<f64>]| vectors.iter().map(|v| v[axis]).collect::<Vec<f64>>();
        let by_position = central_difference(&of(position), grid.step_s);
        let excess = velocity.iter().zip(&by_position).map(|(v, by_position)| v[axis] - by_position);
        filter.filtfilt(&excess.map(|by| if by.abs() > MOST_M_S { 0.0 } else { by }).collect::<Vec<f64>>())
    });
    Some((0..velocity.len()).map(|i| Vector3::new(apart[0][i], apart[1][i], apart[2][i])).collect())
}

/// A stream of velocities less an error on the grid, both m/s; beyond the grid its last error holds.
pub(super) fn without(stream: &Stream, grid: &Grid, error_m_s: &[Vector3<f64>]) -> Stream {
    let mut out = stream.clone();
    let mut instant = 0;
    for (t, sample) in stream.time_s.iter().zip(out.values.chunks_mut(stream.width.max(1))) {
        while instant + 1 < error_m_s.len() && grid.time_s(instant) < *t {
            instant += 1;
        }
        let Some(error) = error_m_s.get(instant) else { break };
        sample.iter_mut().zip(error.iter()).for_each(|(value, error)| *value -= error);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    const GRID: Grid = Grid { start_s: 5.0, step_s: 0.02, count: 4000 };

    /// A flight of 80 s to and fro along x every 8 s, 2 m to each side: position, velocity.
    fn flown() -> (Vec<Vector3<f64>>, Vec<Vector3<f64>>) {
        let rate = std::f64::consts::TAU / 8.0;
        let along = |of: fn(f64) -> f64, by: f64| {
            (0..GRID.count).map(|i| Vector3::x() * (by * of(rate * GRID.time_s(i)))).collect()
        };
        (along(f64::sin, 2.0), along(f64::cos, 2.0 * rate))
    }

    fn rms(vectors: &[Vector3<f64>]) -> f64 {
        (vectors.iter().map(Vector3::norm_squared).sum::<f64>() / vectors.len() as f64).sqrt()
    }

    /// Root mean square of what is found less the error that was put in, m/s.
    fn left(position: &[Vector3<f64>], velocity: &[Vector3<f64>], error: &[Vector3<f64>]) -> f64 {
        let with: Vec<_> = velocity.iter().zip(error).map(|(velocity, error)| velocity + error).collect();
        let found = slow_error_m_s(&GRID, position, &with).expect("a grid of 50 Hz");
        rms(&found.iter().zip(error).map(|(found, error)| found - error).collect::<Vec<_>>())
    }

    #[test]
    fn a_slow_error_is_found_and_motion_is_not_taken_for_one() {
        let (position, velocity) = flown();
        let wave = |hz: f64| {
            let of =
                |i: usize| Vector3::new(0.3, -0.2, 0.2) * (hz * std::f64::consts::TAU * GRID.time_s(i)).sin();
            (0..GRID.count).map(of).collect::<Vec<_>>()
        };
        assert!(left(&position, &velocity, &vec![Vector3::zeros(); GRID.count]) < 2e-3);
        assert!(left(&position, &velocity, &wave(0.02)) < 0.01);
        // what is faster than the crossover stays with the velocity
        let fast = wave(2.0);
        assert!((left(&position, &velocity, &fast) - rms(&fast)).abs() < 0.01);
    }

    #[test]
    fn a_jump_of_the_position_is_no_error_of_the_velocity() {
        let (mut position, velocity) = flown();
        position[2000..].iter_mut().for_each(|position| *position += Vector3::new(5.0, 0.0, -1.0));
        assert!(left(&position, &velocity, &vec![Vector3::zeros(); GRID.count]) < 2e-3);
    }

    #[test]
    fn samples_lose_the_error_of_their_instant() {
        let error: Vec<_> = (0..GRID.count).map(|i| Vector3::new(0.0, GRID.time_s(i), 1.0)).collect();
        let stream = Stream { time_s: vec![4.0, 6.0, 99.0], width: 3, values: vec![1.0; 9] };
        let out = without(&stream, &GRID, &error);
        let last = GRID.time_s(GRID.count - 1);
        let expected = [1.0, 1.0 - 5.0, 0.0, 1.0, 1.0 - 6.0, 0.0, 1.0, 1.0 - last, 0.0];
        assert!(out.values.iter().zip(expected).all(|(value, expected)| (value - expected).abs() < 0.011));
        assert!(without(&stream, &GRID, &[]).values == stream.values);
        assert!(slow_error_m_s(&Grid { step_s: 3.0, ..GRID }, &[], &[]).is_none());
    }
}
