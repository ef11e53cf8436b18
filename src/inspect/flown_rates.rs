//! Rates of the streams while the vehicle flies: before take-off and after landing a log may hold more or less of them.

use std::collections::BTreeMap;

use crate::recording::{Recording, StreamKey};
use crate::signals::flowing_rate_within_hz;

/// Rates in the air, collected over windows.
#[derive(Debug, Clone, Default)]
pub(super) struct FlownRates(BTreeMap<StreamKey, Mean>);

/// Mean over the time flown.
#[derive(Debug, Clone, Copy, Default)]
struct Mean {
    seconds: f64,
    /// s times Hz
    samples: f64,
}

impl FlownRates {
    /// Adds a window with the spans (s) in which it flew.
    pub(super) fn add(&mut self, window: &Recording, flown_s: &[(f64, f64)]) {
        let seconds: f64 = flown_s.iter().map(|(start_s, end_s)| end_s - start_s).sum();
        for (key, stream) in &window.streams {
            let Some(rate_hz) = flowing_rate_within_hz(stream, flown_s) else { continue };
            let mean = self.0.entry(*key).or_default();
            mean.seconds += seconds;
            mean.samples += seconds * rate_hz;
        }
    }

    /// Samples a second of a stream in the air, gaps left out, Hz; `None` where it has none there.
    pub(super) fn of(&self, key: &StreamKey) -> Option<f64> {
        let mean = self.0.get(key).filter(|mean| mean.seconds > 0.0)?;
        Some(mean.samples / mean.seconds)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::{Quantity, Stream};

    #[test]
    fn only_what_is_flown_counts() {
        let key = StreamKey { quantity: Quantity::AngularRate, source: "ATTITUDE", instance: 0 };
        // 4 Hz on the ground for 20 s, then 50 Hz
        let ground = (0..80).map(|i| 0.25 * f64::from(i));
        let time_s: Vec<f64> = ground.chain((0..1000).map(|i| 20.0 + 0.02 * f64::from(i))).collect();
        let values = vec![0.0; 3 * time_s.len()];
        let streams = [(key, Stream { time_s, width: 3, values })].into();
        let window = Recording { streams, ..Recording::default() };
        let mut rates = FlownRates::default();
        rates.add(&window, &[]);
        assert_eq!(rates.of(&key), None);
        rates.add(&window, &[(25.0, 35.0)]);
        assert!((rates.of(&key).unwrap() - 50.0).abs() < 0.1);
        // as long on the ground
        rates.add(&window, &[(5.0, 15.0)]);
        assert!((rates.of(&key).unwrap() - 27.0).abs() < 0.1);
    }
}
