//! When a vehicle that nothing is known of was in the air.

use crate::recording::{Quantity, Recording, Stream};
use crate::signals::{best, in_air};

/// Command from which a motor does more than idle: autopilots let motors idle at up to this value. Chosen; not
/// measured.
const LEAST_COMMAND: f64 = 0.12;
/// Share of the largest actuation so far that carries a vehicle. Chosen; not measured.
const FLYING_SHARE: f64 = 0.2;
/// Time over which actuation is smoothed, s, so that a single sample at a bound is not a landing. Chosen; not measured.
const SMOOTHING_S: f64 = 0.3;
/// Shortest time in the air that counts, s. Chosen; not measured.
const SHORTEST_S: f64 = 2.0;

/// Motor outputs as fractions of full scale: the channels that move, pulse widths from 1000 to 2000 us.
pub(super) fn normalized_commands(recording: &Recording) -> Option<Stream> {
    let (_, raw) = best(recording, Quantity::ActuatorCommand, |_| true)?;
    let finite = || raw.values.iter().copied().filter(|value| value.is_finite());
    let in_microseconds = finite().fold(0.0, f64::max) > 2.5;
    let moves = |channel: &usize| {
        let mut values = (0..raw.len()).map(|i| raw.sample(i)[*channel]).filter(|value| value.is_finite());
        let first = values.next();
        values.any(|value| Some(value) != first)
    };
    let channels: Vec<usize> = (0..raw.width).filter(moves).collect();
    let fraction = |value: f64| if in_microseconds { (value - 1000.0) / 1000.0 } else { value };
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

/// Spans in the air, s, and what tells them. `effort_max` is the largest effort of the windows before.
pub(super) fn airborne(
    recording: &Recording,
    commands: Option<&Stream>,
    effort_max: &mut f64,
) -> (Vec<(f64, f64)>, &'static str) {
    let of = |quantity| {
        recording
            .streams
            .iter()
            .find(|(key, stream)| key.quantity == quantity && !stream.is_empty())
            .map(|(_, stream)| stream)
    };
    let landed = of(Quantity::LandedState);
    let said = |t_s: f64| landed.is_none_or(|landed| in_air(landed, t_s));
    if let Some((effort, idle, from)) = effort(recording, commands) {
        let flown = smoothed(&effort);
        *effort_max = flown.iter().copied().fold(*effort_max, f64::max);
        let needed = (FLYING_SHARE * *effort_max).max(idle);
        let flies = |i: usize| flown[i] > needed && said(effort.time_s[i]);
        let from = if landed.is_some() { "landed state and actuators" } else { from };
        return (spans(&effort.time_s, flies), from);
    }
    if let Some(landed) = landed {
        return (spans(&landed.time_s, |i| said(landed.time_s[i])), "landed state");
    }
    if let Some(armed) = of(Quantity::Armed) {
        return (spans(&armed.time_s, |i| armed.values[i] > 0.5), "armed");
    }
    let streams = || recording.streams.values();
    let first = streams().filter_map(|s| s.time_s.first()).copied().fold(f64::INFINITY, f64::min);
    let last = streams().filter_map(|s| s.time_s.last()).copied().fold(f64::NEG_INFINITY, f64::max);
    (vec![(first, last)], "nothing: all of it is taken as flight")
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

fn spans(time_s: &[f64], holds: impl Fn(usize) -> bool) -> Vec<(f64, f64)> {
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
    spans.retain(|(start, end)| end - start > SHORTEST_S);
    spans
}
