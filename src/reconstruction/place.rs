//! Cells of time, and instants on a flight's grid.

use nalgebra::UnitQuaternion;

use crate::signals::Grid;

/// Length of a cell, s. Shorter cells cost time in proportion, and longer ones blur motions of over 4 Hz.
pub const STEP_S: f64 = 0.04;

/// An instant on a grid: the index before, the index after, and the share of the way to the latter.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    before: usize,
    after: usize,
    share: f64,
}

impl Place {
    /// Of a time, s; outside of the grid its ends.
    pub(super) fn of(grid: &Grid, t: f64) -> Self {
        let last = grid.count.saturating_sub(1);
        // the first index whose instant is later
        let (mut low, mut high) = (0, grid.count);
        while low < high {
            let middle = usize::midpoint(low, high);
            if grid.time_s(middle) <= t { low = middle + 1 } else { high = middle }
        }
        let (before, after) = (low.saturating_sub(1), low.min(last));
        let share = ((t - grid.time_s(before)) / grid.step_s).clamp(0.0, 1.0);
        Self { before, after, share: if after > before { share } else { 0.0 } }
    }

    /// Index of the instant before.
    pub(super) fn before(self) -> usize {
        self.before
    }

    /// Index of the instant after.
    pub(super) fn after(self) -> usize {
        self.after
    }

    /// A series there, by linear interpolation.
    pub(super) fn between<T>(self, of: &[T]) -> T
    where
        T: Copy + std::ops::Mul<f64, Output = T> + std::ops::Add<Output = T>,
    {
        of[self.before] * (1.0 - self.share) + of[self.after] * self.share
    }

    /// One rotor of a series that has all of them at each instant.
    pub(super) fn of_rotor(self, of: &[f64], rotor: usize, rotors: usize) -> f64 {
        of[self.before * rotors + rotor] * (1.0 - self.share) + of[self.after * rotors + rotor] * self.share
    }

    /// An attitude there.
    pub(super) fn turned(self, of: &[UnitQuaternion<f64>]) -> UnitQuaternion<f64> {
        of[self.before].nlerp(&of[self.after], self.share)
    }
}

/// The cell, among those with these borders (s), that a time lies in.
pub(super) fn cell_of(time_s: &[f64], t: f64) -> Option<usize> {
    let after = time_s.partition_point(|begin| *begin <= t);
    after.checked_sub(1).filter(|cell| cell + 1 < time_s.len())
}
