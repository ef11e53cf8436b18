//! What all torques about an axis of one flight have in common as an error.

use super::grid::Grid;
use super::rotor_thrusts::ThrustSource;
use super::weak::WeakKernel;
use crate::recording::Stream;
use crate::stats::median_step;
use crate::vehicle::Vehicle;
use nalgebra::Vector3;

/// What all torques of flights have in common as an error.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TorqueError {
    /// relative standard error of all torques about x and y, where they are rebuilt from others (-)
    pub rebuilt: f64,
    /// share of the torque about x and y in step with the angular acceleration that alternates from one logged command to the next (-)
    pub alternating: [f64; 2],
}

impl TorqueError {
    /// Of several flights: what is rebuilt is so in the same way, and what alternates does so by itself in each.
    #[must_use]
    pub fn of_all(each: impl ExactSizeIterator<Item = Self>) -> Self {
        let count = each.len().max(1) as f64;
        let all = each.fold(Self::default(), |all, of| Self {
            rebuilt: all.rebuilt.max(of.rebuilt),
            alternating: [0, 1].map(|axis| of.alternating[axis].hypot(all.alternating[axis])),
        });
        Self { alternating: all.alternating.map(|share| share / count), ..all }
    }

    /// Relative standard errors of Ixx and Iyy beside the common one. A log sees two phases of a torque that comes in pulses; how far the mean
    /// over all phases is from theirs, they do not tell. With half of the share, 16 moments of eight flights of ArduCopter's simulator were
    /// within 1.7 standard errors.
    #[must_use]
    pub fn of_moments(&self) -> [f64; 2] {
        self.alternating.map(|share| 0.5 * share)
    }
}

/// Half width of the test function that gives the angular acceleration, s: the band of a trajectory, without that of a controller.
const HALF_WIDTH_S: f64 = 0.1;
/// Share of the period by which the interval between two logged commands may differ.
const REGULAR: f64 = 0.4;
/// Length of a block for the error of the share, s: longer than what a vehicle's motion remembers.
const BLOCK_S: f64 = 2.0;
/// Fewest blocks that tell an error.
const LEAST_BLOCKS: usize = 6;

/// Share of the torque about body x and y, in step with the angular acceleration, that alternates from one logged command to the next; what
/// noise makes by chance is taken out. Zero where the thrusts are not those of commands.
///
/// A station that sends setpoints in stairs makes the controller answer with a pulse of torque each time. A log whose rate is a multiple of
/// that of the setpoints sees the pulses at the same few phases for the whole flight. With twice the rate, it sees two of them in turn, and
/// half of their difference is the share; three or four phases do not show here. `thrusts` are those of the rotors at the stamps of the commands, N.
pub(super) fn alternating(
    (thrusts, source): (&Stream, ThrustSource),
    vehicle: &Vehicle,
    (grid, usable): (&Grid, &[bool]),
    rate_rad_s: Option<&[Vector3<f64>]>,
) -> [f64; 2] {
    let Some(rate_rad_s) = rate_rad_s.filter(|_| source == ThrustSource::Command) else { return [0.0; 2] };
    let kernel = WeakKernel::new(HALF_WIDTH_S, grid.step_s);
    let centers = kernel.centers(usable, 1);
    let turning = kernel.apply_vector(1, rate_rad_s, &centers);
    let mut place = vec![usize::MAX; grid.count];
    centers.iter().enumerate().for_each(|(at, &center)| place[center] = at);
    let mixer = vehicle.mixer();
    let period_s = median_step(&thrusts.time_s);
    let mut blocks: Vec<[(f64, f64); 2]> = Vec::new();
    // the phase of the last regular sample, which goes on through gaps and stamps that jitter
    let (mut sign, mut from_s) = (1.0, f64::NAN);
    let (mut until_s, mut nearest) = (f64::NEG_INFINITY, 0);
    for sample in 2..thrusts.len().saturating_sub(2) {
        let periods = |at: usize| (thrusts.time_s[at] - thrusts.time_s[at - 1]) / period_s;
        if !(sample - 1..=sample + 2).all(|at| (periods(at) - 1.0).abs() < REGULAR) {
            continue;
        }
        let time_s = thrusts.time_s[sample];
        if ((time_s - from_s) / period_s).round() % 2.0 != 0.0 {
            sign = -sign;
        }
        from_s = time_s;
        let from = |instant: usize| (grid.time_s(instant) - time_s).abs();
        while nearest + 1 < grid.count && from(nearest + 1) <= from(nearest) {
            nearest += 1;
        }
        let at = place.get(nearest).filter(|at| **at != usize::MAX && from(nearest) <= grid.step_s);
        let Some(&at) = at else { continue };
        if time_s > until_s {
            until_s = time_s + BLOCK_S;
            blocks.push([(0.0, 0.0); 2]);
        }
        // force and torque, N and N m
        let around =
            [-2_isize, -1, 0, 1, 2].map(|by| mixer.wrench(thrusts.sample(sample.saturating_add_signed(by))));
        let Some(block) = blocks.last_mut() else { continue };
        for (axis, sums) in block.iter_mut().enumerate() {
            let [a, b, c, d, e] = around.map(|wrench| wrench[1 + axis]);
            let odd = sign * (6.0 * c - 4.0 * (b + d) + a + e) / 16.0;
            let even = (6.0 * c + 4.0 * (b + d) + a + e) / 16.0;
            // a value that is missing is not a number
            if (odd + even).is_finite() {
                sums.0 += odd * turning[axis][at];
                sums.1 += even * turning[axis][at];
            }
        }
    }
    [0, 1].map(|axis| share(&blocks.iter().map(|block| block[axis]).collect::<Vec<_>>()))
}

/// Ratio of two sums over blocks, without what its standard error makes by chance; zero where it is not told.
fn share(blocks: &[(f64, f64)]) -> f64 {
    let (odd, even) = blocks.iter().fold((0.0, 0.0), |sums, block| (sums.0 + block.0, sums.1 + block.1));
    let count = blocks.len() as f64;
    if blocks.len() < LEAST_BLOCKS || even <= 0.0 {
        return 0.0;
    }
    let ratio = odd / even;
    let squares: f64 = blocks.iter().map(|block| (block.0 - ratio * block.1).powi(2)).sum();
    let variance = squares / (even * even) * count / (count - 1.0);
    (ratio * ratio - variance).max(0.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulate::random_vehicle;
    use rand::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};
    use rand_pcg::Pcg64Mcg;

    const GRID: Grid = Grid { start_s: 0.0, step_s: 0.01, count: 4000 };

    /// Body rates about x and y of a trajectory with two harmonics, rad/s, and their derivative.
    fn motion(time_s: f64) -> (Vector3<f64>, Vector3<f64>) {
        let (a, b) = (1.9 * time_s, 3.1 * time_s + 0.4);
        let rate = Vector3::new(a.sin() + 0.5 * b.cos(), b.sin() - 0.4 * a.cos(), 0.0);
        let turning = Vector3::new(1.9 * a.cos() - 1.55 * b.sin(), 3.1 * b.cos() + 0.76 * a.sin(), 0.0);
        (rate, turning)
    }

    /// Shares of a flight whose logged torque alternates by `share`, with white noise of this size on each rotor, N; some commands are lost.
    fn shares(share: f64, noise_n: f64, source: ThrustSource) -> [f64; 2] {
        let vehicle = random_vehicle(4).truth;
        let rotors = vehicle.rotors.len();
        let mixer = vehicle.mixer().matrix;
        let mut generator = Pcg64Mcg::seed_from_u64(5);
        let mut thrusts = Stream { time_s: Vec::new(), width: rotors, values: Vec::new() };
        for sample in (0..GRID.count).filter(|sample| sample % 97 != 0) {
            let time_s = GRID.time_s(sample);
            let phase = if sample % 2 == 0 { 1.0 } else { -1.0 };
            let turning = motion(time_s).1 * (1.0 + phase * share);
            thrusts.time_s.push(time_s + 0.002);
            thrusts.values.extend((0..rotors).map(|rotor| {
                let noise: f64 = StandardNormal.sample(&mut generator);
                3.0 + mixer[(1, rotor)] * turning.x + mixer[(2, rotor)] * turning.y + noise_n * noise
            }));
        }
        let rate: Vec<Vector3<f64>> = (0..GRID.count).map(|at| motion(GRID.time_s(at)).0).collect();
        let usable = vec![true; GRID.count];
        alternating((&thrusts, source), &vehicle, (&GRID, &usable), Some(&rate))
    }

    #[test]
    fn a_torque_that_comes_in_pulses_alternates_by_their_share_through_lost_commands() {
        for share in shares(0.15, 0.0, ThrustSource::Command) {
            assert!((share - 0.15).abs() < 0.01, "{share}");
        }
        for share in shares(-0.08, 0.005, ThrustSource::Command) {
            assert!((share - 0.08).abs() < 0.02, "{share}");
        }
    }

    #[test]
    fn noise_and_measured_speeds_do_not_alternate() {
        assert!(shares(0.0, 0.0, ThrustSource::Command).iter().all(|share| *share < 1e-3));
        assert!(shares(0.0, 0.02, ThrustSource::Command).iter().all(|share| *share < 0.03));
        assert_eq!(shares(0.15, 0.0, ThrustSource::MeasuredSpeed), [0.0; 2]);
    }

    #[test]
    fn of_several_flights_each_alternates_by_itself() {
        let of = |rebuilt, x| TorqueError { rebuilt, alternating: [x, 0.0] };
        let all = TorqueError::of_all([of(0.0, 0.1), of(0.03, 0.1)].into_iter());
        assert_eq!(all.rebuilt, 0.03);
        assert!((all.alternating[0] - 0.1 / 2.0_f64.sqrt()).abs() < 1e-12 && all.alternating[1] == 0.0);
        assert!((all.of_moments()[0] - 0.5 * all.alternating[0]).abs() < 1e-12);
    }
}
