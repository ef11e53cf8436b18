//! Outputs that no longer follow the mixer: they stand still while the controllers and the other motors move.

use super::actuators::LONGEST_PULSE_US;
use super::reported_state::ReportedState;
use super::rotor_count::motors;
use super::select::{best, is_live};
use crate::recording::{Quantity, Recording, Stream};
use std::fmt;

/// An output that stands still for so long in the air does not follow a mixer whose other outputs move, s. Set by
/// judgement: an autopilot's controllers move every motor many times a second.
const HELD_S: f64 = 0.8;
/// The others move by so much of their range meanwhile, at least two of them. Less is within the resolution of a
/// pulse width in calm air.
const OTHERS_MOVE: f64 = 0.02;
/// An output within so much of its range from an end is at its bound: a saturated motor still follows its mixer.
const AT_BOUND: f64 = 0.03;
/// Below this share of the range a motor does not turn. Motors need more to start.
const STOPPED: f64 = 0.02;
/// Mean of the others, share of the range, from which on they carry the vehicle. Below it nothing is in the air.
const CARRYING: f64 = 0.15;

/// A pulse width is no shorter, us; commands as shares, percent or in the range of a byte are below it.
const LEAST_PULSE_US: f64 = 500.0;

/// An output that left the mixer in the air.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct OffMixer {
    /// from 1
    pub output: usize,
    /// s of the recording's clock: its first sample that stands still
    pub left_s: f64,
    /// what it then stands at, in the recording's unit
    pub held: f64,
    /// s: its first sample at which the motor is stopped
    pub stopped_s: Option<f64>,
}

impl OffMixer {
    /// For whoever wants to use the log.
    #[must_use]
    pub fn advice(&self) -> String {
        format!("warning: {self}. Nothing can be identified from the log after this time")
    }

    /// The same on a clock that shows so much more, s.
    #[must_use]
    pub fn later(self, by_s: f64) -> Self {
        Self {
            left_s: self.left_s + by_s,
            stopped_s: self.stopped_s.map(|stopped_s| stopped_s + by_s),
            ..self
        }
    }
}

impl fmt::Display for OffMixer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { output, left_s, held, stopped_s } = self;
        // larger than any other range of commands
        let unit = if *held >= LEAST_PULSE_US { " us" } else { "" };
        write!(f, "motor output {output} does not follow the controllers from {left_s:.1} s on")?;
        match stopped_s {
            Some(stopped_s) if stopped_s <= left_s => write!(f, ": it stops, at {held:.0}{unit}"),
            Some(stopped_s) => write!(f, ": it stays at {held:.0}{unit}, and stops at {stopped_s:.1} s"),
            None => write!(f, ": it stays at {held:.0}{unit}"),
        }?;
        f.write_str(", while the other motors follow them")
    }
}

/// The outputs of a flight that left the mixer in the air, in the order in which they did. What they were commanded from then on is in
/// the log: nothing hidden is between their command and the vehicle's answer.
#[must_use]
pub fn outputs_off_mixer(recording: &Recording) -> Vec<OffMixer> {
    let Some((_, stream)) = best(recording, Quantity::ActuatorCommand, is_live) else { return Vec::new() };
    let Some(range) = range_of(recording, stream) else { return Vec::new() };
    let said = ReportedState::of(recording);
    let motors = motors(stream, &said);
    if motors.len() < 3 {
        return Vec::new();
    }
    let outputs = Outputs { stream, range, motors: &motors, said };
    let mut found: Vec<OffMixer> = motors.iter().filter_map(|&channel| outputs.off(channel)).collect();
    found.sort_by(|a, b| a.left_s.total_cmp(&b.left_s));
    // from a stopped motor on the vehicle falls, and the others go to their bounds or come to rest on the ground
    let first_stop_s = found.iter().filter_map(|off| off.stopped_s).fold(f64::INFINITY, f64::min);
    found.retain(|off| off.left_s <= first_stop_s);
    // all at once is a vehicle that came to rest
    if 2 * found.len() > motors.len() { Vec::new() } else { found }
}

/// Ends of the outputs, in the recording's unit.
fn range_of(recording: &Recording, stream: &Stream) -> Option<(f64, f64)> {
    let most = stream.values.iter().copied().filter(|value| value.is_finite()).fold(0.0, f64::max);
    if most <= 1.05 {
        return Some((0.0, 1.0));
    }
    let parameter = |name: &str| recording.parameters.get(name).copied();
    let stack = recording.autopilot.stack();
    let stated = stack.and_then(|stack| stack.outputs.pulses.ends_us(parameter));
    let ends = stated.filter(|(low, high)| high > low).unwrap_or((1000.0, 2000.0));
    (most <= LONGEST_PULSE_US).then_some(ends)
}

/// The outputs of a flight.
struct Outputs<'a> {
    stream: &'a Stream,
    range: (f64, f64),
    motors: &'a [usize],
    said: ReportedState<'a>,
}

impl Outputs<'_> {
    /// Share of the range.
    fn share(&self, index: usize, channel: usize) -> f64 {
        (self.stream.sample(index)[channel] - self.range.0) / (self.range.1 - self.range.0)
    }

    /// Mean share of the other motors.
    fn others(&self, index: usize, channel: usize) -> f64 {
        let others = self.motors.iter().filter(|other| **other != channel);
        others.map(|&other| self.share(index, other)).sum::<f64>() / (self.motors.len() - 1) as f64
    }

    fn flies(&self, index: usize, channel: usize) -> bool {
        self.said.may_fly(self.stream.time_s[index]) && self.others(index, channel) > CARRYING
    }

    /// Where a channel left the mixer.
    fn off(&self, channel: usize) -> Option<OffMixer> {
        let mut from = 0;
        let mut has_flown = false;
        while from + 1 < self.stream.len() {
            let mut to = from + 1;
            let value = self.stream.sample(from)[channel];
            while to < self.stream.len() && self.stream.sample(to)[channel] == value {
                to += 1;
            }
            if has_flown && self.stands_apart(from..to, channel) {
                let stops =
                    |index: &usize| self.share(*index, channel) <= STOPPED && self.flies(*index, channel);
                let stopped = (from..self.stream.len()).find(stops);
                return Some(OffMixer {
                    output: channel + 1,
                    left_s: self.stream.time_s[from],
                    held: value,
                    stopped_s: stopped.map(|index| self.stream.time_s[index]),
                });
            }
            has_flown |= to - from < 4 && self.flies(from, channel) && self.share(from, channel) > CARRYING;
            from = to;
        }
        None
    }

    /// Whether a channel that stands still over these samples does so alone, away from its bounds, in the air.
    fn stands_apart(&self, samples: std::ops::Range<usize>, channel: usize) -> bool {
        let seconds = self.stream.time_s[samples.end - 1] - self.stream.time_s[samples.start];
        let share = self.share(samples.start, channel);
        // below the least command in flight a motor is stopped, not saturated
        let is_inside = (AT_BOUND..=1.0 - AT_BOUND).contains(&share) || share < -AT_BOUND;
        if seconds < HELD_S || !is_inside || !samples.clone().all(|index| self.flies(index, channel)) {
            return false;
        }
        let moves = |other: &&usize| {
            let shares = || samples.clone().map(|index| self.share(index, **other));
            shares().fold(f64::MIN, f64::max) - shares().fold(f64::MAX, f64::min) > OTHERS_MOVE
        };
        self.motors.iter().filter(|other| **other != channel).filter(moves).count() >= 2
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::StreamKey;

    /// Four outputs at 10 Hz that move against each other; the third does as `third` says.
    fn flight(third: impl Fn(usize, f64) -> f64) -> Recording {
        let mut stream = Stream { width: 4, ..Stream::default() };
        for index in 0..300 {
            let time_s = index as f64 * 0.1;
            stream.time_s.push(time_s);
            let of = |motor: f64| 1550.0 + 40.0 * (1.7 * time_s + motor).sin();
            stream.values.extend([of(0.0), of(1.0), third(index, of(2.0)), of(3.0)]);
        }
        let key = StreamKey { quantity: Quantity::ActuatorCommand, source: "RCOU", instance: 0 };
        Recording { streams: [(key, stream)].into(), ..Recording::default() }
    }

    #[test]
    fn an_output_that_sticks_and_then_stops_is_told_with_its_times() {
        let found = outputs_off_mixer(&flight(|index, mixed| match index {
            0..150 => mixed,
            150..170 => 1500.0,
            _ => 1000.0,
        }));
        assert_eq!(found.len(), 1);
        let OffMixer { output, left_s, held, stopped_s } = found[0];
        assert_eq!((output, held), (3, 1500.0));
        assert!((left_s - 15.0).abs() < 1e-9 && (stopped_s.unwrap() - 17.0).abs() < 1e-9);
        assert!(
            found[0]
                .to_string()
                .starts_with("motor output 3 does not follow the controllers from 15.0 s on: it stays at 1500 us, and stops at 17.0 s")
        );
    }

    #[test]
    fn an_output_that_follows_or_is_saturated_has_not_left() {
        assert!(outputs_off_mixer(&flight(|_, mixed| mixed)).is_empty());
        // at its bound, as a motor is that has to give all it can
        assert!(
            outputs_off_mixer(&flight(|index, mixed| if index < 150 { mixed } else { 2000.0 })).is_empty()
        );
        // for half a second
        let short = flight(|index, mixed| if (150..155).contains(&index) { 1500.0 } else { mixed });
        assert!(outputs_off_mixer(&short).is_empty());
    }
}
