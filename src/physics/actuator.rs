//! From command to rotor speed: a delay, then a first-order lag.
//!
//! This is the one law of both. The effect `motor_lag` integrates [`RotorLag::rate_1_s`]; along a recording
//! [`delayed_thrusts_n`] takes its exact solution from sample to sample. [`delayed_wrench`] puts force and torque behind it
//! instead of speeds, which is the same for small changes. Playback delays the thrusts that it interpolates and leaves
//! the lag to the effect.

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

    /// Time constants of rising and of falling speed.
    #[must_use]
    pub fn rotor_lag(&self) -> RotorLag {
        let rising_s = 2.0 * self.lag_s / (1.0 + self.uneven.exp());
        RotorLag { rising_s, falling_s: 2.0 * self.lag_s - rising_s }
    }
}

/// First-order lag of a rotor's speed `n` behind the commanded speed `c`: `n' = (c - n) / time constant`, of which there is
/// one for rising and one for falling speed, both in s and above 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RotorLag {
    /// s, while the speed is below the commanded one
    pub rising_s: f64,
    /// s, while it is above
    pub falling_s: f64,
}

impl RotorLag {
    /// Rate of a speed that misses the commanded one by `missing` (positive below it), in the unit of `missing` per s.
    #[must_use]
    pub fn rate_1_s(&self, missing: f64) -> f64 {
        missing * (1.0 / if missing > 0.0 { self.rising_s } else { self.falling_s })
    }

    /// The exact solution for a command that holds over a span of time (s, above 0).
    #[must_use]
    pub fn over(&self, span_s: f64) -> RotorStep {
        let [rising, falling] = [self.rising_s, self.falling_s].map(|lag_s| (-span_s / lag_s).exp());
        RotorStep { rising, falling }
    }
}

/// What a [`RotorLag`] makes of a command that holds over a span of time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RotorStep {
    /// share of the missing speed that is still missing at the end, while rising
    rising: f64,
    /// while falling
    falling: f64,
}

impl RotorStep {
    /// The speed at the end of the span, from that at its beginning and the commanded one.
    #[must_use]
    pub fn follow(&self, speed: f64, command: f64) -> f64 {
        let kept = if command < speed { self.falling } else { self.rising };
        kept * speed + (1.0 - kept) * command
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
fn delayed_speeds(speeds: &[Vector4<f64>], step_s: f64, latency: ActuationLatency) -> Vec<Vector4<f64>> {
    if latency.lag_s <= 0.0 || latency.uneven == 0.0 {
        return delayed_wrench(speeds, step_s, latency);
    }
    // each command holds from half a step before its instant to half a step after it: straight lines between the
    // instants would take half of the jitter away
    let steps = latency.delay_s / step_s - 0.5;
    let (whole, share) = (steps.floor(), steps - steps.floor());
    let lag = latency.rotor_lag();
    let laws = [(share, whole + 2.0), (1.0 - share, whole + 1.0)]
        .map(|(part, back)| (lag.over(part * step_s), shifted(speeds, back)));
    let mut state = laws[0].1.first().copied().unwrap_or_default();
    let follow = |index: usize| {
        for (step, held) in &laws {
            for (state, held) in state.iter_mut().zip(held[index].iter()) {
                *state = step.follow(*state, *held);
            }
        }
        state
    };
    (0..speeds.len()).map(follow).collect()
}

/// Rotor thrusts (N, `rotors` of them an instant) behind an actuation latency, which acts on their speeds.
#[must_use]
pub fn delayed_thrusts_n(
    thrusts_n: &[f64],
    rotors: usize,
    step_s: f64,
    latency: ActuationLatency,
) -> Vec<f64> {
    const WIDTH: usize = 4;
    let mut out = vec![0.0; thrusts_n.len()];
    for first in (0..rotors).step_by(WIDTH) {
        let of_one =
            |all: &[f64], i: usize| all.get(first + i).map_or(0.0, |thrust_n| thrust_n.max(0.0).sqrt());
        let speeds: Vec<Vector4<f64>> =
            thrusts_n.chunks_exact(rotors).map(|all| Vector4::from_fn(|i, _| of_one(all, i))).collect();
        let delayed = delayed_speeds(&speeds, step_s, latency);
        for (out, speeds) in out.chunks_exact_mut(rotors).zip(delayed) {
            out.iter_mut().skip(first).zip(speeds.iter()).for_each(|(out, speed)| *out = speed * speed);
        }
    }
    out
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
    fn the_solution_over_a_span_is_the_integral_of_the_rate() {
        let lag = RotorLag { rising_s: 0.02, falling_s: 0.05 };
        for (from, command) in [(0.8, 1.1), (1.3, 0.9)] {
            let (mut speed, step_s) = (from, 1e-6);
            for _ in 0..30_000 {
                speed += step_s * lag.rate_1_s(command - speed);
            }
            assert!((lag.over(0.03).follow(from, command) - speed).abs() < 1e-5, "{speed}");
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
        assert!((up[399][0] - (3.99 - 0.02)).abs() < 3e-4);
        let down: Vec<_> = ramp().iter().map(|value| -value).collect();
        assert!((both(&down, slower)[399][0] + (3.99 - 0.04)).abs() < 3e-4);
        let jitter: Vec<_> =
            (0..400).map(|i| Vector4::repeat(if i / 3 % 2 == 0 { 1.1 } else { 0.9 })).collect();
        let mean = |series: &[Vector4<f64>]| series[100..].iter().map(|value| value[0]).sum::<f64>() / 300.0;
        assert!(mean(&both(&jitter, slower)) > 1.01 && (mean(&both(&jitter, alike)) - 1.0).abs() < 1e-3);
    }
}
