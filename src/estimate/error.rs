//! Errors of the identification.

/// Errors of the identification.
#[derive(Debug, thiserror::Error)]
pub enum EstimateError {
    /// no usable rows
    #[error("no usable stretch of flight is as long as the weak form's kernel; record a longer flight")]
    NoRows,
    /// the cut-off does not fit the data's rate
    #[error(
        "low-pass cut-off {cutoff_hz} Hz: expected more than 0 and less than half the grid's {rate_hz:.1} Hz"
    )]
    Cutoff {
        /// Hz
        cutoff_hz: f64,
        /// Hz
        rate_hz: f64,
    },
}
