//! The vehicle's clock against the host's, in constant memory.

use super::inspection::ClockSummary;
use crate::log::Place;
use crate::recording::Event;
use crate::units::seconds_from_us;
use crate::wire::HOST_STEP_US;

/// Time over which arrivals are evaluated together, s. It averages jitter and is short against a drift.
const BLOCK_S: f64 = 1.0;
/// Restarts that are kept; a log with more is broken. Only memory depends on it.
const KEPT_RESETS: usize = 1000;
/// Largest standard error of a drift that is reported, parts per million. Quartz clocks are off by 50: a worse
/// estimate says nothing.
const VAGUEST_PPM: f64 = 1000.0;

/// Collects what [`ClockSummary`] says.
#[derive(Debug, Clone, Default)]
pub(super) struct ClockTally {
    span_s: Option<(f64, f64)>,
    /// host's stamp beside the recording's start, by the first stamped sample
    start_host_us: Option<u64>,
    block: Option<Block>,
    drift: Line,
    /// the drift of the longest stretch between restarts
    longest: Line,
    arrivals: u64,
    arrival_square_s2: f64,
    arrival_latest_s: f64,
    resets_s: Vec<f64>,
    estimator_resets_s: Vec<f64>,
}

/// Differences of host and vehicle of one block, s since the recording's start on both clocks.
#[derive(Debug, Clone, Copy)]
struct Block {
    start_s: f64,
    count: u64,
    sum_s: f64,
    square_s2: f64,
    least_s: f64,
    most_s: f64,
}

/// Sums of a straight line through points, the first of which is the origin.
#[derive(Debug, Clone, Copy, Default)]
struct Line {
    origin: Option<(f64, f64)>,
    n: f64,
    x: f64,
    y: f64,
    xx: f64,
    xy: f64,
    yy: f64,
}

impl Line {
    fn add(&mut self, x: f64, y: f64) {
        let (x0, y0) = *self.origin.get_or_insert((x, y));
        let (x, y) = (x - x0, y - y0);
        self.n += 1.0;
        self.x += x;
        self.y += y;
        self.xx += x * x;
        self.xy += x * y;
        self.yy += y * y;
    }

    /// Slope and its standard error.
    fn slope(&self) -> Option<(f64, f64)> {
        let spread = self.xx - self.x * self.x / self.n;
        if self.n < 5.0 || spread <= 0.0 {
            return None;
        }
        let common = self.xy - self.x * self.y / self.n;
        let slope = common / spread;
        let rest = (self.yy - self.y * self.y / self.n - slope * common).max(0.0);
        Some((slope, (rest / (self.n - 2.0) / spread).sqrt()))
    }
}

impl ClockTally {
    /// Takes what an event tells of the clocks.
    pub(super) fn add(&mut self, place: Place, event: &Event<'_>) {
        match event {
            Event::Sample { time_s, .. } => {
                self.cover(*time_s);
                if let Some(arrival_us) = place.arrival_us {
                    self.arrival(arrival_us, *time_s);
                }
            }
            Event::ClockReset { time_s, .. } => self.reset(*time_s),
            Event::EstimatorReset { time_s } => keep(&mut self.estimator_resets_s, *time_s),
            Event::Autopilot(_)
            | Event::Parameter { .. }
            | Event::ParameterDefault { .. }
            | Event::Text { .. } => {}
        }
    }

    /// A sample at this time.
    pub(super) fn cover(&mut self, time_s: f64) {
        let span = self.span_s.get_or_insert((time_s, time_s));
        *span = (span.0.min(time_s), span.1.max(time_s));
    }

    /// The vehicle's clock restarted.
    pub(super) fn reset(&mut self, time_s: f64) {
        keep(&mut self.resets_s, time_s);
        self.end_line();
    }

    fn end_line(&mut self) {
        self.close_block();
        if self.drift.xx > self.longest.xx {
            self.longest = self.drift;
        }
        self.drift = Line::default();
    }

    fn arrival(&mut self, host_us: u64, time_s: f64) {
        let start_host_us = *self.start_host_us.get_or_insert(host_us);
        // microseconds of a recording fit a double exactly
        let since_s = seconds_from_us(host_us as f64 - start_host_us as f64);
        let late_s = since_s - time_s;
        if self
            .block
            .as_ref()
            .is_some_and(|block| (late_s - block.least_s).abs() > seconds_from_us(HOST_STEP_US as f64))
        {
            // the host's clock was set: what lies before is no part of the same line
            self.end_line();
        }
        match &mut self.block {
            Some(block) if (time_s - block.start_s).abs() < BLOCK_S => {
                block.count += 1;
                block.sum_s += late_s;
                block.square_s2 += late_s * late_s;
                block.least_s = block.least_s.min(late_s);
                block.most_s = block.most_s.max(late_s);
            }
            _ => {
                self.close_block();
                self.block = Some(Block {
                    start_s: time_s,
                    count: 1,
                    sum_s: late_s,
                    square_s2: late_s * late_s,
                    least_s: late_s,
                    most_s: late_s,
                });
            }
        }
    }

    /// The earliest arrival of a block is the one that waited least: it shows the clocks.
    fn close_block(&mut self) {
        let Some(block) = self.block.take().filter(|block| block.count > 1) else { return };
        self.drift.add(block.start_s, block.least_s);
        let mean_s = block.sum_s / block.count as f64;
        self.arrivals += block.count;
        self.arrival_square_s2 += (block.square_s2 - mean_s * block.sum_s).max(0.0);
        self.arrival_latest_s = self.arrival_latest_s.max(block.most_s - block.least_s);
    }

    /// What was collected.
    pub(super) fn summary(mut self) -> ClockSummary {
        self.close_block();
        let line = if self.drift.xx >= self.longest.xx { self.drift } else { self.longest };
        let drift =
            line.slope().map(|(slope, std)| (slope * 1e6, std * 1e6)).filter(|(_, std)| *std < VAGUEST_PPM);
        let arrivals = self.arrivals as f64;
        ClockSummary {
            span_s: self.span_s.unwrap_or((f64::NAN, f64::NAN)),
            start_utc_us: self.start_host_us,
            drift_ppm: drift.map(|(slope, _)| slope),
            drift_std_ppm: drift.map(|(_, std)| std),
            arrival_jitter_s: (self.arrivals > 0).then(|| (self.arrival_square_s2 / arrivals).sqrt()),
            arrival_latest_s: (self.arrivals > 0).then_some(self.arrival_latest_s),
            resets_s: self.resets_s,
            estimator_resets_s: self.estimator_resets_s,
        }
    }
}

fn keep(times_s: &mut Vec<f64>, time_s: f64) {
    if times_s.len() < KEPT_RESETS {
        times_s.push(time_s);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn drift_and_lateness_come_back() {
        let mut tally = ClockTally::default();
        let start_us = 1_700_000_000_000_000.0;
        for index in 0..12_000_u32 {
            let time_s = f64::from(index) * 0.01;
            // the vehicle's clock runs 0.7 % slow; every seventh frame is 5 ms late
            let late_s = if index % 7 == 0 { 0.005 } else { 0.0 };
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "whole, positive")]
            let host_us = (start_us + (time_s * 1.007 + late_s) * 1e6).round() as u64;
            tally.arrival(host_us, time_s);
        }
        let summary = tally.summary();
        assert!((summary.drift_ppm.unwrap() - 7000.0).abs() < 5.0, "{summary:?}");
        // a second of drift moves the arrivals by another 7 ms
        assert!((summary.arrival_latest_s.unwrap() - 0.012).abs() < 1e-3, "{summary:?}");
    }
}
