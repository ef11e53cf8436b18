//! The log of the ground station and the log of the vehicle, if both hold the same flight.

use super::flight::{Flight, LoggedBy};
use crate::note::{About, Note};
use crate::recording::{Quantity, Recording, StreamKey};
use crate::signals::{ClockOffset, best, clock_offset, mean_rate_hz};
use std::collections::BTreeSet;

/// What an estimate or a name rests on.
const USED: [Quantity; 10] = [
    Quantity::ActuatorCommand,
    Quantity::RotorSpeed,
    Quantity::AngularRate,
    Quantity::SpecificForce,
    Quantity::Attitude,
    Quantity::Velocity,
    Quantity::Position,
    Quantity::BatteryVoltage,
    Quantity::PositionSetpoint,
    Quantity::AccelerationSetpoint,
];

/// What the vehicle says of its state: in its own log as well, and often in other words than over the link, where taking off
/// and landing are no flight.
const STATES: [Quantity; 3] = [Quantity::Armed, Quantity::LandedState, Quantity::Mode];

/// Least share of the flight that a stream of the ground station must cover to replace one of the vehicle's. With
/// less the flight would have two readings of one quantity.
const LEAST_COVERED: f64 = 0.9;

/// The same of what the ground station commanded. A log holds time on the ground as well, where nothing is commanded. Set by judgement: of
/// logs that begin with the vehicle's start, flights of 60 s were half.
const LEAST_COMMANDED: f64 = 0.3;
/// What the ground station commanded, before the autopilot made it its own.
const COMMANDED: [Quantity; 4] = [
    Quantity::PositionSetpoint,
    Quantity::VelocitySetpoint,
    Quantity::AccelerationSetpoint,
    Quantity::YawSetpoint,
];

/// Each flight once: what the ground station logged of a flight that the vehicle logged as well is brought to the vehicle's
/// clock and becomes part of that flight. A log without another flight is left out.
pub(super) fn each_flight_once(logs: Vec<Vec<Flight>>) -> Vec<Vec<Flight>> {
    let count = logs.len();
    let numbered = logs
        .into_iter()
        .enumerate()
        .flat_map(|(log, flights)| flights.into_iter().map(move |flight| (log, flight)));
    let (sent, mut kept): (Vec<_>, Vec<_>) =
        numbered.partition(|(_, flight)| flight.logged_by == LoggedBy::GroundStation);
    let mut alone = Vec::new();
    for (log, flight) in sent {
        let twin = kept.iter_mut().filter(|(_, other)| other.may_be(&flight)).find_map(|(_, other)| {
            let offset = clock_offset(&other.recording, &flight.recording)?;
            Some((other, offset))
        });
        match twin {
            Some((other, offset)) => add(other, flight, offset),
            None => alone.push((log, flight)),
        }
    }
    kept.extend(alone);
    let mut logs: Vec<Vec<Flight>> = (0..count).map(|_| Vec::new()).collect();
    kept.into_iter().for_each(|(log, flight)| logs[log].push(flight));
    logs.retain(|log| !log.is_empty());
    logs
}

impl Flight {
    /// Whether it may be the flight that a ground station logged.
    fn may_be(&self, sent: &Self) -> bool {
        self.logged_by == LoggedBy::Vehicle
            && self.input.other_logs.is_empty()
            && self.recording.autopilot == sent.recording.autopilot
    }
}

/// Adds what the ground station logged to what the vehicle logged of the same flight, and says so.
fn add(onboard: &mut Flight, sent: Flight, offset: ClockOffset) {
    let own: BTreeSet<StreamKey> = onboard.recording.streams.keys().copied().collect();
    let mut sent = sent;
    onboard.start_utc_us = onboard.start_utc_us.or(sent.start_utc_us);
    let part = leave_out_parts(&mut sent.recording, &onboard.recording, &offset);
    onboard.recording.add_log(sent.recording, |time_s| offset.on_first(time_s));
    let runs = match offset.drift {
        0.0 => String::new(),
        drift => format!(", and {:.0} parts in a million fast", 1e6 * drift),
    };
    let text = format!(
        "{} holds the same flight. Its clock is {:.2} +- {:.2} ms ahead{runs}, and its streams are brought to the clock of this \
         log{part}. {}",
        sent.input.path,
        1e3 * offset.late_s,
        1e3 * offset.std_s,
        taken_from(&onboard.recording, &own)
    );
    onboard.input.notes.push(Note::remark(About::File(onboard.input.path.clone()), text));
    onboard.input.add_log(sent.input);
}

/// Leaves out streams that cover only a part of the flight, and words of the vehicle's state, if the vehicle's log has the
/// quantity itself; says so of the former.
fn leave_out_parts(sent: &mut Recording, onboard: &Recording, offset: &ClockOffset) -> &'static str {
    let has: BTreeSet<Quantity> = onboard.streams.keys().map(|key| key.quantity).collect();
    sent.streams.retain(|key, _| !(STATES.contains(&key.quantity) && has.contains(&key.quantity)));
    let Some((_, attitude)) = best(onboard, Quantity::Attitude, |_| true) else { return "" };
    let (Some(from_s), Some(to_s)) = (attitude.time_s.first(), attitude.time_s.last()) else { return "" };
    let before = sent.streams.len();
    sent.streams.retain(|key, stream| {
        let least = if COMMANDED.contains(&key.quantity) { LEAST_COMMANDED } else { LEAST_COVERED };
        let covers = match (stream.time_s.first(), stream.time_s.last()) {
            (Some(first), Some(last)) => {
                offset.on_first(*last).min(*to_s) - offset.on_first(*first).max(*from_s)
                    > least * (to_s - from_s)
            }
            _ => false,
        };
        covers || !has.contains(&key.quantity)
    });
    if sent.streams.len() < before { "; what covers only a part of the flight is left out" } else { "" }
}

/// Which streams are better in the log that was added than the `own` ones.
fn taken_from(flight: &Recording, own: &BTreeSet<StreamKey>) -> String {
    let better: Vec<String> = USED
        .iter()
        .filter_map(|quantity| best(flight, *quantity, |_| true))
        .filter(|(key, _)| !own.contains(key))
        .map(|(key, stream)| {
            format!(
                "{} ({}, {:.0} Hz)",
                key.quantity.name().replace('_', " "),
                key.source,
                mean_rate_hz(stream)
            )
        })
        .collect();
    if better.is_empty() {
        return "All streams of this log are as good or better and are used".to_owned();
    }
    format!("From it come {}; all else is from this log", better.join(", "))
}
