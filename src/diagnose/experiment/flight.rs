//! What to fly, and what it will tell apart.

use crate::diagnose::signatures::latency_kind;
use crate::trajectory::FourierTrajectory;
use crate::vehicle::Limits;

/// What to fly.
#[derive(Debug, Clone, PartialEq)]
pub struct NextFlight {
    /// one period
    pub trajectory: FourierTrajectory,
    /// how often
    pub repeats: u32,
    /// s, all periods
    pub seconds: f64,
    /// limits that it keeps
    pub limits: Limits,
    /// the limits are those of the flights so far, because the vehicle file has none
    pub limits_are_flown: bool,
    /// the worst pair first
    pub pairs: Vec<Pair>,
    /// what it cannot tell apart, nor any other
    pub inseparable: Vec<Inseparable>,
}

impl NextFlight {
    /// For people: what it will bring.
    #[must_use]
    pub fn sentence(&self) -> String {
        let after = |pair: &Pair| {
            format!("now {:.1} sigma, after {:.0} s of this {:.1} sigma", pair.now, self.seconds, pair.after)
        };
        let pairs = self.pairs.iter().map(|pair| match pair.other {
            Some(other) => {
                let better = if latency_kind(pair.named).is_some() && pair.after < ENOUGH_SIGMA {
                    BY_SPEEDS
                } else {
                    ""
                };
                format!("{} from {other}: {}{better}", pair.named, after(pair))
            }
            None => {
                format!("{} is confused with no other effect; its significance: {}", pair.named, after(pair))
            }
        });
        pairs.chain(self.inseparable.iter().map(ToString::to_string)).collect::<Vec<_>>().join("; ")
    }
}

/// Two effects that can be taken for each other, or one and nothing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pair {
    /// the one that was named
    pub named: &'static str,
    /// the other; `None` where nothing could be taken for it: how far it stands out of the noise
    pub other: Option<&'static str>,
    /// standard deviations by which the flights so far tell them apart
    pub now: f64,
    /// and the next flight alone, if what was named is there at its size
    pub after: f64,
}

/// Two effects that no trajectory tells apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Inseparable {
    /// the one that was named
    pub named: &'static str,
    /// the other
    pub other: &'static str,
    /// and what does
    pub why: &'static str,
}

impl std::fmt::Display for Inseparable {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(out, "no trajectory separates {} from {}: {}", self.named, self.other, self.why)
    }
}

/// Below this many standard deviations two effects are not told apart.
const ENOUGH_SIGMA: f64 = 5.0;

const BY_SPEEDS: &str = " (rotor speed telemetry, or doublets of 5 Hz and more, separate them)";
