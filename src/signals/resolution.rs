//! Whether a sensor's readings move by more than the steps in which they were recorded.

use super::flight::Signals;
use crate::recording::Stream;
use nalgebra::Vector3;

/// Standard deviation of readings, in steps, from which their rounding acts as noise of its own. With less, the rounding follows what is
/// rounded and can hide all of it (Widrow and Kollár, "Quantization Noise", 2008, on dither).
const DITHERED: f64 = 0.5;

impl Signals {
    /// Whether each axis of the accelerometer moves by more than its resolution while the recording is used.
    #[must_use]
    pub fn resolves_specific_force(&self) -> bool {
        let (Some(stream), Some(force)) = (&self.as_recorded.specific_force, &self.specific_force) else {
            return self.specific_force.is_some();
        };
        let used = force.iter().zip(&self.usable).filter(|(_, usable)| **usable);
        is_resolved(stream, used.map(|(force, _)| *force))
    }
}

/// Whether each axis of a reading that was recorded as `stream` moves by more than its resolution; `values` in the unit of the stream.
fn is_resolved(stream: &Stream, values: impl Iterator<Item = Vector3<f64>> + Clone) -> bool {
    let step = step(stream);
    let count = values.clone().count().max(1) as f64;
    let mean = values.clone().sum::<Vector3<f64>>() / count;
    let variance = values.map(|value| (value - mean).map(|of| of * of)).sum::<Vector3<f64>>() / count;
    variance.iter().all(|variance| variance.sqrt() >= DITHERED * step)
}

/// Least difference between successive samples that are not the same, over all axes; 0 where they never differ.
fn step(stream: &Stream) -> f64 {
    let differences = stream.values.iter().zip(stream.values.iter().skip(3)).map(|(a, b)| (b - a).abs());
    // what is left of rounding in the conversion of units is no step
    let steps = differences.filter(|difference| *difference > 1e-9);
    let least = steps.fold(f64::INFINITY, f64::min);
    if least.is_finite() { least } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// Readings of an amplitude along x (and ten times that along the others), as given and as recorded in steps of 0.01.
    fn recorded(amplitude: f64) -> (Stream, Vec<Vector3<f64>>) {
        let reading = |index: usize| {
            let wave = (TAU * index as f64 / 37.0).sin();
            Vector3::new(amplitude, 10.0 * amplitude, 10.0 * amplitude) * wave
        };
        let rounded: Vec<Vector3<f64>> =
            (0..500).map(|index| reading(index).map(|of| (of / 0.01).round() * 0.01)).collect();
        let stream = Stream {
            time_s: (0..500).map(|index| 0.02 * f64::from(index)).collect(),
            values: rounded.iter().flat_map(|value| value.iter().copied()).collect(),
            width: 3,
        };
        (stream, rounded)
    }

    #[test]
    fn readings_within_a_step_of_their_resolution_are_not_resolved() {
        for (amplitude, resolved) in [(0.004, false), (0.2, true)] {
            let (stream, values) = recorded(amplitude);
            assert_eq!(is_resolved(&stream, values.iter().copied()), resolved, "{amplitude}");
        }
    }
}
