//! How fast bytes come.

use std::time::Duration;

/// The speed is measured for this long. Shorter would measure the link's buffers, longer delays the choice.
const MEASURED: Duration = Duration::from_secs(2);

/// How fast bytes come, measured once.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Gauge {
    /// when it began, and bytes that there were
    began: Option<(Duration, u64)>,
    bytes_s: Option<f64>,
}

impl Gauge {
    /// There are so many bytes now.
    pub(super) fn note(&mut self, now: Duration, bytes: u64) {
        let (since, first) = *self.began.get_or_insert((now, bytes));
        let passed = now.saturating_sub(since);
        if self.bytes_s.is_none() && passed >= MEASURED {
            self.bytes_s = Some(bytes.saturating_sub(first) as f64 / passed.as_secs_f64());
        }
    }

    /// There are so many bytes at the end: measured so far, if any time has passed.
    pub(super) fn end(&mut self, now: Duration, bytes: u64) {
        self.note(now, bytes);
        let passed_s = self.began.map_or(0.0, |(since, _)| now.saturating_sub(since).as_secs_f64());
        if let (None, Some((_, first))) = (self.bytes_s, self.began)
            && passed_s > 0.0
        {
            self.bytes_s = Some(bytes.saturating_sub(first) as f64 / passed_s);
        }
    }

    /// Bytes a second, once they were measured.
    pub(super) fn bytes_s(&self) -> Option<f64> {
        self.bytes_s
    }
}

/// How long so many bytes take at this speed.
pub(super) fn seconds(bytes: u64, bytes_s: f64) -> f64 {
    match bytes {
        0 => 0.0,
        bytes if bytes_s > 0.0 => bytes as f64 / bytes_s,
        _ => f64::INFINITY,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_speed_is_that_of_the_first_seconds() {
        let mut gauge = Gauge::default();
        let ms = Duration::from_millis;
        gauge.note(ms(700), 1000);
        gauge.note(ms(2600), 90_000);
        assert_eq!(gauge.bytes_s(), None);
        gauge.note(ms(2700), 81_000);
        gauge.note(ms(9000), 1_000_000);
        assert_eq!(gauge.bytes_s(), Some(40_000.0));
        // all was there before
        let mut short = Gauge::default();
        short.note(ms(100), 0);
        short.end(ms(600), 50_000);
        assert_eq!(short.bytes_s(), Some(100_000.0));
        let mut none = Gauge::default();
        none.end(ms(1), 9);
        assert_eq!(none.bytes_s(), None);
    }

    #[test]
    fn nothing_comes_in_no_time_and_the_rest_never() {
        assert_eq!((seconds(0, 0.0), seconds(10, 0.0), seconds(10, 5.0)), (0.0, f64::INFINITY, 2.0));
    }
}
