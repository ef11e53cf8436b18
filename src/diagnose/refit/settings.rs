//! Settings of a refit.

use crate::diagnose::explain::ExplainSettings;

/// Settings of a refit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RefitSettings {
    /// s, length of a segment
    pub segment_s: f64,
    /// s between the instants that are compared
    pub every_s: f64,
    /// most segments, evenly spread over the flights; bounds the cost
    pub most_segments: usize,
    /// Gauss-Newton passes
    pub passes: u32,
    /// residuals beyond so many standard deviations count less (Huber)
    pub huber: f64,
    /// s, half width of the weak form's test function
    pub half_width_s: f64,
}

impl Default for RefitSettings {
    fn default() -> Self {
        let half_width_s = ExplainSettings::default().half_width_s;
        Self { segment_s: 0.5, every_s: 0.05, most_segments: 120, passes: 3, huber: 3.0, half_width_s }
    }
}
