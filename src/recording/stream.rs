//! Samples of one quantity from one source.

use super::quantity::Quantity;

/// One stream: which quantity, from which message, of which instance.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct StreamKey {
    /// what it holds
    pub quantity: Quantity,
    /// message or file column group that it came from, such as `HIGHRES_IMU`
    pub source: &'static str,
    /// port, index or sensor number; 0 where there is one
    pub instance: u8,
}

/// Samples in time order. Vehicle clock, seconds from the recording's start: zero is the first message with a
/// stamp of the vehicle's; others may be stamped some milliseconds before it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Stream {
    /// s
    pub time_s: Vec<f64>,
    /// values a sample
    pub width: usize,
    /// `width` values a sample, one after the other; NaN where a single value is missing
    pub values: Vec<f64>,
}

impl Stream {
    /// Number of samples.
    #[must_use]
    pub fn len(&self) -> usize {
        self.time_s.len()
    }

    /// No samples.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.time_s.is_empty()
    }

    /// The values of one sample.
    #[must_use]
    pub fn sample(&self, index: usize) -> &[f64] {
        &self.values[index * self.width..(index + 1) * self.width]
    }
}
