//! The slow error of the velocity estimate, by the position of the same estimate.
//!
//! An estimator that integrates a noisy accelerometer leaves the velocity wrong by 0.1 to 0.3 m/s for ten seconds and more, while what it
//! corrects with (a receiver, a barometer, a camera) holds its position. The change of the position tells such an error: of motion that is
//! slower than the crossover the position gives the velocity, and of faster motion the velocity itself. Both are of one message, so that
//! frame, scale and stamps are the same. Where a satellite receiver's velocity is logged, the correction has to bring the velocity nearer to it.

use super::select::median_period_s;
use crate::recording::Stream;
use crate::stats::normal_sigma;
use nalgebra::Vector3;
use std::ops::Range;

/// Time constant of the crossover, s: 0.2 Hz. Against the velocity of a receiver, 0.2 to 0.8 Hz served alike in simulated flights of PX4,
/// and 0.1 to 0.2 Hz in flights of two real quadrotors.
const CROSSOVER_S: f64 = 0.8;
/// A slower message tells motion near the crossover wrongly, s.
const LONGEST_PERIOD_S: f64 = 0.25;
/// An interval of this many periods is a gap: nobody saw how the position moved.
const GAP_PERIODS: f64 = 5.0;
/// Departures of the position from its velocity within an interval, m/s, up to which they are an error of the velocity: no estimate is so wrong in
/// flight. A larger one is a jump of the position, unless this many robust standard deviations are more. A slow error that is larger is none of the
/// velocity either, and nothing is taken out.
const JUMP: (f64, f64) = (1.0, 6.0);
/// Share of intervals with a jump beyond which the position does not move as its velocity says, as where it is held between rare updates.
const MOST_JUMPS: f64 = 0.01;
/// Weight, of two for all that is near, below which nothing near was seen: the nearest is 2.4 s away.
const LEAST_WEIGHT: f64 = 0.05;
/// A slow error of less stays in the velocity, m/s rms of an axis in flight: the position's own errors are of this size. The estimates of ArduPilot, of
/// motion capture and of good inertial units are nearer to their positions.
const MATTERS_M_S: f64 = 0.05;
/// Latenesses of the receiver at which velocities are compared, s: from, to, step. Receivers are 0.1 to 0.2 s late.
const LATE_S: (f64, f64, f64) = (-0.1, 0.4, 0.02);
/// Fewer samples of a receiver tell nothing. They are 4 s at 5 Hz.
const LEAST_SAMPLES: usize = 20;

/// A message that has position and velocity, with what else the correction looks at.
#[derive(Debug, Clone, Copy)]
pub(super) struct Estimated<'a> {
    /// m, world
    pub(super) position: &'a Stream,
    /// m/s, world, at the same instants
    pub(super) velocity: &'a Stream,
    /// instants at which the estimator or its clock jumped, in order, s
    pub(super) resets_s: &'a [f64],
    /// s, from and to
    pub(super) airborne_s: &'a [(f64, f64)],
}

impl Estimated<'_> {
    /// The velocity without the error that the position tells, and whether that along the vertical is; `None` where it tells none, or where the
    /// velocity then is further from that of the receiver.
    pub(super) fn without_slow_error(&self, receiver: Option<&Stream>) -> Option<(Stream, bool)> {
        let error_m_s = self.slow_error_m_s()?;
        let mut out = self.velocity.clone();
        for (sample, error) in out.values.chunks_exact_mut(3).zip(&error_m_s) {
            sample.iter_mut().zip(error.iter()).for_each(|(value, error)| *value -= error);
        }
        let apart = |stream: &Stream, axes| apart_m_s(stream, receiver?, axes, self.airborne_s);
        let is_nearer = |axes: Range<usize>| {
            apart(&out, axes.clone()).zip(apart(self.velocity, axes)).map(|(with, without)| with < without)
        };
        let across = is_nearer(0..2).unwrap_or(true);
        let up = is_nearer(2..3).unwrap_or(across);
        for (sample, raw) in out.values.chunks_exact_mut(3).zip(self.velocity.values.chunks_exact(3)) {
            if !across {
                sample[..2].copy_from_slice(&raw[..2]);
            }
            if !up {
                sample[2] = raw[2];
            }
        }
        tracing::debug!(across, up, "nearer to the receiver with it");
        (across || up).then_some((out, up))
    }

    /// What the velocity exceeds that of the position by, slower than the crossover, m/s, one a sample.
    fn slow_error_m_s(&self) -> Option<Vec<Vector3<f64>>> {
        let (position, velocity) = (self.position, self.velocity);
        let period_s = median_period_s(velocity);
        let is_one_message = position.time_s == velocity.time_s && (position.width, velocity.width) == (3, 3);
        if !is_one_message || period_s.is_nan() || period_s > LONGEST_PERIOD_S {
            return None;
        }
        let at = |stream: &Stream, index: usize| Vector3::from_row_slice(stream.sample(index));
        let excess: Vec<Option<Vector3<f64>>> = (1..velocity.len())
            .map(|next| {
                let (from_s, to_s) = (velocity.time_s[next - 1], velocity.time_s[next]);
                let reset = self.resets_s.partition_point(|reset_s| *reset_s < from_s - period_s);
                let is_reset = self.resets_s.get(reset).is_some_and(|reset_s| *reset_s <= to_s + period_s);
                let moved = (at(position, next) - at(position, next - 1)) / (to_s - from_s);
                let said = (at(velocity, next) + at(velocity, next - 1)) / 2.0;
                let is_seen = to_s > from_s && to_s - from_s < GAP_PERIODS * period_s;
                (is_seen && !is_reset).then_some(said - moved)
            })
            .map(|excess| excess.filter(|excess| excess.iter().all(|part| part.is_finite())))
            .collect();
        let error_m_s = smoothed(&velocity.time_s, &without_jumps(excess)?);
        let errors = || velocity.time_s.iter().zip(&error_m_s);
        let flown = || errors().filter(|(t, _)| is_flown(self.airborne_s, **t)).map(|(_, error)| error);
        let squares: f64 = flown().map(Vector3::norm_squared).sum();
        let rms_m_s = (squares / (3 * flown().count().max(1)) as f64).sqrt();
        let is_possible = flown().all(|error| error.amax() < JUMP.0);
        tracing::debug!(rms_m_s, is_possible, "slow error of the velocity, by the position");
        (is_possible && rms_m_s > MATTERS_M_S).then_some(error_m_s)
    }
}

fn is_flown(airborne_s: &[(f64, f64)], t: f64) -> bool {
    airborne_s.iter().any(|(from_s, to_s)| (*from_s..=*to_s).contains(&t))
}

/// The excesses without those in which the position jumped; `None` where it jumps often.
fn without_jumps(mut excess: Vec<Option<Vector3<f64>>>) -> Option<Vec<Option<Vector3<f64>>>> {
    let bound: Vec<f64> = (0..3)
        .map(|axis| {
            let mut sizes: Vec<f64> = excess.iter().flatten().map(|excess| excess[axis].abs()).collect();
            (JUMP.1 * normal_sigma(&mut sizes)).max(JUMP.0)
        })
        .collect();
    let jumps = |excess: &Vector3<f64>| excess.iter().zip(&bound).any(|(part, bound)| part.abs() > *bound);
    let (mut seen, mut jumped) = (0_u32, 0_u32);
    for place in &mut excess {
        seen += u32::from(place.is_some());
        if place.as_ref().is_some_and(jumps) {
            (*place, jumped) = (None, jumped + 1);
        }
    }
    (f64::from(jumped) <= MOST_JUMPS * f64::from(seen)).then_some(excess)
}

/// Mean of what each interval between two instants has, at each instant: an interval at a distance of `t` weighs as `exp(-|t| / tau)` and its
/// length. None where nothing is near.
fn smoothed(time_s: &[f64], of_interval: &[Option<Vector3<f64>>]) -> Vec<Vector3<f64>> {
    let count = time_s.len();
    let mut sums = vec![(Vector3::zeros(), 0.0); count];
    let mut along = |order: &mut dyn Iterator<Item = (usize, usize)>| {
        let mut kept = (Vector3::zeros(), 0.0);
        for (interval, next) in order {
            // a clock that went back has no time between
            let length_s = (time_s[interval + 1] - time_s[interval]).max(0.0);
            let faded = (-length_s / CROSSOVER_S).exp();
            let weight = of_interval[interval].map_or(0.0, |_| 1.0 - faded);
            kept.0 = kept.0 * faded + of_interval[interval].unwrap_or_default() * weight;
            kept.1 = kept.1 * faded + weight;
            sums[next].0 += kept.0;
            sums[next].1 += kept.1;
        }
    };
    along(&mut (0..of_interval.len()).map(|interval| (interval, interval + 1)));
    along(&mut (0..of_interval.len()).rev().map(|interval| (interval, interval)));
    sums.into_iter()
        .map(|(sum, weight)| if weight > LEAST_WEIGHT { sum / weight } else { Vector3::zeros() })
        .collect()
}

/// Root mean square by which a velocity differs from a receiver's along these axes in flight, m/s, at the lateness at which it is least; `None` with too
/// few samples.
fn apart_m_s(
    velocity: &Stream,
    receiver: &Stream,
    axes: Range<usize>,
    airborne_s: &[(f64, f64)],
) -> Option<f64> {
    let (first_s, last_s) = (*velocity.time_s.first()? + LATE_S.1, *velocity.time_s.last()? + LATE_S.0);
    let is_told = |index: &usize| {
        let t = receiver.time_s[*index];
        let parts = &receiver.sample(*index)[axes.clone()];
        (first_s..last_s).contains(&t) && is_flown(airborne_s, t) && parts.iter().all(|part| part.is_finite())
    };
    let samples: Vec<usize> = (0..receiver.len()).filter(is_told).collect();
    let at = |t: f64, axis: usize| {
        let next = velocity.time_s.partition_point(|begin| *begin <= t).clamp(1, velocity.len() - 1);
        let (from_s, to_s) = (velocity.time_s[next - 1], velocity.time_s[next]);
        let share = (t - from_s) / (to_s - from_s);
        velocity.sample(next - 1)[axis] * (1.0 - share) + velocity.sample(next)[axis] * share
    };
    let tried =
        (0..).map(|step| LATE_S.0 + f64::from(step) * LATE_S.2).take_while(|late_s| *late_s < LATE_S.1);
    let squares = tried.map(|late_s| {
        let square = |&index: &usize| {
            let t = receiver.time_s[index] - late_s;
            axes.clone().map(|axis| (at(t, axis) - receiver.sample(index)[axis]).powi(2)).sum::<f64>()
        };
        samples.iter().map(square).filter(|square| square.is_finite()).sum::<f64>()
    });
    let least = squares.fold(f64::INFINITY, f64::min);
    (samples.len() >= LEAST_SAMPLES).then(|| (least / samples.len() as f64).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// 80 s at 25 Hz.
    fn instants_s() -> Vec<f64> {
        (0..2000).map(|i| 5.0 + 0.04 * f64::from(i)).collect()
    }

    fn stream(time_s: &[f64], of: impl Fn(f64) -> Vector3<f64>) -> Stream {
        let values = time_s.iter().flat_map(|t| of(*t).data.0[0]).collect();
        Stream { time_s: time_s.to_vec(), width: 3, values }
    }

    /// To and fro along x every 8 s, 2 m to each side.
    fn position_m(t: f64) -> Vector3<f64> {
        Vector3::x() * (2.0 * (TAU / 8.0 * t).sin())
    }

    fn velocity_m_s(t: f64) -> Vector3<f64> {
        Vector3::x() * (2.0 * TAU / 8.0 * (TAU / 8.0 * t).cos())
    }

    fn wave_m_s(hz: f64) -> impl Fn(f64) -> Vector3<f64> {
        move |t| Vector3::new(0.3, -0.2, 0.2) * (hz * TAU * t).sin()
    }

    fn corrected(position: &Stream, velocity: &Stream, receiver: Option<&Stream>) -> Option<Stream> {
        let airborne_s = &[(5.0, 90.0)];
        let estimated = Estimated { position, velocity, resets_s: &[], airborne_s };
        estimated.without_slow_error(receiver).map(|(stream, _)| stream)
    }

    /// Root mean square of the difference of two streams, m/s.
    fn apart(a: &Stream, b: &Stream) -> f64 {
        let squares = a.values.iter().zip(&b.values).map(|(a, b)| (a - b).powi(2));
        (squares.sum::<f64>() / a.len() as f64).sqrt()
    }

    #[test]
    fn a_slow_error_is_taken_out_and_fast_motion_stays() {
        let time_s = instants_s();
        let position = stream(&time_s, position_m);
        let right = stream(&time_s, velocity_m_s);
        let with = |error: &dyn Fn(f64) -> Vector3<f64>| {
            corrected(&position, &stream(&time_s, |t| velocity_m_s(t) + error(t)), None)
        };
        // an error that does not matter stays
        assert!(with(&|_| Vector3::zeros()).is_none() && with(&|_| Vector3::repeat(0.04)).is_none());
        assert!(apart(&with(&|_| Vector3::new(0.3, -0.1, 0.2)).unwrap(), &right) < 5e-3);
        // of 0.29 m/s with a period of 50 s a tenth is left
        assert!(apart(&with(&wave_m_s(0.02)).unwrap(), &right) < 0.03);
        // what is faster than the crossover stays with the velocity
        let fast = |t: f64| wave_m_s(3.0)(t);
        let found = with(&|t| fast(t) + Vector3::repeat(0.1)).unwrap();
        assert!(apart(&found, &stream(&time_s, |t| velocity_m_s(t) + fast(t))) < 0.02);
    }

    #[test]
    fn a_jump_a_gap_and_a_reset_tell_nothing() {
        let time_s: Vec<f64> = instants_s().into_iter().filter(|t| !(40.0..44.0).contains(t)).collect();
        let right = stream(&time_s, velocity_m_s);
        let velocity = stream(&time_s, |t| velocity_m_s(t) + Vector3::repeat(0.2));
        let jumped = |t: f64| if t > 60.0 { Vector3::new(5.0, 0.0, -1.0) } else { Vector3::zeros() };
        let position = stream(&time_s, |t| position_m(t) + jumped(t));
        assert!(apart(&corrected(&position, &velocity, None).unwrap(), &right) < 5e-3);
        // too small for a jump
        let moved = |t: f64| if t > 60.0 { Vector3::y() * 0.03 } else { Vector3::zeros() };
        let position = stream(&time_s, |t| position_m(t) + moved(t));
        let told = |resets_s: &[f64]| {
            let one =
                Estimated { position: &position, velocity: &velocity, resets_s, airborne_s: &[(5.0, 90.0)] };
            apart(&one.without_slow_error(None).unwrap().0, &right)
        };
        assert!(told(&[60.0]) < 0.5 * told(&[]));
    }

    #[test]
    fn a_position_that_is_held_or_slow_or_of_other_instants_tells_nothing() {
        let time_s = instants_s();
        let velocity = stream(&time_s, velocity_m_s);
        // five times a second, in a message of 25 Hz
        let held = stream(&time_s, |t| position_m((t * 5.0).floor() / 5.0));
        // late by 0.08 s in the mean, which is 0.1 m/s here
        assert!(corrected(&held, &velocity, None).is_none_or(|found| apart(&found, &velocity) < 0.1));
        let rarely_held = stream(&time_s, |t| position_m((t * 2.0).floor() / 2.0));
        assert!(corrected(&rarely_held, &velocity, None).is_none());
        let in_centimetres = stream(&time_s, |t| position_m(t) * 100.0);
        assert!(corrected(&in_centimetres, &velocity, None).is_none());
        let later: Vec<f64> = time_s.iter().map(|t| t + 0.01).collect();
        assert!(corrected(&stream(&later, position_m), &velocity, None).is_none());
        let each_second: Vec<f64> = time_s.iter().copied().step_by(25).collect();
        let slow = [stream(&each_second, position_m), stream(&each_second, velocity_m_s)];
        assert!(corrected(&slow[0], &slow[1], None).is_none());
    }

    #[test]
    fn a_receiver_keeps_what_the_position_makes_worse() {
        let time_s = instants_s();
        let velocity = stream(&time_s, |t| velocity_m_s(t) + wave_m_s(0.02)(t));
        // 0.12 s late, five times a second
        let late: Vec<f64> = time_s.iter().copied().step_by(5).collect();
        let receiver = stream(&late, |t| velocity_m_s(t - 0.12));
        let position = stream(&time_s, position_m);
        let right = stream(&time_s, velocity_m_s);
        assert!(apart(&corrected(&position, &velocity, Some(&receiver)).unwrap(), &right) < 0.03);
        // a height that wanders, 0.3 m/s, is left out, and one that does not say how fast it climbs follows the others
        let wanders = stream(&time_s, |t| position_m(t) + Vector3::z() * (3.0 * (0.1 * t).sin()));
        let airborne_s = &[(5.0, 90.0)];
        let estimated = Estimated { position: &wanders, velocity: &velocity, resets_s: &[], airborne_s };
        let (found, is_up) = estimated.without_slow_error(Some(&receiver)).unwrap();
        assert!(!is_up);
        let axis = |of: &Stream, axis: usize| -> Vec<f64> { of.values.chunks(3).map(|v| v[axis]).collect() };
        assert_eq!(axis(&found, 2), axis(&velocity, 2));
        assert!(axis(&found, 0) != axis(&velocity, 0));
        let level = stream(&late, |t| velocity_m_s(t - 0.12) + Vector3::z() * f64::NAN);
        assert!(axis(&corrected(&wanders, &velocity, Some(&level)).unwrap(), 2) != axis(&velocity, 2));
        // a receiver that agrees with the velocity as it is
        let receiver = stream(&late, |t| velocity_m_s(t) + wave_m_s(0.02)(t));
        assert!(corrected(&position, &velocity, Some(&receiver)).is_none());
    }
}
