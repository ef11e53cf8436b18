//! Settings of the next flight.

use crate::diagnose::explain::ExplainSettings;

/// Settings of the next flight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NextSettings {
    /// period, s
    pub period_s: f64,
    /// harmonics of the series (18)
    pub harmonics: u32,
    /// periods that will be flown; comparing periods with each other needs four
    pub repeats: u32,
    /// random starts
    pub starts: u64,
    /// moves of each start
    pub moves: u32,
    /// seed of the search; the same seed gives the same flight
    pub seed: u64,
    /// s, half width of the weak form's test function
    pub half_width_s: f64,
}

impl Default for NextSettings {
    fn default() -> Self {
        Self {
            period_s: 10.0,
            harmonics: 5,
            repeats: 6,
            starts: 4,
            moves: 120,
            seed: 1,
            half_width_s: ExplainSettings::default().half_width_s,
        }
    }
}

impl NextSettings {
    /// Steps of a search.
    #[must_use]
    pub fn work(&self) -> u64 {
        self.starts * u64::from(self.moves)
    }
}
