//! One thrust a rotor along time, and where it comes from.

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
    /// notes on values from the log's parameters and on contradictions to the vehicle file
    pub notes: Vec<Note>,
}
