//! What the concealed effects did to the vehicle, against a rigid body with exact thrust: how plainly a flight shows
//! them, and on which axes.

use super::super::body::{Drive, State, place, rotation};
use super::super::flight::TICK;
use super::super::hidden::Hidden;
use super::super::vehicle::Craft;

/// Of each axis, forces x, y, z and torques x, y, z: root mean square over what a crude analyst's noise leaves, in
/// standard deviations, once mass and inertia are fitted.
#[derive(Debug, Clone, Copy, Default)]
pub struct Visibility {
    pub axes: [f64; 6],
}

impl Visibility {
    /// All axes together.
    pub fn whole(&self) -> f64 {
        self.axes.iter().map(|axis| axis * axis).sum::<f64>().sqrt()
    }

    /// Axes that carry a tenth of it, where there is something at all.
    pub fn where_it_is(&self) -> [bool; 6] {
        let whole = self.whole().powi(2);
        self.axes.map(|axis| axis >= PLAIN && axis * axis >= 0.1 * whole)
    }
}

/// Standard deviations from which an axis shows an effect.
pub const PLAIN: f64 = 7.0;

/// Root mean square of a crude analyst's noise below 4 Hz (m/s^2) and 8 Hz (rad/s^2).
const NOISE: [f64; 6] = [0.15, 0.15, 0.13, 0.35, 0.35, 0.3];

/// Independent numbers a second.
const NUMBERS: f64 = 3.0;

/// Ticks between two comparisons.
const EVERY: usize = 10;

/// Watches a flight.
pub struct Watch<'a> {
    full: Drive<'a>,
    craft: &'a Craft,
    /// without anything concealed
    bare: Hidden,
    /// rad/s of rotors that do what the maker says
    speeds: [f64; 4],
    lag: f64,
    ticks: usize,
    /// of each axis: number, and sums of yy, xx, xy
    sums: [[f64; 4]; 6],
}

impl<'a> Watch<'a> {
    pub fn new(craft: &'a Craft, hidden: &'a Hidden) -> Self {
        // a lag within what motors have is the rigid body's; a greater one is concealed
        let lag = craft.said_lag.unwrap_or(hidden.lag.0.min(0.035));
        Self {
            full: Drive::new(craft, hidden),
            craft,
            bare: Hidden { lag: (lag, lag), ..Hidden::default() },
            speeds: [craft.hover_speed(); 4],
            lag,
            ticks: 0,
            sums: [[0.0; 4]; 6],
        }
    }

    /// The state at a tick and the command that is given then.
    pub fn tick(&mut self, time: f64, state: &State, command: &[f64; 4]) {
        if self.ticks.is_multiple_of(EVERY) && time > 1.0 {
            self.compare(time, state);
        }
        self.ticks += 1;
        let share = 1.0 - (-TICK / self.lag).exp();
        for (speed, value) in self.speeds.iter_mut().zip(command) {
            *speed += share * (value * self.craft.speed_max - *speed);
        }
    }

    fn compare(&mut self, time: f64, state: &State) {
        let bare = Drive::new(self.craft, &self.bare);
        let mut plain = *state;
        plain[place::ROTORS..place::ROTORS + 4].copy_from_slice(&self.speeds);
        let (full, plain) = (self.full.motion(time, state), bare.motion(time, &plain));
        let back = rotation(state).transpose();
        let force = back * (full.acceleration - plain.acceleration);
        let torque = full.angular - plain.angular;
        let thrust = back * (plain.acceleration + nalgebra::Vector3::new(0.0, 0.0, super::super::GRAVITY));
        for axis in 0..6 {
            let (y, x) = match axis {
                2 => (force.z, thrust.z),
                0 | 1 => (force[axis], 0.0),
                _ => (torque[axis - 3], plain.angular[axis - 3]),
            };
            let of = [1.0, y * y, x * x, x * y];
            self.sums[axis].iter_mut().zip(of).for_each(|(sum, value)| *sum += value);
        }
    }

    /// What was seen.
    pub fn visibility(&self) -> Visibility {
        let seconds = self.ticks as f64 * TICK;
        let mut seen = Visibility::default();
        for ((axis, sums), noise) in seen.axes.iter_mut().zip(&self.sums).zip(NOISE) {
            let [count, yy, xx, xy] = *sums;
            let scale = if xx > 1e-9 { xy * xy / xx } else { 0.0 };
            let left = ((yy - scale) / count.max(1.0)).max(0.0);
            *axis = (left * seconds * NUMBERS).sqrt() / noise;
        }
        seen
    }
}
