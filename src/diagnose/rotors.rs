//! Thrust, speed and acceleration of each rotor along a flight.

use crate::physics::{ActuationLatency, Airframe, MAX_ROTORS, delayed_thrusts_n};
use crate::signals::{Series, central_difference};

/// One number a rotor; those beyond the rotor count are zero.
pub type Thrusts = [f64; MAX_ROTORS];

/// One number for each rotor and grid instant. It takes memory for the rotors that there are.
#[derive(Debug, Clone, Default)]
pub struct OfRotors {
    rotors: usize,
    /// instant after instant
    flat: Series<f64>,
}

impl OfRotors {
    /// Of so many rotors, instant after instant.
    #[must_use]
    pub fn new(rotors: usize, flat: Series<f64>) -> Self {
        Self { rotors, flat }
    }

    /// At an instant of the grid.
    #[must_use]
    pub fn at(&self, index: usize) -> Thrusts {
        let mut all = [0.0; MAX_ROTORS];
        let flat = &self.flat[index * self.rotors..(index + 1) * self.rotors];
        // the usual numbers of rotors are copied without a call
        match flat {
            [a, b, c, d] => all[..4].copy_from_slice(&[*a, *b, *c, *d]),
            [a, b, c, d, e, f] => all[..6].copy_from_slice(&[*a, *b, *c, *d, *e, *f]),
            _ => all[..flat.len()].copy_from_slice(flat),
        }
        all
    }

    /// At each instant, without the rotors that there are not.
    pub fn each(&self) -> impl Iterator<Item = &[f64]> {
        self.flat.chunks_exact(self.rotors.max(1))
    }

    /// One rotor's numbers.
    #[must_use]
    pub fn of(&self, rotor: usize) -> Vec<f64> {
        self.each().map(|all| all[rotor]).collect()
    }

    /// Each number times a factor.
    pub(super) fn scaled(self, factor: f64) -> Self {
        if factor == 1.0 {
            return self;
        }
        let flat: Vec<f64> = self.flat.iter().map(|value| value * factor).collect();
        Self::new(self.rotors, flat.into())
    }

    /// A column a rotor, one after the other.
    fn by_rotor(rotors: usize, count: usize, column: impl Fn(usize) -> Vec<f64>) -> Self {
        let mut flat = vec![0.0; rotors * count];
        for rotor in 0..rotors {
            let to = flat.iter_mut().skip(rotor).step_by(rotors);
            to.zip(column(rotor)).for_each(|(to, value)| *to = value);
        }
        Self::new(rotors, flat.into())
    }
}

/// Motion of the rotors at each grid instant.
#[derive(Debug, Clone)]
pub struct RotorMotion {
    /// N
    pub thrust_n: OfRotors,
    /// speed for this thrust, relative to hover
    pub speed: OfRotors,
    /// rate of the speed relative to hover, 1/s
    pub acceleration_1_s: OfRotors,
}

impl RotorMotion {
    /// Motion for given thrusts: speeds and their rates.
    #[must_use]
    pub fn new(thrust_n: OfRotors, airframe: &Airframe, step_s: f64) -> Self {
        let (rotors, count) = (thrust_n.rotors, thrust_n.each().count());
        let speed = OfRotors::by_rotor(rotors, count, |rotor| {
            thrust_n.each().map(|thrusts| airframe.relative_speed_of_thrust(thrusts[rotor])).collect()
        });
        let acceleration_1_s =
            OfRotors::by_rotor(rotors, count, |rotor| central_difference(&speed.of(rotor), step_s));
        Self { thrust_n, speed, acceleration_1_s }
    }
}

/// Thrusts behind an actuation latency. The lag acts on the rotors' speed, as a motor's does.
pub(super) fn felt(commanded_n: &OfRotors, step_s: f64, latency: ActuationLatency) -> OfRotors {
    if latency == ActuationLatency::default() {
        return commanded_n.clone();
    }
    let rotors = commanded_n.rotors;
    OfRotors::new(rotors, delayed_thrusts_n(&commanded_n.flat, rotors, step_s, latency).into())
}

/// Each rotor's thrusts after a filter.
pub(super) fn filtered(thrusts: &OfRotors, filter: impl Fn(&[f64]) -> Vec<f64>) -> OfRotors {
    let count = thrusts.each().count();
    OfRotors::by_rotor(thrusts.rotors, count, |rotor| filter(&thrusts.of(rotor)))
}
