//! The next flight and its expected results.

use crate::diagnose::sentence::called;
use crate::diagnose::signatures::latency_kind;
use crate::diagnose::told_apart::apart_from;
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
        let seconds = format!("{:.0} s of this", self.seconds);
        let pairs = self.pairs.iter().map(|pair| {
            let distance = pair.distance(&seconds);
            match pair.other {
                Some(other) => {
                    let better = pair.otherwise().map_or_else(String::new, |how| format!(" ({how})"));
                    format!("{} against {}: {distance}{better}", called(pair.named), called(other))
                }
                None => {
                    format!("{} is confused with no other effect; from zero: {distance}", called(pair.named))
                }
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

    /// What the next flight leaves of the statistical error, as a share of it now.
    #[must_use]
    pub fn share_left(&self) -> f64 {
        self.now / self.with_next()
    }

    /// With the next flight the two effects are told apart.
    #[must_use]
    pub fn is_told_apart(&self) -> bool {
        self.other.is_some_and(|other| self.with_next() >= apart_from(other))
    }

    /// With the next flight the two effects are told apart, and without it they are not.
    #[must_use]
    pub fn is_told_apart_by_next(&self) -> bool {
        self.is_told_apart() && self.other.is_some_and(|other| self.now < apart_from(other))
    }

    /// Their distance in words, now and with the next flight, which has the name `flight`.
    #[must_use]
    pub fn distance(&self, flight: &str) -> String {
        let apart = match self.other {
            Some(other) if !self.is_told_apart() => format!(", and {:.0} tell them apart", apart_from(other)),
            _ => String::new(),
        };
        format!("now {:.1}, with {flight} {:.1} standard deviations{apart}", self.now, self.with_next())
    }

    /// What else would tell the two apart, if the next flight does not; `None` where nothing is known.
    #[must_use]
    pub fn otherwise(&self) -> Option<&'static str> {
        (latency_kind(self.named).is_some() && !self.is_told_apart()).then_some(BY_SPEEDS)
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
        write!(
            out,
            "no trajectory separates {} from {}: {}",
            called(self.named),
            called(self.other),
            self.why
        )
    }
}

const BY_SPEEDS: &str = "rotor speed telemetry, or doublets of 5 Hz and more, separate them";

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trajectory::FourierAxis;

    /// A person reads names; identifiers are for files.
    #[test]
    fn sentences_have_the_names_of_effects_and_not_their_identifiers() {
        let pair = |other| Pair { named: "motor_lag", other, now: 1.5, after: 1.2 };
        let apart = Inseparable { named: "inflow", other: "thrust_curve", why: "fly a climb" };
        let next = NextFlight {
            trajectory: FourierTrajectory {
                period_s: 10.0,
                axes: std::array::from_fn(|_| FourierAxis { a: vec![0.1], b: vec![0.1], c: 0.0 }),
            },
            repeats: 2,
            seconds: 54.0,
            limits: Limits::default(),
            limits_are_flown: false,
            pairs: vec![pair(Some("transport_delay")), pair(None)],
            inseparable: vec![apart],
        };
        let said = next.sentence();
        assert!(!said.contains('_'), "{said}");
        for id in ["motor_lag", "transport_delay", "inflow", "thrust_curve"] {
            assert!(said.contains(called(id)), "{said}");
        }
    }

    #[test]
    fn only_what_counts_as_told_apart_is_said_to_be() {
        let pair = |now, after| Pair { named: "motor_lag", other: Some("transport_delay"), now, after };
        let near = pair(1.5, 1.2);
        assert!(!near.is_told_apart() && near.otherwise().is_some());
        assert_eq!(near.distance("it"), "now 1.5, with it 1.9 standard deviations, and 15 tell them apart");
        let far = pair(9.0, 12.0);
        assert!(far.is_told_apart() && far.otherwise().is_none());
        assert_eq!(far.distance("it"), "now 9.0, with it 15.0 standard deviations");
        assert!(far.is_told_apart_by_next() && !pair(15.0, 4.0).is_told_apart_by_next());
        // other pairs need less
        assert!(
            Pair { named: "linear_drag", other: Some("quadratic_drag"), now: 3.0, after: 4.0 }
                .is_told_apart()
        );
    }
}
