//! Several flights of one vehicle: the vehicle stays, the day does not.

use nalgebra::Vector3;
use rand::RngExt;

use super::super::dice;
use super::super::hidden::Hidden;
use super::case::RealCase;
use super::flight::{Flown, Senses};
use super::{drawn_three, spread, telemetry};

/// s of each flight.
const DURATION_S: f64 = 54.0;
/// Draws of a flight before its vehicle is given up.
const DRAWS: u64 = 12;
/// Of the numbers of one vehicle's flights, so that no two share a seed.
const FLIGHTS: u64 = 4096;

/// A vehicle and the days on which it flies.
#[derive(Debug, Clone)]
pub struct OneVehicle {
    pub case: RealCase,
    seed: u64,
}

/// One of its flights.
#[derive(Debug, Clone)]
pub struct Day {
    pub flown: Flown,
    seed: u64,
}

impl OneVehicle {
    /// The vehicle of a seed with what `entries` conceal.
    pub fn new(seed: u64, draw: u64, entries: &[&'static str]) -> Self {
        Self { case: RealCase::new(seed, draw, entries), seed: seed.wrapping_mul(64).wrapping_add(draw) }
    }

    /// The `flight`th flight, whose rotor `weak` gives so much of its thrust and torque: another path, another battery, other
    /// biases, and outdoors another wind.
    pub fn fly(&self, flight: u64, weak: Option<(usize, f64)>) -> Result<Day, String> {
        let mut why = String::new();
        for draw in 0..DRAWS {
            let seed = self.seed.wrapping_mul(FLIGHTS).wrapping_add(flight * DRAWS + draw);
            let (hidden, senses) = self.of_the_day(seed);
            let hidden = Hidden { weak: weak.or(hidden.weak), ..hidden };
            match self.case.fly_as((seed, DURATION_S), &hidden, &senses) {
                Ok(flown) => return Ok(Day { flown, seed }),
                Err(lost) => why = format!("{lost:?}"),
            }
        }
        Err(why)
    }

    /// What differs from day to day.
    fn of_the_day(&self, seed: u64) -> (Hidden, Senses) {
        let mut dice = dice(seed, 13);
        let mut hidden = self.case.case.hidden.clone();
        let mut senses = self.case.senses.clone();
        hidden.battery.fall = spread(0.006, 0.03, &mut dice);
        senses.unit.bias = [drawn_three(0.15, &mut dice), drawn_three(0.008, &mut dice)];
        if !senses.source.motion_capture {
            let (speed, way) = (dice.random_range(0.0..4.0), dice.random_range(0.0..std::f64::consts::TAU));
            hidden.wind = speed * Vector3::new(f64::cos(way), f64::sin(way), 0.0);
        }
        (hidden, senses)
    }

    /// The log of a flight.
    pub fn log(&self, day: &Day) -> Vec<u8> {
        telemetry::log(&day.flown, &self.case.streams, day.seed)
    }
}
