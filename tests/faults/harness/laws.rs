//! What must hold on every flight, whatever goes wrong. Each law reads a trace and says how it was broken.

use std::time::Duration;

use mavid::fly::{Cause, Ending};

use super::ours::{Given, Ours};
use super::trace::{Entry, Observation, Part, Report, Trace};
use super::wire::{Left, SetpointSeen};

/// News of the mode counts so long after it came to the socket: two looks at the clock.
const TOLD: Duration = Duration::from_millis(25);
/// A setpoint that was made in the same instant may still be on its way out.
const SETPOINT_TOLD: Duration = Duration::from_millis(130);
/// The mode is known while a report of it is no older.
const KNOWN: Duration = Duration::from_millis(1500);
/// A report that came to the socket so long before the reason of a command may be read after it: a standstill of less than
/// 100 ms is none.
const SHORT: Duration = Duration::from_millis(110);
/// A setpoint leaves so long after it was made at most.
const SETPOINT_AGE: Duration = Duration::from_millis(100);
/// Setpoints end after so long a silence of the vehicle.
const SILENCE: Duration = Duration::from_millis(5100);
/// Setpoints end so long after a part of the program stands still: 100 ms, and a period of 20 ms with two looks at the clock.
const STANDSTILL: Duration = Duration::from_millis(145);
/// Beyond the room, m.
const ROOM_M: f64 = 0.1;

/// The laws.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Law {
    /// nothing that steers or commands after another mode than ours was reported
    Takeover,
    /// nothing is commanded but on a report of our mode that came after its reason
    Stale,
    /// no setpoint is old
    Age,
    /// no setpoint outside the room, or below the floor once it was above
    Room,
    /// setpoints end at 5 s of silence
    Silence,
    /// setpoints end where a part of the program stands still, and nothing is commanded
    Standstill,
    /// what leaves decodes, with values in range
    Range,
    /// the vehicle is on the ground, or in a mode that is safe without us, and the program says so
    End,
    /// every vehicle frame that was read is in the recording
    Log,
    /// the program ends
    Time,
    /// the program does not panic
    Panic,
}

/// A law that was broken: when and how.
#[derive(Debug, Clone, PartialEq)]
pub struct Broken {
    pub law: Law,
    pub at: Duration,
    pub how: String,
}

fn broken(law: Law, at: Duration, how: impl Into<String>) -> Option<Broken> {
    Some(Broken { law, at, how: how.into() })
}

/// All laws that a trace can tell of; the first breach of each.
pub fn check(trace: &Trace, given: &Given) -> Vec<Broken> {
    [
        takeover(trace, given),
        stale(trace, given),
        age(trace),
        room(trace, given),
        silence(trace),
        standstill(trace),
        range(trace),
        end(trace, given),
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// When the vehicle itself was first in a mode that is not of our doing, and which.
fn taken(trace: &Trace, given: &Given) -> Option<(Duration, u32)> {
    let mut ours = Ours::new(given);
    let mut armed = false;
    for Entry { at, observation } in &trace.entries {
        match observation {
            Observation::Left(left) => ours.left(left),
            Observation::Vehicle(state) => {
                // one that has landed chooses what it rests in
                if armed && !state.armed {
                    return None;
                }
                armed = state.armed;
                if !ours.admits(state.custom_mode) {
                    return Some((*at, state.custom_mode));
                }
            }
            _ => {}
        }
    }
    None
}

/// When the program was told so: the first genuine report of it at its socket.
fn told(trace: &Trace, given: &Given) -> Option<(Duration, Duration, u32)> {
    let (taken, mode) = taken(trace, given)?;
    let mut latest = Duration::ZERO;
    trace.entries.iter().find_map(|Entry { at, observation }| match observation {
        Observation::Reached(Report { mode: reported, said: Some(said), .. }) => {
            // one that a later one has overtaken says nothing: that one tells whether it is still so
            let news = *said >= latest;
            latest = latest.max(*said);
            (news && *reported == mode && *said >= taken).then_some((*at, taken, mode))
        }
        _ => None,
    })
}

fn takeover(trace: &Trace, given: &Given) -> Option<Broken> {
    let (told, taken, mode) = told(trace, given)?;
    trace.entries.iter().find_map(|Entry { at, observation }| {
        let Observation::Left(left) = observation else { return None };
        let late = if left.commands() { TOLD } else { SETPOINT_TOLD };
        let steers = left.commands() || matches!(left, Left::Setpoint(_));
        if !steers || *at <= told + late || by_the_operator(trace, *at) {
            return None;
        }
        let (taken_s, told_s) = (taken.as_secs_f64(), told.as_secs_f64());
        broken(
            Law::Takeover,
            *at,
            format!("{left:?}; mode {mode:#x} since {taken_s:.3}, told of it at {told_s:.3}"),
        )
    })
}

/// The operator's own keys are his.
fn by_the_operator(trace: &Trace, at: Duration) -> bool {
    trace.entries.iter().any(|entry| {
        entry.at <= at && matches!(&entry.observation, Observation::Fault(what) if what.starts_with("Key"))
    })
}

fn stale(trace: &Trace, given: &Given) -> Option<Broken> {
    let mut ours = Ours::new(given);
    // the reason of what is commanded next, the last command, and the last report of our mode: when it came to the socket
    let (mut reason, mut last, mut report) = (None::<Duration>, None::<Left>, None::<Duration>);
    // when a report of another mode was heard, with the report of ours before it; the latest that the vehicle itself said
    let (mut lost, mut said) = (None::<(Duration, Option<Duration>)>, Duration::ZERO);
    for Entry { at, observation } in &trace.entries {
        match observation {
            Observation::Note(note) if note.kind == "abort" || note.kind == "phase" => {
                let calls =
                    note.kind == "abort" || ["hold", "land", "return", "arm"].contains(&note.text.as_str());
                if calls {
                    reason.get_or_insert(*at);
                } else {
                    reason = None;
                }
            }
            Observation::Heard(heard, came) => {
                // one that others had overtaken says nothing
                if heard.said.is_some_and(|at| at < said) {
                    continue;
                }
                said = heard.said.unwrap_or(said);
                let ours = ours.admits(heard.mode);
                if !ours && report.is_some() {
                    lost = Some((*at, report));
                }
                report = ours.then_some(*came);
            }
            Observation::Left(left) if left.commands() => {
                let engages = matches!(left, Left::Mode(mode) if *mode == given.external());
                ours.left(left);
                // made in the same instant, it may still have been on its way out
                let before = lost.filter(|(lost, _)| *at <= *lost + TOLD).and_then(|(_, before)| before);
                let report = report.or(before);
                if engages || by_the_operator(trace, *at) {
                    continue;
                }
                let known = report.is_some_and(|came| *at - came <= KNOWN);
                let after = last.as_ref() == Some(left)
                    || matches!(left, Left::Takeoff(_))
                    || reason.is_none_or(|reason| report.is_some_and(|came| came + SHORT > reason));
                if !known || !after {
                    let report =
                        report.map_or("none".to_owned(), |came| format!("{:.3}", came.as_secs_f64()));
                    let why = reason.map_or(0.0, |reason| reason.as_secs_f64());
                    return broken(
                        Law::Stale,
                        *at,
                        format!("{left:?} for a reason of {why:.3}, with a report of our mode of {report}"),
                    );
                }
                last = Some(left.clone());
                reason = None;
            }
            Observation::Left(left) => ours.left(left),
            _ => {}
        }
    }
    None
}

fn setpoints(trace: &Trace) -> impl Iterator<Item = (Duration, &SetpointSeen)> {
    trace.entries.iter().filter_map(|entry| match &entry.observation {
        Observation::Left(Left::Setpoint(setpoint)) => Some((entry.at, setpoint)),
        _ => None,
    })
}

fn age(trace: &Trace) -> Option<Broken> {
    setpoints(trace).find(|(at, setpoint)| at.saturating_sub(setpoint.made) > SETPOINT_AGE).and_then(
        |(at, setpoint)| {
            broken(Law::Age, at, format!("a setpoint made at {:.3}", setpoint.made.as_secs_f64()))
        },
    )
}

fn room(trace: &Trace, given: &Given) -> Option<Broken> {
    let [x_m, y_m, low_m, high_m] = given.room_m;
    let takes_off = |entry: &&Entry| matches!(&entry.observation, Observation::Note(note) if note.kind == "phase" && note.text == "take off");
    let flies = |entry: &&Entry| matches!(&entry.observation, Observation::Vehicle(state) if !state.landed);
    let up = trace.entries.iter().find(takes_off).or_else(|| trace.entries.iter().find(flies));
    let up = up.map_or(Duration::MAX, |entry| entry.at);
    let (_, first) =
        setpoints(trace).take_while(|(at, _)| *at <= up).last().or_else(|| setpoints(trace).next())?;
    let origin = if given.here { [first.position_m[0], first.position_m[1]] } else { [0.0, 0.0] };
    // both lots of ground are flat and at zero, of which an estimate may be off before it takes off
    let jumps =
        trace.entries.iter().filter(|entry| entry.at <= up).filter_map(|entry| match entry.observation {
            Observation::Jumped(by_m) => Some(by_m),
            _ => None,
        });
    let ground_m: f64 = jumps.sum();
    let mut above = false;
    setpoints(trace).find_map(|(at, setpoint)| {
        let [x, y, z] = setpoint.position_m;
        // what stands on the ground is told to stay where its estimate says that it is
        let (x, y, z) = match (at <= up, given.here) {
            (false, _) => (x, y, z - ground_m),
            (true, false) => (x, y, 0.0),
            (true, true) => return None,
        };
        above |= z >= low_m;
        let floor_m = if above { low_m } else { -0.3 };
        let outside = [(x - origin[0]).abs() - x_m, (y - origin[1]).abs() - y_m, z - high_m, floor_m - z];
        let worst_m = outside.into_iter().fold(f64::NEG_INFINITY, f64::max);
        (worst_m > ROOM_M).then(|| Broken {
            law: Law::Room,
            at,
            how: format!("a setpoint {worst_m:.2} m outside: {x:.2} {y:.2} {z:.2}"),
        })
    })
}

fn silence(trace: &Trace) -> Option<Broken> {
    let mut heard = Duration::ZERO;
    trace.entries.iter().find_map(|Entry { at, observation }| match observation {
        Observation::Came => {
            heard = *at;
            None
        }
        Observation::Left(Left::Setpoint(_)) if *at - heard > SILENCE => broken(
            Law::Silence,
            *at,
            format!("a setpoint {:.2} s after a frame", (*at - heard).as_secs_f64()),
        ),
        _ => None,
    })
}

fn standstill(trace: &Trace) -> Option<Broken> {
    // which part, since when, until when, and whether that can be told
    let mut stands: Vec<(Part, Duration, Duration, bool)> = Vec::new();
    trace.entries.iter().find_map(|Entry { at, observation }| match observation {
        Observation::Parked(part, until) => {
            // one that stands already goes on standing
            let before = stands.iter().filter(|(other, _, to, _)| other == part && to >= at);
            let before = before.map(|(_, from, _, told)| (*from, *told)).min();
            let (from, told) = before.unwrap_or((*at, *part != Part::Telemetry));
            stands.push((*part, from, *until, told));
            None
        }
        // where nothing comes, nothing of it stands still
        Observation::Came => {
            for stood in stands.iter_mut().filter(|stood| stood.0 == Part::Telemetry && !stood.3) {
                (stood.1, stood.3) = (*at, true);
            }
            None
        }
        Observation::Left(left) if left.commands() || matches!(left, Left::Setpoint(_)) => {
            // where no setpoints are made, who knows the mode may still command
            let stood = stands.iter().find(|(part, from, until, told)| {
                *told
                    && *at > *from + STANDSTILL
                    && at < until
                    && !(*part == Part::Setpoints && left.commands())
            });
            stood.and_then(|(part, from, ..)| {
                let how = format!("{left:?} while {part:?} stands still since {:.3}", from.as_secs_f64());
                broken(Law::Standstill, *at, how)
            })
        }
        _ => None,
    })
}

fn range(trace: &Trace) -> Option<Broken> {
    trace.entries.iter().find_map(|entry| match &entry.observation {
        Observation::Left(Left::Wrong(how)) => broken(Law::Range, entry.at, how.clone()),
        _ => None,
    })
}

/// What was heard, from whomever, said that the vehicle is in another mode than ours.
fn was_told_off(trace: &Trace, given: &Given) -> bool {
    let mut ours = Ours::new(given);
    trace.entries.iter().any(|entry| match &entry.observation {
        Observation::Left(left) => {
            ours.left(left);
            false
        }
        Observation::Heard(report, _) => !ours.admits(report.mode),
        _ => false,
    })
}

fn end(trace: &Trace, given: &Given) -> Option<Broken> {
    let over = trace.entries.iter().rev().find_map(|entry| match &entry.observation {
        Observation::Over(outcome) => Some((entry.at, outcome)),
        _ => None,
    });
    let state = trace.entries.iter().rev().find_map(|entry| match &entry.observation {
        Observation::Vehicle(state) => Some(*state),
        _ => None,
    })?;
    let Some((at, outcome)) = over else {
        return broken(Law::Time, trace.entries.last()?.at, "the program does not end");
    };
    let then = trace.entries.iter().rev().filter(|entry| entry.at <= at).find_map(|entry| {
        match &entry.observation {
            Observation::Vehicle(state) => Some(*state),
            _ => None,
        }
    })?;
    let down = matches!(outcome.ending, Ending::Landed | Ending::NotFlown);
    if down && then.armed && !then.landed {
        return broken(Law::End, at, format!("{:?}, and it is in the air", outcome.ending));
    }
    let left = state.armed && !state.landed && !given.is_safe(state.custom_mode);
    let killed = matches!(outcome.cause, Some(Cause::Killed));
    if left && !killed && !was_told_off(trace, given) {
        return broken(
            Law::End,
            at,
            format!("left in the air in mode {:#x}: {:?}", state.custom_mode, outcome.cause),
        );
    }
    None
}
