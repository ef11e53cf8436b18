//! Sums squares of an error.

/// Sums squares of an error.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct MeanSquare {
    pub sum: f64,
    pub count: usize,
}

impl MeanSquare {
    pub fn add(&mut self, square: f64) {
        self.sum += square;
        self.count += 1;
    }

    /// `None` where nothing was added.
    pub fn root(&self) -> Option<f64> {
        (self.count > 0).then(|| (self.sum / self.count as f64).sqrt())
    }
}
