//! What tells an estimator where the vehicle is: a satellite receiver with barometer and magnetometer, or motion capture.

use nalgebra::{Matrix3, Vector3};
use rand::{Rng, RngExt};

use super::super::flight::TICK;
use super::inertial::Wander;
use super::{drawn, drawn_three, spread};

/// A source of positions.
#[derive(Debug, Clone)]
pub struct Source {
    /// else a receiver
    pub motion_capture: bool,
    /// Hz
    pub rate: f64,
    /// m level, and the time in s over which it wanders; a receiver's height is half as good again
    pub position: (f64, f64),
    /// m/s, of a receiver
    pub velocity: f64,
    /// s, and what the estimator holds it for
    pub late: f64,
    pub believed_late: f64,
    /// m, a barometer's, of a reading
    pub height: f64,
    /// rad, of a reading, and what stays
    pub yaw: (f64, f64),
}

impl Source {
    pub fn random(motion_capture: bool, dice: &mut impl Rng) -> Self {
        if motion_capture {
            let late = dice.random_range(0.005..0.02);
            let off = dice.random_range(0.002..0.01) * if dice.random_bool(0.5) { 1.0 } else { -1.0 };
            return Self {
                motion_capture,
                rate: 100.0,
                position: (dice.random_range(0.001..0.002), 0.0),
                velocity: 0.0,
                late,
                believed_late: f64::max(late + off, 0.0),
                height: 0.0,
                yaw: (dice.random_range(0.003..0.01), drawn(0.004, dice)),
            };
        }
        let late = dice.random_range(0.1..0.2);
        let off = dice.random_range(0.015..0.035) * if dice.random_bool(0.5) { 1.0 } else { -1.0 };
        Self {
            motion_capture,
            rate: [5.0, 8.0, 10.0][dice.random_range(0..3_usize)],
            position: (dice.random_range(0.3..0.8), dice.random_range(30.0..80.0)),
            velocity: dice.random_range(0.05..0.1),
            late,
            believed_late: late + off,
            height: dice.random_range(0.1..0.25),
            yaw: (dice.random_range(0.02..0.05), drawn(0.01, dice)),
        }
    }
}

/// A measured position.
#[derive(Debug, Clone, Copy)]
pub struct Fix {
    /// s, when it reaches the vehicle
    pub arrives: f64,
    /// m
    pub position: Vector3<f64>,
    /// m/s
    pub velocity: Option<Vector3<f64>>,
    /// rad
    pub yaw: Option<f64>,
}

/// A source at work.
pub struct Positions {
    source: Source,
    wander: [Wander; 3],
    height: Wander,
    /// s, of the next fix
    due: f64,
    ticks: usize,
    underway: Vec<Fix>,
}

/// Ticks between two readings of barometer and magnetometer.
const EVERY: usize = 10;

/// What reaches the estimator at a tick.
#[derive(Debug, Clone, Default)]
pub struct Reached {
    pub fix: Option<Fix>,
    /// m and rad, of barometer and magnetometer
    pub height: Option<f64>,
    pub yaw: Option<f64>,
}

impl Positions {
    pub fn new(source: &Source, begins: f64, dice: &mut impl Rng) -> Self {
        let (size, time) = source.position;
        let mut wander = |size: f64| Wander::new((size, time.max(1.0)), 1.0 / source.rate, dice);
        let wander = if source.motion_capture { [0.0; 3] } else { [size, size, 1.5 * size] }.map(&mut wander);
        let height = Wander::new((0.15, 60.0), TICK * EVERY as f64, dice);
        let due = begins + dice.random_range(0.0..1.0) / source.rate;
        Self { source: source.clone(), wander, height, due, ticks: 0, underway: Vec::new() }
    }

    /// What reaches the estimator at `time` of where the vehicle is then and was before.
    pub fn next(
        &mut self,
        time: f64,
        (position, velocity, rotation): (&Vector3<f64>, &Vector3<f64>, &Matrix3<f64>),
        dice: &mut impl Rng,
    ) -> Reached {
        let (yaw_noise, yaw_bias) = self.source.yaw;
        let yaw = rotation[(1, 0)].atan2(rotation[(0, 0)]) + yaw_bias;
        if time >= self.due {
            self.due += 1.0 / self.source.rate;
            let fix = self.fix(time, (position, velocity, yaw), dice);
            self.underway.push(fix);
        }
        let mut reached = Reached::default();
        if self.underway.first().is_some_and(|fix| fix.arrives <= time) {
            reached.fix = Some(self.underway.remove(0));
        }
        self.ticks += 1;
        if !self.source.motion_capture && self.ticks.is_multiple_of(EVERY) {
            let slow = self.height.next(dice);
            reached.height = Some(position.z + slow + drawn(self.source.height, dice));
            reached.yaw = Some(yaw + drawn(yaw_noise, dice));
        }
        reached
    }

    fn fix(
        &mut self,
        time: f64,
        (position, velocity, yaw): (&Vector3<f64>, &Vector3<f64>, f64),
        dice: &mut impl Rng,
    ) -> Fix {
        let arrives = time + self.source.late;
        if self.source.motion_capture {
            let position = position + drawn_three(self.source.position.0, dice);
            let yaw = Some(yaw + drawn(self.source.yaw.0, dice));
            return Fix { arrives, position, velocity: None, yaw };
        }
        let slow = Vector3::from_fn(|axis, _| self.wander[axis].next(dice));
        let velocity = velocity + drawn_three(self.source.velocity, dice);
        Fix {
            arrives,
            position: position + slow + drawn_three(0.02, dice),
            velocity: Some(velocity),
            yaw: None,
        }
    }
}

/// Noise levels that somebody set by hand.
#[derive(Debug, Clone, Copy)]
pub struct Trust {
    /// m/s^2 and rad/s of an inertial sample
    pub force: f64,
    pub rates: f64,
    /// m and m/s
    pub position: f64,
    pub velocity: f64,
    /// m and rad
    pub height: f64,
    pub yaw: f64,
}

impl Trust {
    pub fn random(white: [f64; 2], source: &Source, dice: &mut impl Rng) -> Self {
        let mut about = |value: f64, low: f64, high: f64| value * spread(low, high, dice);
        Self {
            force: about(white[0].max(0.2), 1.0, 3.0),
            rates: about(white[1].max(0.01), 0.8, 2.5),
            position: if source.motion_capture { about(0.005, 0.6, 2.0) } else { about(0.6, 0.7, 1.6) },
            velocity: about(0.1, 0.7, 1.5),
            height: about(0.3, 0.7, 1.5),
            yaw: about(source.yaw.0, 1.2, 2.0),
        }
    }
}
