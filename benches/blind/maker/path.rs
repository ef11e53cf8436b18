//! Where the vehicle is to fly: a random Fourier series of five harmonics in x, y, z and yaw.

use nalgebra::Vector3;
use rand::{Rng, RngExt};

use super::dice;
use super::mission::{self, Leg};

/// Harmonics.
const HARMONICS: usize = 5;

/// How lively and where.
#[derive(Debug, Clone, Copy)]
pub struct Room {
    /// m/s, the fastest that is asked for
    pub speed: f64,
    /// m/s^2, the hardest
    pub acceleration: f64,
    /// m, lowest and highest
    pub heights: (f64, f64),
    /// m/s, the fastest climb
    pub climb: f64,
    /// as fast up and down as to the sides
    pub lively_climb: bool,
    /// up and down slowly and far
    pub plunge: bool,
    /// how fast the harmonics level fall with their number, as a power
    pub fall: f64,
}

/// What is asked for at an instant.
#[derive(Debug, Clone, Copy, Default)]
pub struct RequestedEffects {
    /// m, world
    pub position: Vector3<f64>,
    /// m/s
    pub velocity: Vector3<f64>,
    /// m/s^2
    pub acceleration: Vector3<f64>,
    /// rad
    pub yaw: f64,
    /// rad/s
    pub yaw_rate: f64,
}

/// A flight's reference.
#[derive(Debug, Clone)]
pub struct Path {
    /// s
    pub period: f64,
    /// s until the end
    pub duration: f64,
    /// of x, y, z, yaw: of each harmonic cosine and sine
    waves: [[(f64, f64); HARMONICS]; 4],
    /// m
    height: f64,
    /// of a mission; empty: the series
    legs: Vec<Leg>,
}

/// Hover before the series begins, s.
const HOVER: f64 = 4.0;

/// Time in which the series comes in, s.
const BLEND: f64 = 3.0;

impl Path {
    /// The path of a seed in a room.
    pub fn random(seed: u64, room: Room, periods: Option<f64>) -> Self {
        let mut dice = dice(seed, 2);
        let period = dice.random_range(10.0..14.0_f64);
        let periods = periods.unwrap_or((50.0 / period).round());
        Self::series((period, HOVER + periods * period), room, &mut dice)
    }

    /// The path of a seed from waypoint to waypoint in a room of `reach` m about the middle, `duration` s long.
    pub fn mission(seed: u64, (room, reach): (Room, f64), duration: f64) -> Self {
        let mut dice = dice(seed, 2);
        let legs = mission::legs((room, reach), (HOVER, duration), &mut dice);
        let waves = [[(0.0, 0.0); HARMONICS]; 4];
        Self { period: duration, duration, waves, height: 0.0, legs }
    }

    /// The path of a seed as a series of this period, `duration` s long.
    pub fn of_period(seed: u64, room: Room, (period, duration): (f64, f64)) -> Self {
        Self::series((period, duration), room, &mut dice(seed, 2))
    }

    fn series((period, duration): (f64, f64), room: Room, mut dice: &mut impl Rng) -> Self {
        let mut waves = [[(0.0, 0.0); HARMONICS]; 4];
        for (axis, of_axis) in waves.iter_mut().enumerate() {
            let fall = match axis {
                0 | 1 => room.fall,
                // no body has much to turn itself with
                3 if room.climb.is_finite() => 1.5,
                _ => 1.0,
            };
            for (place, wave) in of_axis.iter_mut().enumerate() {
                *wave = drawn(&mut dice, (1.0 + place as f64).powf(-fall));
            }
        }
        if room.plunge {
            for (place, (cosine, sine)) in waves[2].iter_mut().enumerate() {
                let less = (1.0 + place as f64).powi(2);
                (*cosine, *sine) = (*cosine / less, *sine / less);
            }
        }
        let mut path = Self { period, duration, waves, height: 0.0, legs: Vec::new() };
        path.fit(room);
        path
    }

    /// Scales the series to the room.
    fn fit(&mut self, room: Room) {
        let times: Vec<f64> = (0..500).map(|step| self.period * f64::from(step) / 500.0).collect();
        let (mut speed, mut hard, mut yaw_rate) = (0.0_f64, 0.0_f64, 0.0_f64);
        let (mut low, mut high) = (f64::MAX, f64::MIN);
        let (mut climb, mut push) = (0.0_f64, 0.0_f64);
        for &time in &times {
            let [x, y, z, yaw] = std::array::from_fn(|axis| self.wave(axis, time));
            speed = speed.max(x[1].hypot(y[1]));
            hard = hard.max(x[2].hypot(y[2]));
            (low, high) = (low.min(z[0]), high.max(z[0]));
            climb = climb.max(z[1].abs());
            push = push.max(z[2].abs());
            yaw_rate = yaw_rate.max(yaw[1].abs());
        }
        let level = (room.speed / speed).min(room.acceleration / hard);
        let span = (room.heights.1 - room.heights.0) / (high - low);
        let most = if room.lively_climb { room.speed } else { room.climb.min(0.7 * room.speed) };
        let upright = span.min(most / climb).min(0.6 * room.acceleration.min(5.0) / push);
        // as gently where climbs are bounded
        let turn = if room.climb.is_finite() { 0.65 } else { 0.9 } / yaw_rate;
        for (axis, scale) in [level, level, upright, turn].into_iter().enumerate() {
            for (cosine, sine) in &mut self.waves[axis] {
                *cosine *= scale;
                *sine *= scale;
            }
        }
        // as low as the room permits
        self.height = room.heights.0 - upright * low;
    }

    /// Value and two derivatives of an axis' series, s since its beginning.
    fn wave(&self, axis: usize, time: f64) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for (place, (cosine, sine)) in self.waves[axis].iter().enumerate() {
            let rate = std::f64::consts::TAU * (1.0 + place as f64) / self.period;
            let (s, c) = (rate * time).sin_cos();
            sum[0] += cosine * c + sine * s;
            sum[1] += rate * (sine * c - cosine * s);
            sum[2] -= rate * rate * (cosine * c + sine * s);
        }
        sum
    }

    /// What is asked for `time` s after the flight's beginning.
    pub fn at(&self, time: f64) -> RequestedEffects {
        if !self.legs.is_empty() {
            return mission::at(&self.legs, time);
        }
        let since = (time - HOVER).max(0.0);
        let [share, rise, bend] = blend(since / BLEND);
        let (rise, bend) = (rise / BLEND, bend / (BLEND * BLEND));
        let [x, y, z, yaw] = std::array::from_fn(|axis| {
            let wave = self.wave(axis, since);
            [
                share * wave[0],
                share * wave[1] + rise * wave[0],
                share * wave[2] + 2.0 * rise * wave[1] + bend * wave[0],
            ]
        });
        RequestedEffects {
            position: Vector3::new(x[0], y[0], z[0] + self.height),
            velocity: Vector3::new(x[1], y[1], z[1]),
            acceleration: Vector3::new(x[2], y[2], z[2]),
            yaw: yaw[0],
            yaw_rate: yaw[1],
        }
    }
}

/// From 0 to 1 with its derivatives, smooth to the second.
fn blend(share: f64) -> [f64; 3] {
    if share >= 1.0 {
        return [1.0, 0.0, 0.0];
    }
    let s = share;
    [
        s * s * s * (10.0 + s * (6.0 * s - 15.0)),
        30.0 * s * s * (1.0 - s) * (1.0 - s),
        60.0 * s * (1.0 - s) * (1.0 - 2.0 * s),
    ]
}

/// A wave of about a size.
fn drawn(dice: &mut impl Rng, size: f64) -> (f64, f64) {
    (size * dice.random_range(-1.0..1.0), size * dice.random_range(-1.0..1.0))
}
