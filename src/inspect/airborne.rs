//! When a vehicle that nothing is known of was in the air.

use crate::autopilot::Autopilot;
use crate::recording::landed::MOVES;
use crate::recording::{Quantity, Recording, Stream};
use crate::signals::{LEAST_FREE_S, ReportedState, SHORTEST_FLIGHT_S, best, off_ground, spans, within};
use crate::stats::median;

/// Command from which a motor does more than idle: autopilots let motors idle at up to this value. ArduPilot's
/// MOT_SPIN_ARM is 0.1 by default.
const LEAST_COMMAND: f64 = 0.12;
/// So many samples of a channel behind one another, other than its median, are no damage: single ones are. A single
/// damaged sample is no flight.
const LEAST_CHANGED: usize = 3;
/// What an output may be as a fraction of full scale, reversed ones and pulses of 0 included: the rest is damage.
const OUTPUTS: std::ops::RangeInclusive<f64> = -1.0..=1.5;
/// Share of the largest actuation so far that carries a vehicle. Idling motors are below it.
const FLYING_SHARE: f64 = 0.2;
/// Time over which actuation is smoothed, s, so that a single sample at a bound is not a landing. Longer would hide a
/// hop.
const SMOOTHING_S: f64 = 0.3;
/// So many samples of it are no knock. A knock lasts for fewer.
const LEAST_MOVING: usize = 5;

/// Motor outputs as fractions of full scale: the channels that move, pulse widths from 1000 to 2000 us.
pub(super) fn normalized_commands(recording: &Recording) -> Option<Stream> {
    let (_, raw) = best(recording, Quantity::ActuatorCommand, |_| true)?;
    // a few that are damaged do not tell the unit
    let given = raw.values.iter().filter(|value| value.is_finite() && **value > 0.0);
    let (count, pulses) =
        given.fold((0_u64, 0_u64), |(count, pulses), value| (count + 1, pulses + u64::from(*value > 2.5)));
    let in_microseconds = 2 * pulses > count;
    let moves = |channel: &usize| {
        let values: Vec<f64> =
            (0..raw.len()).map(|i| raw.sample(i)[*channel]).filter(|value| value.is_finite()).collect();
        let rest = median(&mut values.clone());
        values.windows(LEAST_CHANGED).any(|values| values.iter().all(|value| *value != rest))
    };
    let channels: Vec<usize> = (0..raw.width).filter(moves).collect();
    let fraction = |value: f64| {
        let fraction = if in_microseconds { (value - 1000.0) / 1000.0 } else { value };
        if OUTPUTS.contains(&fraction) { fraction } else { f64::NAN }
    };
    let values = (0..raw.len())
        .flat_map(|i| channels.iter().map(move |&channel| fraction(raw.sample(i)[channel])))
        .collect();
    Some(Stream { time_s: raw.time_s.clone(), width: channels.len(), values })
}

/// What the rotors do, in any unit that grows with thrust, and what of it is certainly idling.
fn effort(recording: &Recording, commands: Option<&Stream>) -> Option<(Stream, f64, &'static str)> {
    let mean = |sample: &[f64], power: i32| {
        let (sum, count) = sample
            .iter()
            .filter(|value| value.is_finite())
            .fold((0.0, 0.0), |(sum, count), value| (sum + value.powi(power), count + 1.0));
        if count > 0.0 { sum / count } else { 0.0 }
    };
    let of = |stream: &Stream, power: i32| Stream {
        time_s: stream.time_s.clone(),
        width: 1,
        values: (0..stream.len()).map(|i| mean(stream.sample(i), power)).collect(),
    };
    if let Some((_, speeds)) = best(recording, Quantity::RotorSpeed, |_| true) {
        return Some((of(speeds, 2), 0.0, "rotor speeds"));
    }
    if let Some(commands) = commands {
        return Some((of(commands, 1), LEAST_COMMAND, "actuator outputs"));
    }
    let (_, wrench) = best(recording, Quantity::Wrench, |stream| stream.width == 4)?;
    let values = (0..wrench.len()).map(|i| wrench.sample(i)[0]).collect();
    Some((Stream { time_s: wrench.time_s.clone(), width: 1, values }, 0.0, "the recorded thrust"))
}

/// When a vehicle was in the air.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Airborne {
    /// spans off the ground, s
    pub flown_s: Vec<(f64, f64)>,
    /// the same without taking off and landing, if enough is left: what identification may use
    pub free_s: Vec<(f64, f64)>,
    /// what tells them
    pub from: &'static str,
}

/// What the windows before have shown.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Before {
    /// largest effort of the rotors
    effort_max: f64,
    /// the window before ended in the air
    in_air: bool,
}

/// When the vehicle of a recording was in the air: its rotors carry it, and neither does the autopilot say that it is disarmed
/// or has landed nor, where it does not tell of landing, does the vehicle stand still.
pub(super) fn airborne(recording: &Recording, commands: Option<&Stream>, before: &mut Before) -> Airborne {
    let said = ReportedState::of(recording);
    let found = match (effort(recording, commands), said.words()) {
        (Some((effort, idle, from)), _) => {
            let flown = smoothed(&effort);
            before.effort_max = flown.iter().copied().fold(before.effort_max, f64::max);
            let needed = (FLYING_SHARE * before.effort_max).max(idle);
            let from = if said.tells_landed() { "landed state and actuators" } else { from };
            Airborne::when(&effort.time_s, &said, from, |i| flown[i] > needed)
        }
        (None, Some(words)) => {
            let from = if said.tells_landed() { "landed state" } else { "armed and moving" };
            Airborne::when(&words.time_s, &said, from, |_| true)
        }
        (None, None) => {
            let streams = || recording.streams.values();
            let first = streams().filter_map(|s| s.time_s.first()).copied().fold(f64::INFINITY, f64::min);
            let last = streams().filter_map(|s| s.time_s.last()).copied().fold(f64::NEG_INFINITY, f64::max);
            match recording.autopilot {
                Autopilot::Unknown => {
                    let from = "nothing: all of it is taken as flight";
                    Airborne::when(&[first, last], &said, from, |_| true)
                }
                // nothing else tells: before it moves first and after it has moved last it stood
                _ => {
                    let (first, last) = moving_span(recording).unwrap_or((first, last));
                    Airborne::when(&[first, last], &said, "moving", |_| true)
                }
            }
        }
    };
    // a table's maker says that it is a flight, and an autopilot that it has not landed
    let found = if said.tells_landed() || recording.autopilot == Autopilot::Unknown {
        found
    } else {
        found.moving(recording, before.in_air)
    };
    let found = found.off_ground(recording);
    let end_s = found.flown_s.last().map(|(_, end_s)| *end_s);
    let streams = || recording.streams.values();
    let last_s = streams().filter_map(|s| s.time_s.last()).copied().fold(f64::NEG_INFINITY, f64::max);
    before.in_air = end_s.is_some_and(|end_s| last_s - end_s < SHORTEST_FLIGHT_S);
    found
}

impl Airborne {
    fn when(
        time_s: &[f64],
        said: &ReportedState<'_>,
        from: &'static str,
        carries: impl Fn(usize) -> bool,
    ) -> Self {
        let flown_s = spans(time_s, |i| carries(i) && said.may_be_off_ground(time_s[i]));
        let free_s = spans(time_s, |i| carries(i) && said.may_fly(time_s[i]));
        let seconds: f64 = free_s.iter().map(|(start_s, end_s)| end_s - start_s).sum();
        let free_s = if seconds < LEAST_FREE_S { flown_s.clone() } else { free_s };
        Self { flown_s, free_s, from }
    }

    /// Only what the height does not exclude.
    fn off_ground(mut self, recording: &Recording) -> Self {
        self.flown_s = off_ground(recording, self.flown_s);
        self.free_s = within(&self.free_s, &self.flown_s);
        for spans_s in [&mut self.flown_s, &mut self.free_s] {
            spans_s.retain(|(start_s, end_s)| end_s - start_s > SHORTEST_FLIGHT_S);
        }
        self
    }

    /// Only spans during which the vehicle moved. One that began in the window before has moved there.
    fn moving(mut self, recording: &Recording, began_before: bool) -> Self {
        let moved = |quantity| {
            best(recording, quantity, |stream| stream.width == 3).map(|(_, stream)| moving_times(stream))
        };
        let known: Vec<Vec<f64>> =
            [Quantity::AngularRate, Quantity::Velocity].into_iter().filter_map(moved).collect();
        if known.is_empty() {
            return self;
        }
        let first_s = self.flown_s.first().map(|(start_s, _)| *start_s);
        let is_flight = |(start_s, end_s): &(f64, f64)| {
            let inside = |times_s: &Vec<f64>| {
                times_s.iter().filter(|time_s| (*start_s..=*end_s).contains(time_s)).count() >= LEAST_MOVING
            };
            known.iter().any(inside) || began_before && first_s == Some(*start_s)
        };
        self.flown_s.retain(is_flight);
        // words of landing may be lost
        if let Some((first_s, last_s)) = moving_span(recording).filter(|_| recording.is_damaged) {
            let within = |(start_s, end_s): &(f64, f64)| (start_s.max(first_s), end_s.min(last_s));
            self.flown_s = self.flown_s.iter().map(within).collect();
            self.free_s = self.free_s.iter().map(within).collect();
            self.flown_s.retain(|(start_s, end_s)| end_s - start_s > SHORTEST_FLIGHT_S);
        }
        let flown_s = &self.flown_s;
        self.free_s.retain(|(start_s, end_s)| {
            flown_s.iter().any(|(from_s, to_s)| from_s <= start_s && end_s <= to_s)
        });
        self
    }
}

/// From the first time to the last at which a vehicle moves; `None` where nothing tells how it moves.
fn moving_span(recording: &Recording) -> Option<(f64, f64)> {
    let times_s = [Quantity::AngularRate, Quantity::Velocity].into_iter().filter_map(|quantity| {
        best(recording, quantity, |stream| stream.width == 3).map(|(_, stream)| moving_times(stream))
    });
    let spans = times_s.filter(|times_s| times_s.len() >= LEAST_MOVING);
    let spans = spans.filter_map(|times_s| Some((*times_s.first()?, *times_s.last()?)));
    spans.reduce(|(first, last), (from_s, to_s)| (f64::min(first, from_s), f64::max(last, to_s)))
}

/// When a rate or velocity is more than that of a vehicle that stands.
fn moving_times(stream: &Stream) -> Vec<f64> {
    let size = |index: usize| stream.sample(index).iter().map(|value| value * value).sum::<f64>().sqrt();
    (0..stream.len()).filter(|index| size(*index) > MOVES).map(|index| stream.time_s[index]).collect()
}

fn smoothed(effort: &Stream) -> Vec<f64> {
    let mut smooth = effort.values.first().copied().unwrap_or(0.0);
    let mut out = Vec::with_capacity(effort.len());
    for index in 0..effort.len() {
        let step_s = if index > 0 { effort.time_s[index] - effort.time_s[index - 1] } else { 0.0 };
        smooth += (step_s / SMOOTHING_S).clamp(0.0, 1.0) * (effort.values[index] - smooth);
        out.push(smooth);
    }
    out
}
