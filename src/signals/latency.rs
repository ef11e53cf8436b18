//! Takes a known actuation latency out of the recorded force and torque.

use nalgebra::Vector4;

/// The body feels `F(t) = F_command(t - delay)` behind a first-order lag of `lag`; both in s.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ActuationLatency {
    /// s; may be negative where the actuator stream's stamps are late
    pub delay_s: f64,
    /// s, time constant
    pub lag_s: f64,
}

impl ActuationLatency {
    /// s, together
    #[must_use]
    pub fn total_s(&self) -> f64 {
        self.delay_s + self.lag_s
    }
}

/// The wrench that the body felt, from the commanded one: shifted by the delay (straight lines between
/// instants), then through the lag with its exact response to straight lines. One entry every `step_s`.
#[must_use]
pub fn delayed_wrench(wrench: &[Vector4<f64>], step_s: f64, latency: ActuationLatency) -> Vec<Vector4<f64>> {
    let shifted = shifted(wrench, latency.delay_s / step_s);
    if latency.lag_s <= 0.0 {
        return shifted;
    }
    lagged(&shifted, latency.lag_s, step_s)
}

fn shifted(series: &[Vector4<f64>], steps: f64) -> Vec<Vector4<f64>> {
    if steps == 0.0 || series.is_empty() {
        return series.to_vec();
    }
    let whole = steps.floor();
    let share = steps - whole;
    let last = series.len() - 1;
    // whole steps counted without a cast: |steps| is bounded by the series' length
    let mut count = 0;
    while (count as f64) < whole.abs() && count < last {
        count += 1;
    }
    let at = |index: usize, back: usize| {
        if whole >= 0.0 { series[index.saturating_sub(back)] } else { series[(index + back).min(last)] }
    };
    (0..series.len())
        .map(|index| {
            let near = at(index, count);
            let far = if whole >= 0.0 { at(index, count + 1) } else { at(index, count.saturating_sub(1)) };
            near + share * (far - near)
        })
        .collect()
}

/// First-order lag with first-order-hold input: exact for straight lines.
fn lagged(series: &[Vector4<f64>], lag_s: f64, step_s: f64) -> Vec<Vector4<f64>> {
    let pole = (-step_s / lag_s).exp();
    let ramp = 1.0 - lag_s / step_s * (1.0 - pole);
    let mut state = series.first().copied().unwrap_or_default();
    let mut before = state;
    series
        .iter()
        .map(|now| {
            state = pole * state + (1.0 - pole) * before + ramp * (now - before);
            before = *now;
            state
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ramp() -> Vec<Vector4<f64>> {
        (0..400).map(|i| Vector4::repeat(f64::from(i) * 0.01)).collect()
    }

    #[test]
    fn shifts_both_ways_by_fractions() {
        for steps in [2.3, 0.4, -0.4, -1.7] {
            let out = shifted(&ramp(), steps);
            assert!((out[200][0] - (200.0 - steps) * 0.01).abs() < 1e-12, "{steps}");
        }
    }

    #[test]
    fn a_lag_follows_a_ramp_by_its_time_constant() {
        let out = lagged(&ramp(), 0.05, 0.01);
        assert!((out[399][0] - (3.99 - 0.05)).abs() < 1e-12);
    }
}
