//! How playback is done.

use crate::physics::Model;

/// How playback is done.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlaybackSettings {
    /// length of a window, s
    pub window_s: f64,
    /// time from one window's start to the next one's, s
    pub stride_s: f64,
    /// time before each window in which the effects' own states follow the recording, s
    pub warm_up_s: f64,
    /// longest integration step, s; shorter ones follow rotors that are fast
    pub step_s: f64,
}

impl Default for PlaybackSettings {
    fn default() -> Self {
        Self { window_s: 0.5, stride_s: 0.5, warm_up_s: 0.3, step_s: 0.002 }
    }
}

/// Steps that follow a lag are not longer than this share of its time constant: the error of one is then 1e-3 of what changes. Of a lag below 6 ms
/// it is more, up to 0.2 at 2 ms, the least lag that is integrated.
const SHARE_OF_LAG: f64 = 2.0 / 3.0;
/// Steps are not made shorter than this for a lag, s: what is faster has little to do with the motion.
const SHORTEST_FOR_LAG_S: f64 = 0.004;

impl PlaybackSettings {
    /// Longest integration step of a model, s.
    pub(super) fn longest_step_s(&self, model: &Model) -> f64 {
        let lags = model.effects().iter().filter(|effect| effect.is_rotor_lag());
        let fastest_s = lags.flat_map(|lag| lag.parameters()).copied().fold(f64::INFINITY, f64::min);
        self.step_s.min((SHARE_OF_LAG * fastest_s).max(SHORTEST_FOR_LAG_S))
    }
}
