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

/// White noise of the gyroscopes in the air, largest axis, rad/s, at the stream's own samples: between them the grid is
/// smooth. `None` for few samples.
pub(super) fn gyro_noise_rad_s(rate: &Stream, airborne_s: &[(f64, f64)]) -> Option<f64> {
    let flies = |time_s: f64| airborne_s.iter().any(|(start_s, end_s)| (*start_s..=*end_s).contains(&time_s));
    let mut flown = Stream { width: rate.width, ..Stream::default() };
    for (index, time_s) in rate.time_s.iter().enumerate().filter(|(_, time_s)| flies(**time_s)) {
        flown.time_s.push(*time_s);
        flown.values.extend_from_slice(rate.sample(index));
    }
    white_level(&flown).into_iter().reduce(f64::max).filter(|level| level.is_finite())
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

    /// At 38 Hz the grid has 20 ms, and is smoother than the samples.
    #[test]
    fn noise_of_slow_gyroscopes_is_that_of_their_samples() {
        let mut generator = rand_pcg::Pcg64::seed_from_u64(3);
        let noise = Normal::new(0.0, 0.04).unwrap();
        let time_s: Vec<f64> = (0..2000).map(|i| f64::from(i) / 38.0).collect();
        let values = time_s
            .iter()
            .flat_map(|t| {
                let flown = if *t > 10.0 { 1.0 } else { 0.1 };
                [0.5, 0.2, 1.0].map(|share| share * flown * noise.sample(&mut generator))
            })
            .collect();
        let rate = Stream { time_s, width: 3, values };
        let level = gyro_noise_rad_s(&rate, &[(10.0, 60.0)]).unwrap();
        assert!((level / 0.04 - 1.0).abs() < 0.05, "{level}");
        assert_eq!(gyro_noise_rad_s(&rate, &[]), None);
    }
}
