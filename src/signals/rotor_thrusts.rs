//! One thrust a rotor along time, and where it comes from.

use super::sufficient::LEAST_TORQUE_HZ;
use crate::note::Note;
use crate::recording::Stream;

/// Source of the thrusts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ThrustSource {
    /// rotor speed sensors and the thrust coefficient
    MeasuredSpeed,
    /// commands sent to the motors and the thrust law
    Command,
    /// force and torque of the log itself
    Wrench,
}

/// Thrust of each rotor, N, at the time stamps of its source stream.
#[derive(Debug, Clone, PartialEq)]
pub struct RotorThrusts {
    /// width = number of rotors, N, vehicle's rotor order
    pub stream: Stream,
    /// normalised commands at the same time stamps if they are the source: for saturation
    pub command: Option<Stream>,
    /// thrust, N, that the commands' jitter adds if the rotors follow all of it; only if commands are the source
    pub jitter: Option<Stream>,
    /// source of the thrusts
    pub source: ThrustSource,
    /// message or column group
    pub message: &'static str,
    /// relative standard error that all torques about x and y have in common, where they are rebuilt from others
    pub torque_std: f64,
    /// notes on values from the log's parameters and on contradictions to the vehicle file
    pub notes: Vec<Note>,
}

/// Thrust of the commands' jitter, N. A thrust curve is convex, so a command with jitter gives more thrust than its
/// mean: `1/2 T'' sigma^2`. A rotor averages an unknown part of the jitter. The local sigma^2 is the squared fourth
/// difference divided by 70, which is exact for white jitter.
pub(super) fn jitter_thrust(command: &Stream, curvature_n: f64) -> Stream {
    let width = command.width;
    let mut out = Stream { time_s: command.time_s.clone(), width, values: vec![0.0; command.values.len()] };
    for index in 2..command.len().saturating_sub(2) {
        for rotor in 0..width {
            let at = |i: usize| command.sample(i)[rotor];
            let fourth =
                at(index - 2) - 4.0 * at(index - 1) + 6.0 * at(index) - 4.0 * at(index + 1) + at(index + 2);
            out.values[index * width + rotor] = 0.5 * curvature_n * fourth * fourth / 70.0;
        }
    }
    out
}

/// Longest interval over which three samples tell a curvature, s: that of the least rate at which torques are compared, and a fifth more for
/// jitter.
const CURVED_S: f64 = 1.2 / LEAST_TORQUE_HZ;
/// Shortest interval over the step of a grid. Instants of a grid that is no finer lie on the samples, where a straight line takes nothing.
const FINER: f64 = 1.5;

/// Thrusts moved so that straight lines between them have the mean of the curve through the given ones, to second order. They are for a
/// grid of this step, s.
///
/// Over an interval of length L a chord lies above its curve `T` by `L^2 T'' / 12` in the mean, so an oscillation of frequency f keeps
/// `1 - (2 pi f L)^2 / 12` of its size: 3 % are lost at 2.4 Hz and 25 samples a second. Each sample takes half of the correction of the
/// two intervals beside it, with `T''` by the second divided difference. White noise of the samples becomes larger by 17 %. No thrust
/// becomes negative.
pub(super) fn with_mean_of_curve(stream: &Stream, step_s: f64) -> Stream {
    let mut out = stream.clone();
    let width = stream.width;
    for index in 1..stream.len().saturating_sub(1) {
        let [before_s, here_s, after_s] = [index - 1, index, index + 1].map(|at| stream.time_s[at]);
        let (a, b) = (here_s - before_s, after_s - here_s);
        if !(a.min(b) > FINER * step_s && a.max(b) < CURVED_S) {
            continue;
        }
        let share = (a.powi(3) + b.powi(3)) / (12.0 * (a + b));
        let around = stream.sample(index - 1).iter().zip(stream.sample(index)).zip(stream.sample(index + 1));
        let to = &mut out.values[index * width..(index + 1) * width];
        for (to, ((before, here), after)) in to.iter_mut().zip(around) {
            let curvature = 2.0 * ((after - here) / b - (here - before) / a) / (a + b);
            if curvature.is_finite() {
                *to = (here - share * curvature).max(here.min(0.0));
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// What a straight line between samples leaves of a sine of 2 N at 2.4 Hz about 5 N, as a share of it.
    fn seen(stream: &Stream) -> f64 {
        const STEP_S: f64 = 1e-3;
        let at = |time_s: f64| {
            let after = stream.time_s.partition_point(|sample_s| *sample_s <= time_s);
            let (from, to) = (after - 1, after.min(stream.len() - 1));
            let apart = (stream.time_s[to] - stream.time_s[from]).max(f64::MIN_POSITIVE);
            let share = (time_s - stream.time_s[from]) / apart;
            stream.values[from] + share * (stream.values[to] - stream.values[from])
        };
        // 24 whole periods
        let part = |index: u32| {
            let time_s = 1.0 + f64::from(index) * STEP_S;
            at(time_s) * (TAU * 2.4 * time_s).sin()
        };
        (0..10_000).map(part).sum::<f64>() / 10_000.0
    }

    fn sine(time_s: Vec<f64>) -> Stream {
        let values = time_s.iter().map(|time_s| 5.0 + 2.0 * (TAU * 2.4 * time_s).sin()).collect();
        Stream { time_s, width: 1, values }
    }

    #[test]
    fn a_chord_takes_its_share_and_the_samples_make_up_for_it() {
        let even = sine((0..400).map(|index| 0.04 * f64::from(index)).collect());
        assert!((seen(&even) - 0.9702).abs() < 2e-3, "{}", seen(&even));
        assert!(
            (seen(&with_mean_of_curve(&even, 0.01)) - 1.0).abs() < 3e-3,
            "{}",
            seen(&with_mean_of_curve(&even, 0.01))
        );
        // of two intervals of different lengths the longer one takes more
        let uneven =
            sine((0..400).map(|index| 0.04 * f64::from(index) + 0.008 * f64::from(index % 2)).collect());
        let (plain, made_up) = (seen(&uneven), seen(&with_mean_of_curve(&uneven, 0.01)));
        assert!((plain - 1.0).abs() > 0.02 && (made_up - 1.0).abs() < 5e-3, "{plain} {made_up}");
    }

    #[test]
    fn what_lies_far_apart_tells_nothing_between_and_no_thrust_turns_negative() {
        let slow = sine((0..40).map(|index| 0.1 * f64::from(index)).collect());
        assert_eq!(with_mean_of_curve(&slow, 0.01), slow);
        let stopped = Stream { time_s: vec![0.0, 0.02, 0.04], width: 1, values: vec![4.0, 0.0, 4.0] };
        assert_eq!(with_mean_of_curve(&stopped, 0.01).values, [4.0, 0.0, 4.0]);
        // a straight line takes nothing at its ends
        let fast = sine((0..40).map(|index| 0.02 * f64::from(index)).collect());
        assert_eq!(with_mean_of_curve(&fast, 0.02), fast);
        assert_ne!(with_mean_of_curve(&fast, 0.004), fast);
    }
}
