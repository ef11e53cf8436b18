//! Spans in the air, without what the vehicle still, or again, spends on the ground.
//!
//! An autopilot says that it is off the ground from the moment when it raises the throttle for take-off, and a vehicle that crashed with
//! its motors on has not landed by its words. The height tells more.

use super::reported_state::DAMAGED_S;
use super::select::best;
use crate::recording::{Quantity, Recording, Stream};
use crate::stats::median;

/// A vehicle is off the ground once its height differs by so much from that on the ground, m. A barometer's noise and the pressure
/// under the rotors stay below it; lower there is the ground's own effect on the rotors.
const LIFTED_M: f64 = 0.3;
/// Height after a flight above that before it up to which the vehicle may stand on the ground, m: barometers and estimates drift. A
/// vehicle that stays above half of its greatest height hovers.
const DRIFT_M: f64 = 1.0;
/// Time before a span whose height is that of the ground, s. Longer reaches back to when the estimator settled.
const GROUND_S: f64 = 2.0;
/// The same at the end of a span. A vehicle that is disarmed may be on the last tenths of its way down before.
const REST_S: f64 = 0.5;
/// Shortest time in the air that counts, s. Less is a test of motors.
pub const SHORTEST_FLIGHT_S: f64 = 2.0;
/// So many samples tell a height.
const LEAST_SAMPLES: usize = 3;

/// The spans (s) of these times during which `holds` does, each longer than [`SHORTEST_FLIGHT_S`]. It is asked by place.
#[must_use]
pub fn spans(time_s: &[f64], holds: impl Fn(usize) -> bool) -> Vec<(f64, f64)> {
    let mut spans = Vec::new();
    let mut open = None;
    for (index, &t) in time_s.iter().enumerate() {
        match (holds(index), open) {
            (true, None) => open = Some(t),
            (false, Some(start)) => {
                spans.push((start, t));
                open = None;
            }
            _ => {}
        }
    }
    spans.extend(open.zip(time_s.last().copied()));
    spans.retain(|(start, end)| end - start > SHORTEST_FLIGHT_S);
    spans
}

/// The spans (s) between the vehicle's first and last height off the ground, each within the given one. A span during which it never
/// rises is none. Where nothing was recorded before a span, or no height at all, the span stays, and so does an end that the next span
/// follows at once: that is no landing.
pub fn off_ground(recording: &Recording, spans_s: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    let Some(heights) = Heights::of(recording) else { return spans_s };
    let margin_s = if recording.is_damaged { DAMAGED_S } else { 0.0 };
    let mut ground_m = None;
    let mut out = Vec::with_capacity(spans_s.len());
    for (place, &(from_s, to_s)) in spans_s.iter().enumerate() {
        let before_s = place.checked_sub(1).map_or(f64::NEG_INFINITY, |before| spans_s[before].1);
        let after_s = spans_s.get(place + 1).map_or(f64::INFINITY, |(from_s, _)| *from_s);
        let mut span_s = (from_s, to_s);
        if from_s - before_s > GROUND_S {
            ground_m = heights.ground(from_s);
            let Some(lifted_s) = heights.lifted_s(span_s, ground_m) else { continue };
            span_s.0 = lifted_s + margin_s;
        }
        if after_s - to_s > GROUND_S {
            span_s.1 = heights.down_s(span_s, ground_m) - margin_s;
        }
        out.push(span_s);
    }
    out.retain(|(from_s, to_s)| to_s > from_s);
    out
}

/// The spans (s) in the air of a flight in which a motor left the mixer at `failed_s`, until the vehicle is first down on the level from which it
/// took off: it fell, and bounces and running motors after that are no flight. All of them where that level is not known, or the vehicle
/// stays above it.
#[must_use]
pub fn until_down(recording: &Recording, mut spans_s: Vec<(f64, f64)>, failed_s: f64) -> Vec<(f64, f64)> {
    let down_s = Heights::of(recording).and_then(|heights| {
        let ground_m = spans_s.iter().find_map(|(from_s, _)| heights.ground(*from_s))?;
        let mut after = heights.between(failed_s, f64::INFINITY);
        let is_down = |index: &usize| heights.above(*index, ground_m) < LIFTED_M;
        after.find(is_down).map(|index| heights.stream.time_s[index])
    });
    if let Some(down_s) = down_s {
        spans_s.iter_mut().for_each(|(_, to_s)| *to_s = to_s.min(down_s));
        spans_s.retain(|(from_s, to_s)| to_s > from_s);
    }
    spans_s
}

/// What `spans_s` have in common with `limits_s`, both in order, s.
pub fn within(spans_s: &[(f64, f64)], limits_s: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let common = |span: &(f64, f64), limit: &(f64, f64)| (span.0.max(limit.0), span.1.min(limit.1));
    let pairs = spans_s.iter().flat_map(|span| limits_s.iter().map(move |limit| common(span, limit)));
    pairs.filter(|(from_s, to_s)| to_s > from_s).collect()
}

/// Height above any fixed level.
struct Heights<'a> {
    stream: &'a Stream,
    /// its place in a sample
    at: usize,
}

impl<'a> Heights<'a> {
    fn of(recording: &'a Recording) -> Option<Self> {
        let of = |quantity, width| best(recording, quantity, |stream| stream.width == width);
        let position = of(Quantity::Position, 3).map(|(_, stream)| Self { stream, at: 2 });
        let found = position
            .or_else(|| of(Quantity::BarometricHeight, 1).map(|(_, stream)| Self { stream, at: 0 }))?;
        // an estimate that never moves is none
        let heights = || (0..found.stream.len()).map(|index| found.height(index)).filter(|h| h.is_finite());
        let first = heights().next()?;
        heights().any(|height| height != first).then_some(found)
    }

    fn height(&self, index: usize) -> f64 {
        self.stream.sample(index)[self.at]
    }

    /// Places of the samples from one time to another, s.
    fn between(&self, from_s: f64, to_s: f64) -> std::ops::Range<usize> {
        let place = |time_s: f64| self.stream.time_s.partition_point(|t| *t < time_s);
        place(from_s)..place(to_s)
    }

    /// The middle one of the heights in a span, m.
    fn rest(&self, from_s: f64, to_s: f64) -> Option<f64> {
        let heights = self.between(from_s, to_s).map(|index| self.height(index));
        let mut heights: Vec<f64> = heights.filter(|height| height.is_finite()).collect();
        (heights.len() >= LEAST_SAMPLES).then(|| median(&mut heights))
    }

    /// Height of the ground before a span that begins at `from_s`, m: there the vehicle stands for some time. A log that begins in the
    /// air has no ground there.
    fn ground(&self, from_s: f64) -> Option<f64> {
        let halves =
            [from_s - GROUND_S, from_s - 0.5 * GROUND_S].map(|at_s| self.rest(at_s, at_s + 0.5 * GROUND_S));
        let [Some(earlier), Some(later)] = halves else { return None };
        ((later - earlier).abs() < LIFTED_M).then_some(later)
    }

    /// Height above `level_m`, m. One sample that is damaged is no height.
    fn above(&self, index: usize, level_m: f64) -> f64 {
        let around = index.saturating_sub(1)..(index + 2).min(self.stream.len());
        let mut heights: Vec<f64> = around.map(|index| self.height(index)).collect();
        median(&mut heights) - level_m
    }

    /// Whether the vehicle is off `level_m`.
    fn is_off(&self, index: usize, level_m: f64) -> bool {
        self.above(index, level_m).abs() > LIFTED_M
    }

    /// When it leaves the ground, s; `None` where it never does. At once where the ground is not known.
    fn lifted_s(&self, (from_s, to_s): (f64, f64), ground_m: Option<f64>) -> Option<f64> {
        let Some(ground_m) = ground_m else { return Some(from_s) };
        let mut inside = self.between(from_s, to_s);
        inside.find(|index| self.is_off(*index, ground_m)).map(|index| self.stream.time_s[index])
    }

    /// When it is on the ground again, s: at the end where it does not come down before.
    fn down_s(&self, (from_s, to_s): (f64, f64), ground_m: Option<f64>) -> f64 {
        let Some(ground_m) = ground_m else { return to_s };
        let inside = self.between(from_s, to_s);
        let highest_m = inside.clone().map(|index| self.height(index) - ground_m).fold(0.0, f64::max);
        let is_ground = |rest_m: &f64| rest_m - ground_m < DRIFT_M.min(0.5 * highest_m);
        let Some(rest_m) = self.rest(to_s - REST_S, to_s + REST_S).filter(is_ground) else { return to_s };
        let mut inside = inside;
        inside.rfind(|index| self.is_off(*index, rest_m)).map_or(to_s, |index| self.stream.time_s[index])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::StreamKey;

    /// Heights by time, every 0.1 s.
    fn recorded(from_s: f64, to_s: f64, height_m: impl Fn(f64) -> f64) -> Recording {
        let count = ((to_s - from_s) / 0.1).round();
        let time_s: Vec<f64> =
            (0..10_000).map(f64::from).take_while(|index| *index < count).map(|i| from_s + 0.1 * i).collect();
        let values = time_s.iter().map(|t_s| height_m(*t_s)).collect();
        let key = StreamKey { quantity: Quantity::BarometricHeight, source: "test", instance: 0 };
        Recording { streams: [(key, Stream { time_s, width: 1, values })].into(), ..Recording::default() }
    }

    fn about(found: &[(f64, f64)], expected: &[(f64, f64)]) {
        assert_eq!(found.len(), expected.len(), "{found:?}");
        for (found, expected) in found.iter().zip(expected) {
            assert!(
                (found.0 - expected.0).abs() < 0.15 && (found.1 - expected.1).abs() < 0.15,
                "{found:?} {expected:?}"
            );
        }
    }

    #[test]
    fn a_flight_is_from_lift_off_to_touch_down() {
        // up by 1 m/s from 5 s on, down by 1 m/s from 15 s on; armed and "not landed" from 2 to 25 s
        let flight = recorded(0.0, 30.0, |t_s| (t_s - 5.0).min(18.0 - t_s).clamp(0.0, 3.0));
        about(&off_ground(&flight, vec![(2.0, 25.0)]), &[(5.4, 17.6)]);
        // it fell from 3 m onto ground that is 0.8 m lower, and lay there with its motors on
        let crash = recorded(0.0, 26.0, |t_s| if t_s < 20.0 { (t_s - 5.0).clamp(0.0, 3.0) } else { -0.8 });
        about(&off_ground(&crash, vec![(2.0, 26.0)]), &[(5.4, 19.9)]);
    }

    #[test]
    fn a_vehicle_that_fell_does_not_fly_when_it_bounces() {
        // it falls from 3 m at 15 s, the estimate overshoots, and it bounces until the end
        let height_m = |t_s: f64| match t_s {
            ..15.0 => (t_s - 5.0).clamp(0.0, 3.0),
            15.0..16.0 => 3.0 - 5.0 * (t_s - 15.0),
            _ => 2.0 * (t_s - 16.0).sin(),
        };
        let (flight, spans_s) = (recorded(0.0, 30.0, height_m), vec![(5.4, 29.0)]);
        about(&until_down(&flight, spans_s.clone(), 14.0), &[(5.4, 15.6)]);
        // what comes before the motor failed is flight
        about(
            &until_down(&flight, vec![(5.4, 12.0), (12.5, 20.0), (22.0, 29.0)], 14.0),
            &[(5.4, 12.0), (12.5, 15.6)],
        );
        // one that stays up, and one whose ground is not known
        let up = recorded(0.0, 30.0, |t_s| (t_s - 5.0).clamp(0.0, 3.0));
        assert_eq!(until_down(&up, spans_s.clone(), 14.0), spans_s);
        assert_eq!(until_down(&recorded(5.0, 30.0, height_m), spans_s.clone(), 14.0), spans_s);
    }

    #[test]
    fn a_pause_in_the_air_is_no_landing() {
        let flight = recorded(0.0, 30.0, |t_s| (t_s - 5.0).min(28.0 - t_s).clamp(0.0, 3.0));
        let spans_s = vec![(4.0, 12.0), (12.5, 29.0)];
        about(&off_ground(&flight, spans_s), &[(5.4, 12.0), (12.5, 27.6)]);
        assert_eq!(
            within(&[(1.0, 4.0), (5.0, 9.0)], &[(2.0, 6.0), (8.0, 8.5)]),
            [(2.0, 4.0), (5.0, 6.0), (8.0, 8.5)]
        );
    }

    #[test]
    fn a_vehicle_that_never_rises_does_not_fly() {
        let on_ground = recorded(0.0, 30.0, |t_s| 0.1 * (7.0 * t_s).sin());
        assert_eq!(off_ground(&on_ground, vec![(5.0, 25.0)]), []);
    }

    #[test]
    fn what_the_height_does_not_tell_stays() {
        let span = vec![(5.0, 25.0)];
        // recorded from the middle of a flight to its middle, at one height
        let hover = recorded(5.0, 25.0, |t_s| 4.0 + 0.1 * t_s.sin());
        assert_eq!(off_ground(&hover, span.clone()), span);
        // low, and cut or disarmed there
        let low = recorded(0.0, 25.0, |t_s| (t_s - 5.0).clamp(0.0, 0.5));
        about(&off_ground(&low, vec![(4.0, 25.0)]), &[(5.4, 25.0)]);
        // a pause in a hover, to the log's end
        let pause = recorded(0.0, 25.0, |t_s| (t_s - 5.0).clamp(0.0, 2.0));
        about(&off_ground(&pause, vec![(4.0, 12.0), (12.5, 25.0)]), &[(5.4, 12.0), (12.5, 25.0)]);
        // disarmed in the air, up there
        let stopped = recorded(0.0, 25.0, |t_s| (t_s - 5.0).clamp(0.0, 4.0));
        about(&off_ground(&stopped, vec![(4.0, 25.0)]), &[(5.4, 25.0)]);
        // no height
        assert_eq!(off_ground(&Recording::default(), span.clone()), span);
        assert_eq!(off_ground(&recorded(0.0, 30.0, |_| 0.0), span.clone()), span);
    }
}
