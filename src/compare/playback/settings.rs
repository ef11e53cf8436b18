//! How playback is done.

/// How playback is done.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlaybackSettings {
    /// length of a window, s
    pub window_s: f64,
    /// time from one window's start to the next one's, s
    pub stride_s: f64,
    /// time before each window in which the effects' own states follow the recording, s
    pub warm_up_s: f64,
    /// longest integration step, s
    pub step_s: f64,
}

impl Default for PlaybackSettings {
    fn default() -> Self {
        Self { window_s: 0.5, stride_s: 0.5, warm_up_s: 0.3, step_s: 0.002 }
    }
}
