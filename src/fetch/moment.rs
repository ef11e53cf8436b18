//! When something was done with a vehicle, by this computer's clock and by the vehicle's time since its start.

use std::time::{SystemTime, UNIX_EPOCH};

use serde::{Deserialize, Serialize};

/// A vehicle's clock that runs faster than this computer's by more than this factor is that of a simulation.
const FASTER: f64 = 1.5;
/// Allowance for a link that is slow and for clocks that are set, s.
const ALLOWANCE_S: f64 = 5.0;

/// An instant.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Moment {
    /// s since 1970 UTC, by this computer's clock
    pub utc_s: f64,
    /// s since the vehicle started, as it says; `None` where it does not say
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub up_s: Option<f64>,
}

impl Moment {
    /// Now, with what the vehicle says of its time since its start.
    #[must_use]
    pub fn now(up_s: Option<f64>) -> Self {
        let since = SystemTime::now().duration_since(UNIX_EPOCH);
        Self { utc_s: since.map_or(0.0, |since| since.as_secs_f64()), up_s }
    }

    /// Whether the vehicle has started anew between this instant and a later one; `None` where the clocks do not tell.
    ///
    /// If it has not, it is up for as long as then and the time since; if it has, for less than the time since.
    #[must_use]
    pub fn restarted_until(&self, later: &Self) -> Option<bool> {
        let (then_s, now_s) = (self.up_s?, later.up_s?);
        if now_s < then_s {
            return Some(true);
        }
        let passed_s = later.utc_s - self.utc_s;
        let is_own_time = passed_s < 0.0 || now_s > FASTER * (then_s + passed_s) + ALLOWANCE_S;
        (!is_own_time).then_some(now_s < passed_s + 0.5 * then_s)
    }
}

#[cfg(test)]
mod tests {
    use super::Moment;

    #[test]
    fn a_restart_is_told_by_the_time_since_the_start() {
        let at = |utc_s: f64, up_s: f64| Moment { utc_s, up_s: Some(up_s) };
        let set = at(1e9, 60.0);
        for (later, restarted) in [
            // its clock may drift
            (at(1e9 + 10.0, 70.3), Some(false)),
            (at(1e9 + 86_400.0, 86_450.0), Some(false)),
            // a minute after a restart, and long after one
            (at(1e9 + 100.0, 40.0), Some(true)),
            (at(1e9 + 3600.0, 3590.0), Some(true)),
            // a simulation at ten times the speed, and a computer whose clock was set back
            (at(1e9 + 100.0, 900.0), None),
            (at(1e9 - 100.0, 160.0), None),
            (Moment { utc_s: 1e9 + 10.0, up_s: None }, None),
        ] {
            assert_eq!(set.restarted_until(&later), restarted, "{later:?}");
        }
        assert!(Moment::now(None).utc_s > 1.7e9);
    }
}
