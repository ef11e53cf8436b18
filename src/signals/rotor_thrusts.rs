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
    /// relative standard error that all torques about x and y have in common, where they are rebuilt from others
    pub torque_std: f64,
    /// notes on values from the log's parameters and on contradictions to the vehicle file
    pub notes: Vec<Note>,
}

/// Thrust of the commands' jitter, N. A thrust curve is convex, so a command with jitter gives more thrust than its
/// mean: `1/2 T'' sigma^2`. A rotor averages an unknown part of the jitter. The local sigma^2 is the squared fourth
/// difference divided by 70, which is exact for white jitter.
pub(super) fn jitter_thrust(command: &Stream, curvature_n: f64) -> Stream {
    let width = command.width;
    let mut out = Stream { time_s: command.time_s.clone(), width, values: vec![0.0; command.values.len()] };
    for index in 2..command.len().saturating_sub(2) {
        for rotor in 0..width {
            let at = |i: usize| command.sample(i)[rotor];
            let fourth =
                at(index - 2) - 4.0 * at(index - 1) + 6.0 * at(index) - 4.0 * at(index + 1) + at(index + 2);
            out.values[index * width + rotor] = 0.5 * curvature_n * fourth * fourth / 70.0;
        }
    }
    out
}
