//! The next flight and its expected results.

use crate::diagnose::named::APART;
use crate::diagnose::signatures::latency_kind;
use crate::trajectory::FourierTrajectory;
use crate::vehicle::Limits;

/// The next flight.
#[derive(Debug, Clone, PartialEq)]
pub struct NextFlight {
    /// one period
    pub trajectory: FourierTrajectory,
    /// number of periods
    pub repeats: u32,
    /// s, all periods
    pub seconds: f64,
    /// limits that it keeps
    pub limits: Limits,
    /// the limits are those of the flights so far, because the vehicle file has none
    pub limits_are_flown: bool,
    /// the worst pair first
    pub pairs: Vec<Pair>,
    /// pairs that no flight separates
    pub inseparable: Vec<Inseparable>,
}

impl NextFlight {
    /// The expected results as a sentence.
    #[must_use]
    pub fn sentence(&self) -> String {
        let after = |pair: &Pair| {
            format!("now {:.1} sigma, after {:.0} s of this {:.1} sigma", pair.now, self.seconds, pair.after)
        };
        let pairs = self.pairs.iter().map(|pair| match pair.other {
            Some(other) => {
                let better =
                    if latency_kind(pair.named).is_some() && pair.after < APART { BY_SPEEDS } else { "" };
                format!("{} from {other}: {}{better}", pair.named, after(pair))
            }
            None => {
                format!("{} is confused with no other effect; its significance: {}", pair.named, after(pair))
            }
        });
        pairs.chain(self.inseparable.iter().map(ToString::to_string)).collect::<Vec<_>>().join("; ")
    }
}

/// Two effects that can be confused, or one effect and zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pair {
    /// the one that was named
    pub named: &'static str,
    /// the other; `None` if the named effect is confused with no other: then the distances are from zero
    pub other: Option<&'static str>,
    /// their distance in the previous flights, standard deviations
    pub now: f64,
    /// their distance in the next flight alone, if the named effect has its estimated size
    pub after: f64,
}

impl Pair {
    /// Their distance with the next flight, standard deviations.
    #[must_use]
    pub fn with_next(&self) -> f64 {
        self.now.hypot(self.after)
    }
}

/// Two effects that no trajectory separates.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Inseparable {
    /// the one that was named
    pub named: &'static str,
    /// the other
    pub other: &'static str,
    /// how they can be separated
    pub why: &'static str,
}

impl std::fmt::Display for Inseparable {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(out, "no trajectory separates {} from {}: {}", self.named, self.other, self.why)
    }
}

const BY_SPEEDS: &str = " (rotor speed telemetry, or doublets of 5 Hz and more, separate them)";
