//! How well the vehicle hovers at the start gate, and for how long the gate has been open.

use std::collections::VecDeque;
use std::time::Duration;

use crate::fly::safety::Sustained;

/// A vehicle that hovers less precisely is observed for this time and assessed by its largest deviation.
const WATCHED: Duration = Duration::from_secs(5);

/// Precision of the hover, and the time for which the gate has been open.
#[derive(Debug, Default)]
pub(super) struct Gate {
    pub(super) open: Sustained,
    /// when, m off the start, m/s
    hover: VecDeque<(Duration, f64, f64)>,
    begun: Option<Duration>,
    pub(super) is_reported: bool,
}

impl Gate {
    pub(super) fn watch(&mut self, now: Duration, off_m: f64, speed_m_s: f64) {
        self.begun.get_or_insert(now);
        self.hover.push_back((now, off_m, speed_m_s));
        while self.hover.front().is_some_and(|(at, ..)| now.saturating_sub(*at) > WATCHED) {
            self.hover.pop_front();
        }
    }

    /// The largest distance (m) and speed (m/s) of the last seconds; `None` before there are enough data.
    pub(super) fn worst(&self, now: Duration) -> Option<(f64, f64)> {
        self.begun.filter(|begun| now.saturating_sub(*begun) >= WATCHED)?;
        let worst = self.hover.iter().fold((0.0_f64, 0.0_f64), |(off_m, speed_m_s), (_, off, speed)| {
            (off_m.max(*off), speed_m_s.max(*speed))
        });
        Some(worst)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_worst_is_known_after_five_seconds_and_forgets_the_way_there() {
        let mut gate = Gate::default();
        for t in 0..=100_u64 {
            let off_m = if t < 20 { 0.9 } else { 0.35 };
            let now = Duration::from_millis(100 * t);
            gate.watch(now, off_m, 0.25);
            match t {
                49 => assert_eq!(gate.worst(now), None),
                51 => assert_eq!(gate.worst(now), Some((0.9, 0.25))),
                100 => assert_eq!(gate.worst(now), Some((0.35, 0.25))),
                _ => {}
            }
        }
    }
}
