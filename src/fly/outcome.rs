//! The outcome of a flight, and its notes.

use std::borrow::Cow;
use std::fmt;
use std::time::Duration;

use serde::Serialize;

/// The cause of an unplanned end of a flight.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[serde(tag = "id", content = "detail", rename_all = "snake_case")]
pub enum Cause {
    /// the operator's key
    Operator,
    /// the operator stopped the motors
    Killed,
    /// the program was ended: Ctrl-C, SIGTERM, SIGHUP, a panic
    Signal(String),
    /// a condition before takeoff was not satisfied, or an order was refused
    Refused(String),
    /// the vehicle did not reach a place in time
    NotReached(String),
    /// the vehicle left our mode without our command: its pilot, another station, or a failsafe
    Override(String),
    /// the autopilot declares a failsafe that leaves our mode as it is
    Failsafe(String),
    /// further off the reference than allowed
    Tracking(String),
    /// tilted further than allowed
    Tilt(String),
    /// outside the room, margin included
    Room(String),
    /// no message of the vehicle was received
    LinkLost(String),
    /// its position estimate is not good
    Estimator(String),
    /// its position estimate jumped
    EstimatorReset(String),
    /// the battery is low
    Battery(String),
    /// another station commands the vehicle
    SecondMaster(String),
    /// its clock restarted
    Reboot,
    /// this program or its computer stalled
    Stalled(String),
    /// a setpoint that no message can carry
    Unfit(String),
    /// the vehicle does not execute orders
    Unresponsive(String),
}

/// The immediate reaction to a cause.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Response {
    /// only heartbeats are sent: somebody else flies
    HandsOff,
    /// nothing is sent until the vehicle is heard again and is still in our mode
    Wait,
    /// the vehicle's own hold mode, and landing after a while
    Hold,
    /// immediate landing
    Land,
}

impl Cause {
    /// The immediate reaction.
    #[must_use]
    pub fn response(&self) -> Response {
        match self {
            Self::Override(_) => Response::HandsOff,
            Self::LinkLost(_) => Response::Wait,
            Self::Estimator(_) | Self::Battery(_) | Self::NotReached(_) | Self::Refused(_) => Response::Land,
            _ => Response::Hold,
        }
    }
}

impl fmt::Display for Cause {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Operator => f.write_str("aborted by the operator"),
            Self::Killed => f.write_str("motors stopped by the operator"),
            Self::Signal(name) => write!(f, "ended by {name}"),
            Self::Refused(why) | Self::NotReached(why) => f.write_str(why),
            Self::Override(what) => write!(f, "taken over: {what}"),
            Self::Failsafe(what) => write!(f, "the autopilot's failsafe: {what}"),
            Self::Tracking(what) => write!(f, "off the reference: {what}"),
            Self::Tilt(what) => write!(f, "tilted too far: {what}"),
            Self::Room(what) => write!(f, "outside the room: {what}"),
            Self::LinkLost(what) => write!(f, "link lost: {what}"),
            Self::Estimator(what) => write!(f, "position estimate not good: {what}"),
            Self::EstimatorReset(what) => write!(f, "position estimate jumped: {what}"),
            Self::Battery(what) => write!(f, "battery: {what}"),
            Self::SecondMaster(what) => write!(f, "a second ground station commands: {what}"),
            Self::Reboot => f.write_str("the autopilot restarted"),
            Self::Stalled(what) => write!(f, "the host stalled: {what}"),
            Self::Unfit(why) => write!(f, "no setpoint can be made: {why}"),
            Self::Unresponsive(what) => write!(f, "the vehicle does not answer: {what}"),
        }
    }
}

/// Where and how the vehicle was left.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[serde(tag = "id", content = "detail", rename_all = "snake_case")]
pub enum Ending {
    /// never left the ground
    NotFlown,
    /// on the ground, motors off
    Landed,
    /// motors stopped in the air: it fell
    Fell,
    /// in the air, in this mode, or not known
    InTheAir(String),
}

/// What was flown, measured.
#[derive(Debug, Clone, PartialEq, Serialize, Default)]
pub struct FlightStatistics {
    /// periods of the series flown to their end
    pub periods: u32,
    /// distance to the reference along the trajectory, root mean square, m
    pub tracking_rms_m: f64,
    /// greatest distance, m
    pub tracking_max_m: f64,
    /// greatest tilt, degrees
    pub tilt_max_deg: f64,
    /// greatest tilt of the reference, degrees
    pub tilt_planned_deg: f64,
    /// s for which the trajectory waited for the link
    pub paused_s: f64,
    /// how often this program or its computer stood still for more than 0.1 s once the vehicle was heard
    pub stalls: u32,
    /// the longest of these times, s
    pub stalled_max_s: f64,
    /// the longest of those within 5 s before the cause of an unplanned end, s; `None` where there is none
    pub stalled_before_end_s: Option<f64>,
}

/// Outcome of a flight.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Outcome {
    /// cause of an unplanned end; `None` for a complete flight
    pub cause: Option<Cause>,
    /// where the vehicle is
    pub ending: Ending,
    /// what was flown
    pub flown: FlightStatistics,
    /// losses of a flight, as sentences
    pub losses: Vec<String>,
}

impl Outcome {
    /// Whether the whole trajectory was flown and the vehicle is on the ground.
    #[must_use]
    pub fn is_whole(&self) -> bool {
        self.cause.is_none() && self.ending == Ending::Landed
    }

    /// Whether the program was told to end: by a signal, or by Ctrl-C as a key.
    #[must_use]
    pub fn is_interrupted(&self) -> bool {
        matches!(self.cause, Some(Cause::Signal(_)))
    }
}

/// Severity of a note.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Level {
    /// the flight continues as planned
    Information,
    /// the operator should know
    Warning,
    /// ends the flight
    Error,
}

/// A line of the flight's log of events.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Note {
    /// s on the flight's clock
    pub time_s: f64,
    /// severity
    pub level: Level,
    /// kind: `phase`, `vehicle`, `command`, `mode`, `link`, `stream`, `abort`, `end`
    pub kind: Cow<'static, str>,
    /// text for the operator
    pub text: String,
}

impl Note {
    /// A note at `now` of the flight's clock.
    #[must_use]
    pub fn new(now: Duration, level: Level, kind: &'static str, text: impl Into<String>) -> Self {
        Self { time_s: now.as_secs_f64(), level, kind: Cow::Borrowed(kind), text: text.into() }
    }
}
