//! Which streams a vehicle sends, how often and with which stamps.

use rand::{Rng, RngExt};

/// The telemetry of a vehicle.
#[derive(Debug, Clone)]
pub struct Streams {
    /// as ArduPilot sends; else as PX4 does
    pub ardupilot: bool,
    /// Hz
    pub attitude: f64,
    pub position: f64,
    pub inertial: f64,
    pub commands: f64,
    /// Hz; 0: not sent
    pub speeds: f64,
    /// s by which the stamp is later than what it tells
    pub skew_attitude: f64,
    pub skew_position: f64,
    pub skew_inertial: f64,
    pub skew_commands: f64,
    /// s, of the host's times
    pub jitter: f64,
}

impl Streams {
    pub fn random(ardupilot: bool, dice: &mut impl Rng) -> Self {
        let mut of = |rates: &[f64]| rates[dice.random_range(0..rates.len())];
        let position = of(&[25.0, 25.0, 25.0, 30.0, 50.0]);
        let inertial =
            if ardupilot { of(&[40.0, 50.0, 50.0]) } else { of(&[25.0, 25.0, 25.0, 25.0, 25.0, 40.0]) };
        let commands = of(&[25.0, 50.0, 50.0, 50.0, 62.5, 100.0, 100.0]);
        let speeds = of(&[0.0, 0.0, 10.0]);
        let mut up_to = |most: f64| dice.random_range(0.0..most);
        Self {
            ardupilot,
            attitude: 50.0,
            position,
            inertial,
            commands,
            speeds,
            skew_attitude: up_to(0.02),
            skew_position: up_to(0.02),
            skew_inertial: up_to(0.003),
            skew_commands: up_to(0.003),
            jitter: 0.001 + up_to(0.002),
        }
    }
}

/// When a stream of a rate is due: at ticks that come a little early or late.
#[derive(Debug, Clone)]
pub struct Due {
    step: f64,
    next: f64,
}

impl Due {
    pub fn new(rate: f64, dice: &mut impl Rng) -> Self {
        let step = if rate > 0.0 { 1.0 / rate } else { f64::INFINITY };
        let next = if rate > 0.0 { step * dice.random_range(0.0..1.0) } else { f64::INFINITY };
        Self { step, next }
    }

    /// Whether it is sent at `time`.
    pub fn is_due(&mut self, time: f64, dice: &mut impl Rng) -> bool {
        let due = time >= self.next + 0.002 * dice.random_range(-1.0..1.0);
        if due {
            self.next += self.step;
        }
        due
    }
}
