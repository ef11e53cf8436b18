//! White noise of a recorded stream, estimated from the stream itself.

use crate::recording::Stream;
use crate::stats::white_level_of;

/// Standard deviation of the white part of each channel of a stream. Empty with fewer than 20 samples.
#[must_use]
pub fn white_level(stream: &Stream) -> Vec<f64> {
    if stream.len() < 20 {
        return Vec::new();
    }
    (0..stream.width)
        .map(|channel| {
            white_level_of(&(0..stream.len()).map(|i| stream.sample(i)[channel]).collect::<Vec<_>>())
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_distr::{Distribution, Normal};

    #[test]
    fn finds_the_level_under_a_smooth_signal() {
        let mut generator = rand_pcg::Pcg64::seed_from_u64(7);
        let noise = Normal::new(0.0, 0.015).unwrap();
        let time_s: Vec<f64> = (0..4000).map(|i| f64::from(i) * 0.02).collect();
        let values = time_s.iter().map(|t| (1.5 * t).sin() * 2.0 + noise.sample(&mut generator)).collect();
        let level = white_level(&Stream { time_s, width: 1, values })[0];
        assert!((level / 0.015 - 1.0).abs() < 0.05, "{level}");
    }
}
