//! How much a vehicle vibrates: the white part of what its accelerometer feels in the air.

use crate::recording::{Quantity, Recording, Stream};
use crate::signals::{best, white_level};

/// s of a block. Only what is shown depends on it.
const BLOCK_S: f64 = 5.0;

/// White part of the accelerometer's samples in the air, the root of the sum of squares over the axes, m/s^2: mean over blocks of 5 s,
/// with its standard error. It depends on the rate of the log: flights whose logs have one rate can be compared. `None` below two blocks.
pub(super) fn vibration_m_s2(recording: &Recording, airborne_s: &[(f64, f64)]) -> Option<(f64, f64)> {
    let (_, stream) = best(recording, Quantity::SpecificForce, |stream| stream.width == 3)?;
    let mut levels = Vec::new();
    for (from_s, to_s) in airborne_s {
        let mut start_s = *from_s;
        while start_s + BLOCK_S <= *to_s {
            levels.extend(level(stream, start_s..start_s + BLOCK_S));
            start_s += BLOCK_S;
        }
    }
    let count = levels.len() as f64;
    if levels.len() < 2 {
        return None;
    }
    let mean = levels.iter().sum::<f64>() / count;
    let square = levels.iter().map(|level| (level - mean).powi(2)).sum::<f64>() / (count - 1.0);
    Some((mean, (square / count).sqrt()))
}

fn level(stream: &Stream, span_s: std::ops::Range<f64>) -> Option<f64> {
    let of = |time_s: f64| stream.time_s.partition_point(|stamp_s| *stamp_s < time_s);
    let (from, to) = (of(span_s.start), of(span_s.end));
    let block = Stream {
        time_s: stream.time_s[from..to].to_vec(),
        width: stream.width,
        values: stream.values[from * stream.width..to * stream.width].to_vec(),
    };
    let level = white_level(&block).iter().map(|level| level * level).sum::<f64>().sqrt();
    (level > 0.0 && level.is_finite()).then_some(level)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::StreamKey;

    #[test]
    fn what_shakes_faster_is_vibration_and_what_sways_is_none() {
        // alternating samples of 0.5 m/s^2 on one axis for the first 20 s, then of 1.0
        let time_s: Vec<f64> = (0..2000).map(|index| 0.02 * f64::from(index)).collect();
        let values = time_s.iter().enumerate().flat_map(|(index, time_s)| {
            let size = if *time_s < 20.0 { 0.5 } else { 1.0 };
            let shake = if index % 2 == 0 { size } else { -size };
            [2.0 * time_s.sin(), 0.0, 9.81 + shake]
        });
        let stream = Stream { width: 3, values: values.collect(), time_s };
        let key = StreamKey { quantity: Quantity::SpecificForce, source: "HIGHRES_IMU", instance: 0 };
        let mut recording = Recording::default();
        recording.streams.insert(key, stream);
        let of = |span| vibration_m_s2(&recording, &[span]).unwrap();
        let (calm, wild) = (of((0.0, 20.0)), of((20.0, 39.9)));
        assert!(calm.0 > 0.3 && (wild.0 / calm.0 - 2.0).abs() < 0.05, "{calm:?} {wild:?}");
        assert_eq!(vibration_m_s2(&recording, &[(0.0, 6.0)]), None);
        assert_eq!(vibration_m_s2(&Recording::default(), &[(0.0, 20.0)]), None);
    }
}
