//! The state that the autopilot reports: armed, landed, and whether it commanded thrust.

use crate::recording::landed::{IN_AIR, TAKEOFF, UNDEFINED};
use crate::recording::{Quantity, Recording, Stream};

/// What an autopilot says of being in the air.
#[derive(Debug, Clone, Copy)]
pub struct ReportedState<'a> {
    landed: Option<&'a Stream>,
    armed: Option<&'a Stream>,
    asks: bool,
    /// a word counts this long before and after, s
    margin_s: f64,
}

/// In a damaged log the word that ends a flight may be lost, and a later one ends it: at both ends so much is left out, s.
/// Measured on copies of two flights with 1 % of their bytes wrong, six seeds: they came out 0.7 s too long at most.
pub(super) const DAMAGED_S: f64 = 1.0;

impl<'a> ReportedState<'a> {
    /// What a recording holds of it.
    #[must_use]
    pub fn of(recording: &'a Recording) -> Self {
        let streams = |wanted: Quantity| {
            let of = recording.streams.iter().filter(move |(key, _)| key.quantity == wanted);
            of.map(|(_, stream)| stream).filter(|stream| !stream.is_empty())
        };
        let armed = streams(Quantity::Armed).next();
        let thrusts = || streams(Quantity::ThrustSetpoint).chain(streams(Quantity::ThrustVectorSetpoint));
        // what a setpoint is to an autopilot that flies by others is not known: it is heard where nothing else speaks
        let asks = armed.is_some()
            || thrusts().next().is_none()
            || thrusts().any(|thrust| thrust.values.iter().any(|value| *value != 0.0));
        let margin_s = if recording.is_damaged { DAMAGED_S } else { 0.0 };
        Self { landed: streams(Quantity::LandedState).next(), armed, asks, margin_s }
    }

    /// The autopilot tells when it has landed.
    #[must_use]
    pub fn tells_landed(&self) -> bool {
        self.landed.is_some()
    }

    /// It tells whether it is armed, and never was.
    #[must_use]
    pub fn never_armed(&self) -> bool {
        self.armed.is_some_and(|armed| armed.values.iter().all(|armed| *armed < 0.5))
    }

    /// Its words of being armed, else of having landed, whichever it tells.
    #[must_use]
    pub fn words(&self) -> Option<&'a Stream> {
        self.landed.or(self.armed)
    }

    /// Nothing that it said speaks against flying freely at `t_s`: it is neither disarmed, nor landed, nor about to take off
    /// or land. Before its first word nothing does.
    #[must_use]
    pub fn may_fly(&self, t_s: f64) -> bool {
        self.may_be(t_s, &[UNDEFINED, IN_AIR])
    }

    /// The same, take-off and landing included.
    #[must_use]
    pub fn may_be_off_ground(&self, t_s: f64) -> bool {
        self.may_be(t_s, &[UNDEFINED, IN_AIR, TAKEOFF, LANDING])
    }

    fn may_be(&self, t_s: f64, states: &[f64]) -> bool {
        let margin_s = self.margin_s;
        self.may_be_at(t_s, states)
            && (margin_s == 0.0
                || [t_s - margin_s, t_s + margin_s].iter().all(|t_s| self.may_be_at(*t_s, states)))
    }

    fn may_be_at(&self, t_s: f64, states: &[f64]) -> bool {
        let armed = self.armed.and_then(|armed| last_word(armed, t_s)).is_none_or(|armed| armed > 0.5);
        let landed = self.landed.and_then(|landed| last_word(landed, t_s));
        self.asks
            && armed
            && landed.is_none_or(|landed| states.iter().any(|state| (state - landed).abs() < 0.5))
    }
}

/// Taking off and landing count as flight where less than this is left without them, s. It is what remains of a short
/// hop; with less nothing can be identified anyway.
pub const LEAST_FREE_S: f64 = 8.0;

const LANDING: f64 = 4.0;

fn last_word(states: &Stream, t_s: f64) -> Option<f64> {
    let next = states.time_s.partition_point(|t| *t <= t_s);
    states.values.get(next.checked_sub(1)? * states.width).copied()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::StreamKey;

    fn stream(time_s: &[f64], values: &[f64]) -> Stream {
        Stream { time_s: time_s.to_vec(), width: 1, values: values.to_vec() }
    }

    fn recording(streams: &[(Quantity, Stream)]) -> Recording {
        let keyed = streams.iter().cloned();
        Recording {
            streams: keyed
                .map(|(quantity, stream)| (StreamKey { quantity, source: "test", instance: 0 }, stream))
                .collect(),
            ..Recording::default()
        }
    }

    #[test]
    fn in_the_air_is_neither_disarmed_nor_landed() {
        let armed = stream(&[1.0, 9.0], &[1.0, 0.0]);
        let landed = stream(&[2.0, 3.0, 7.0, 8.0], &[1.0, 2.0, 4.0, 1.0]);
        let said = recording(&[(Quantity::Armed, armed), (Quantity::LandedState, landed)]);
        let said = ReportedState::of(&said);
        let times_s = [0.0, 1.5, 2.5, 3.5, 7.5, 8.5, 9.5];
        assert_eq!(times_s.map(|t_s| said.may_fly(t_s)), [true, true, false, true, false, false, false]);
        assert_eq!(
            times_s.map(|t_s| said.may_be_off_ground(t_s)),
            [true, true, false, true, true, false, false]
        );
        assert!(said.tells_landed() && !said.never_armed());
        let idle = recording(&[(Quantity::Armed, stream(&[0.0, 1.0], &[0.0, 0.0]))]);
        assert!(
            ReportedState::of(&idle).never_armed() && !ReportedState::of(&Recording::default()).never_armed()
        );
    }

    #[test]
    fn a_damaged_log_flies_no_longer_than_its_words_are_certain() {
        let landed = stream(&[0.0, 3.0, 9.0], &[1.0, 2.0, 1.0]);
        let mut damaged = recording(&[(Quantity::LandedState, landed)]);
        let at =
            |recording: &Recording| [3.5, 4.5, 7.5, 8.5].map(|t_s| ReportedState::of(recording).may_fly(t_s));
        assert_eq!(at(&damaged), [true; 4]);
        damaged.is_damaged = true;
        assert_eq!(at(&damaged), [false, true, true, false]);
    }

    #[test]
    fn an_autopilot_that_never_asks_for_thrust_does_not_fly() {
        let (nought, thrust) = (stream(&[0.0, 1.0], &[0.0, 0.0]), stream(&[0.0, 1.0], &[0.0, 0.4]));
        assert!(!ReportedState::of(&recording(&[(Quantity::ThrustSetpoint, nought.clone())])).may_fly(0.5));
        assert!(ReportedState::of(&recording(&[(Quantity::ThrustSetpoint, thrust)])).may_fly(0.5));
        let armed = (Quantity::Armed, stream(&[0.0], &[1.0]));
        assert!(ReportedState::of(&recording(&[(Quantity::ThrustSetpoint, nought), armed])).may_fly(0.5));
        assert!(ReportedState::of(&Recording::default()).may_fly(0.5));
    }
}
