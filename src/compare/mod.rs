//! How well a simulation follows a recording: open loop over short windows, and in closed loop.

mod closed_loop;
mod playback;

pub use closed_loop::{SIGNALS, TenSignals, autopilot_flight, recorded_tracking_m, resimulated};
pub use playback::{
    CommandNoise, Fit, PlaybackSettings, StateNoise, WindowErrors, playback, playback_floor, playback_windows,
};

use crate::simulate::SimulateError;

/// Why a recording cannot be compared with a simulation.
#[derive(Debug, thiserror::Error)]
pub enum CompareError {
    /// a stream that is needed
    #[error("the recording holds no {what}: {purpose} needs it")]
    Missing {
        /// which
        what: &'static str,
        /// for what
        purpose: &'static str,
    },
    /// no window fits
    #[error(
        "no usable stretch of flight is as long as a window of {window_s} s with {warm_up_s} s before it"
    )]
    NoWindow {
        /// s
        window_s: f64,
        /// s
        warm_up_s: f64,
    },
    /// the simulation itself
    #[error(transparent)]
    Simulate(#[from] SimulateError),
}

/// `P_imp` of section IV-B: by how much an error fell, in percent of `before`. 0 where both are 0.
#[must_use]
pub fn improvement_percent(before: f64, after: f64) -> f64 {
    if before == after { 0.0 } else { 100.0 * (before - after) / before }
}

/// Sums squares of an error.
#[derive(Debug, Clone, Copy, Default)]
struct MeanSquare {
    sum: f64,
    count: usize,
}

impl MeanSquare {
    fn add(&mut self, square: f64) {
        self.sum += square;
        self.count += 1;
    }

    /// `None` where nothing was added.
    fn root(&self) -> Option<f64> {
        (self.count > 0).then(|| (self.sum / self.count as f64).sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn improvement_is_the_papers() {
        // Table 4, e_x with LS and e_psi with FMLS
        assert!((improvement_percent(0.06187, 0.05888) - 4.84).abs() < 0.01);
        assert!((improvement_percent(0.98831, 1.16907) + 18.29).abs() < 0.01);
        assert_eq!(improvement_percent(0.0, 0.0), 0.0);
    }
}
