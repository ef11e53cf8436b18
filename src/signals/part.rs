//! A part of a flight.

use std::ops::Range;
use std::sync::Arc;

use super::flight::{Reference, Series, Signals};
use super::grid::Grid;

/// The instants of a range.
fn cut<T: Clone>(series: &Series<T>, range: &Range<usize>, each: usize) -> Series<T> {
    // a series that the log does not hold is empty
    Arc::new(series.get(range.start * each..range.end * each).unwrap_or_default().to_vec())
}

impl Signals {
    /// The flight within some instants of its grid. Times stay on the vehicle's clock, and sources and corrections are those of the whole
    /// flight. A range beyond the grid ends with it.
    #[must_use]
    pub fn part(&self, range: Range<usize>) -> Self {
        let end = range.end.min(self.grid.count);
        let range = &(range.start.min(end)..end);
        let grid = Grid { start_s: self.grid.time_s(range.start), count: range.len(), ..self.grid };
        let rotors = self.rotor_thrust_n.len().checked_div(self.grid.count).unwrap_or(0);
        let mut quality = self.quality.clone();
        let end_s = self.grid.time_s(range.end);
        quality.airborne_s = quality
            .airborne_s
            .iter()
            .map(|(from_s, to_s)| (from_s.max(grid.start_s), to_s.min(end_s)))
            .filter(|(from_s, to_s)| from_s < to_s)
            .collect();
        Self {
            grid,
            usable: self.usable.get(range.clone()).unwrap_or_default().to_vec(),
            attitude: self.attitude.as_ref().map(|series| cut(series, range, 1)),
            rate: self.rate.as_ref().map(|series| cut(series, range, 1)),
            specific_force: self.specific_force.as_ref().map(|series| cut(series, range, 1)),
            world_acceleration: self.world_acceleration.as_ref().map(|series| cut(series, range, 1)),
            position: self.position.as_ref().map(|series| cut(series, range, 1)),
            velocity: self.velocity.as_ref().map(|series| cut(series, range, 1)),
            rotor_thrust_n: cut(&self.rotor_thrust_n, range, rotors),
            full_thrust_n: self.full_thrust_n,
            wrench: cut(&self.wrench, range, 1),
            jitter_wrench: self.jitter_wrench.as_ref().map(|series| cut(series, range, 1)),
            battery_voltage_v: self.battery_voltage_v.as_ref().map(|series| cut(series, range, 1)),
            as_recorded: self.as_recorded.clone(),
            reference: self.reference.as_ref().map(|reference| Reference {
                is_of_positions: reference.is_of_positions,
                acceleration: cut(&reference.acceleration, range, 1),
                yaw: cut(&reference.yaw, range, 1),
                message: reference.message,
            }),
            own: self.own.clone(),
            air_m_s: self.air_m_s,
            quality,
        }
    }
}
