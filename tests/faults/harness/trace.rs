//! What happened on a flight, as somebody sees it who watches the wire, the vehicle and the program's parts.

use std::fmt;
use std::time::Duration;

use mavid::fly::{Note, Outcome};
use mavid::sitl::Beheld;
use mavid::wire::{Check, CrcSeeds, Frame};

use super::wire::Left;

const HEARTBEAT: u32 = 0;
const CURRENT_MODE: u32 = 436;
const ARMED: u8 = 128;

/// A word of the vehicle's mode, by HEARTBEAT or CURRENT_MODE.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Report {
    pub mode: u32,
    /// where it says
    pub armed: Option<bool>,
    /// when the vehicle said it; `None` where somebody else did
    pub said: Option<Duration>,
}

impl Report {
    /// Of a sound frame with the ids of the vehicle's autopilot.
    pub fn of(seeds: &CrcSeeds, bytes: &[u8], said: Option<Duration>) -> Option<Self> {
        let frame = Frame::at_start(bytes).filter(|frame| frame.check(seeds) == Check::Right)?;
        let (header, payload) = (frame.header(), frame.payload());
        if (header.system.0, header.component.0) != (1, 1) {
            return None;
        }
        match header.message_id {
            HEARTBEAT => Some(Self { mode: payload.u32(0), armed: Some(payload.u8(6) & ARMED != 0), said }),
            CURRENT_MODE => Some(Self { mode: payload.u32(0), armed: None, said }),
            _ => None,
        }
    }
}

/// A part of the program that can stand still while the others go on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Part {
    /// the task that reads and writes the link
    Link,
    /// the way of frames from the link to the supervisor
    Telemetry,
    Supervisor,
    Setpoints,
}

/// Something that was seen.
#[derive(Debug, Clone, PartialEq)]
pub enum Observation {
    /// the vehicle is like this from now on
    Vehicle(Beheld),
    /// a sound frame of the vehicle came to the program's socket
    Came,
    /// the same, of its mode, from whomever
    Reached(Report),
    /// the supervisor was given it; when it had come to the socket
    Heard(Report, Duration),
    /// a message left the program
    Left(Left),
    /// what the program said
    Note(Note),
    /// what was done to them
    Fault(String),
    /// the vehicle's estimate jumped upwards by so much, m
    Jumped(f64),
    /// a part stands still until then
    Parked(Part, Duration),
    /// the program has ended
    Over(Outcome),
}

/// Something, and when.
#[derive(Debug, Clone, PartialEq)]
pub struct Entry {
    pub at: Duration,
    pub observation: Observation,
}

/// All of a flight, in order.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Trace {
    pub entries: Vec<Entry>,
}

impl Trace {
    pub fn add(&mut self, at: Duration, observation: Observation) {
        self.entries.push(Entry { at, observation });
    }

    /// What a person wants to see around an instant: no setpoints in a row, no frames without news.
    pub fn excerpt(&self, from: Duration, to: Duration) -> String {
        let mut lines: Vec<String> = Vec::new();
        let mut last: Option<Observation> = None;
        for Entry { at, observation } in &self.entries {
            let news = match (observation, &last) {
                (Observation::Came | Observation::Reached(_), _) | (Observation::Left(Left::Other(_)), _) => {
                    continue;
                }
                (Observation::Left(Left::Setpoint(_)), Some(Observation::Left(Left::Setpoint(_)))) => false,
                (Observation::Heard(now, _), Some(Observation::Heard(before, _))) => now.mode != before.mode,
                _ => true,
            };
            if news && (from..=to).contains(at) {
                lines.push(format!("  {:8.3} {observation}", at.as_secs_f64()));
            }
            last = Some(observation.clone());
        }
        lines.join("\n")
    }
}

impl fmt::Display for Observation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Vehicle(state) => write!(
                f,
                "vehicle: mode {:#x}, {}, {}",
                state.custom_mode,
                if state.armed { "armed" } else { "disarmed" },
                if state.landed { "on the ground" } else { "in the air" }
            ),
            Self::Came => f.write_str("a frame came"),
            Self::Reached(report) => write!(f, "reached: mode {:#x}", report.mode),
            Self::Heard(report, reached) => {
                let by = if report.said.is_some() { "" } else { " (not the vehicle's)" };
                write!(
                    f,
                    "heard: mode {:#x} {:?}{by}, reached {:.3}",
                    report.mode,
                    report.armed,
                    reached.as_secs_f64()
                )
            }
            Self::Left(left) => write!(f, "LEFT {left:?}"),
            Self::Note(note) => write!(f, "says {}: {}", note.kind, note.text),
            Self::Fault(what) => write!(f, "FAULT {what}"),
            Self::Jumped(by_m) => write!(f, "its estimate jumped upwards by {by_m:.2} m"),
            Self::Parked(part, until) => write!(f, "{part:?} stands still until {:.3}", until.as_secs_f64()),
            Self::Over(outcome) => write!(f, "over: {:?}, {:?}", outcome.cause, outcome.ending),
        }
    }
}
