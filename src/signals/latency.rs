//! Takes a known actuation latency out of the recorded force and torque.

use nalgebra::Vector4;

/// The body feels `F(t) = F_command(t - delay)` behind a first-order lag of `lag`; both in s.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ActuationLatency {
    /// s; may be negative where the actuator stream's stamps are late
    pub delay_s: f64,
    /// s, time constant; of rotors the mean of that at rising and that at falling speed
    pub lag_s: f64,
    /// logarithm of how many times as long slowing down takes as speeding up: 0 where both take as long
    pub uneven: f64,
}

impl ActuationLatency {
    /// s, together
    #[must_use]
    pub fn total_s(&self) -> f64 {
        self.delay_s + self.lag_s
    }

    /// Time constants of rising and of falling speed, s.
    #[must_use]
    pub fn rising_and_falling_s(&self) -> (f64, f64) {
        let rising_s = 2.0 * self.lag_s / (1.0 + self.uneven.exp());
        (rising_s, 2.0 * self.lag_s - rising_s)
    }
}

/// The wrench that the body felt, from the commanded one: shifted by the delay (straight lines between
/// instants), then through the lag, as long up as down, with its exact response to straight lines. One entry every
/// `step_s`.
#[must_use]
pub fn delayed_wrench(wrench: &[Vector4<f64>], step_s: f64, latency: ActuationLatency) -> Vec<Vector4<f64>> {
    let shifted = shifted(wrench, latency.delay_s / step_s);
    if latency.lag_s <= 0.0 {
        return shifted;
    }
    lagged(&shifted, latency.lag_s, step_s)
}

/// Rotor speeds behind an actuation latency. Where falling takes longer than rising, what jitters about a value is faster
/// than it on average. One entry every `step_s`.
#[must_use]
pub fn delayed_speeds(speeds: &[Vector4<f64>], step_s: f64, latency: ActuationLatency) -> Vec<Vector4<f64>> {
    if latency.lag_s <= 0.0 || latency.uneven == 0.0 {
        return delayed_wrench(speeds, step_s, latency);
    }
    let (rising_s, falling_s) = latency.rising_and_falling_s();
    let laws = [rising_s, falling_s].map(|lag_s| Lag::new(lag_s, step_s));
    let shifted = shifted(speeds, latency.delay_s / step_s);
    let mut state = shifted.first().copied().unwrap_or_default();
    let mut before = state;
    let follow = |now: &Vector4<f64>| {
        for ((state, before), now) in state.iter_mut().zip(before.iter()).zip(now.iter()) {
            let law = &laws[usize::from(0.5 * (before + now) < *state)];
            *state = law.follow(*state, *before, *now);
        }
        before = *now;
        state
    };
    shifted.iter().map(follow).collect()
}

/// First-order lag with first-order-hold input: exact for straight lines.
struct Lag {
    pole: f64,
    ramp: f64,
}

impl Lag {
    fn new(lag_s: f64, step_s: f64) -> Self {
        let pole = (-step_s / lag_s).exp();
        Self { pole, ramp: 1.0 - lag_s / step_s * (1.0 - pole) }
    }

    fn follow(&self, state: f64, before: f64, now: f64) -> f64 {
        self.pole * state + (1.0 - self.pole) * before + self.ramp * (now - before)
    }
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

fn lagged(series: &[Vector4<f64>], lag_s: f64, step_s: f64) -> Vec<Vector4<f64>> {
    let lag = Lag::new(lag_s, step_s);
    let mut state = series.first().copied().unwrap_or_default();
    let mut before = state;
    let follow = |now: &Vector4<f64>| {
        state = Vector4::from_fn(|i, _| lag.follow(state[i], before[i], now[i]));
        before = *now;
        state
    };
    series.iter().map(follow).collect()
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

    #[test]
    fn rotors_that_slow_down_slowly_turn_faster_than_a_jittering_command() {
        let alike = ActuationLatency { lag_s: 0.03, ..ActuationLatency::default() };
        let slower = ActuationLatency { uneven: 2f64.ln(), ..alike };
        let both = |series: &[Vector4<f64>], latency| delayed_speeds(series, 0.01, latency);
        // a ramp up is followed at the time constant of rising, one down at that of falling: 0.02 and 0.04 s
        let up = both(&ramp(), slower);
        assert!((up[399][0] - (3.99 - 0.02)).abs() < 1e-12);
        let down: Vec<_> = ramp().iter().map(|value| -value).collect();
        assert!((both(&down, slower)[399][0] + (3.99 - 0.04)).abs() < 1e-12);
        let jitter: Vec<_> =
            (0..400).map(|i| Vector4::repeat(if i / 3 % 2 == 0 { 1.1 } else { 0.9 })).collect();
        let mean = |series: &[Vector4<f64>]| series[100..].iter().map(|value| value[0]).sum::<f64>() / 300.0;
        assert!(mean(&both(&jitter, slower)) > 1.01 && (mean(&both(&jitter, alike)) - 1.0).abs() < 1e-3);
    }
}
