//! The stream of setpoints, and the watch over its freshness.
//!
//! A setpoint is made when it is sent, for that instant; none is ever sent twice, and what was missed is
//! not made up. The supervisor of the flight renews the [`Guide`] many times a second. Where it does not, or where this
//! stream itself was held up, nothing is sent any more: a command by whoever knows no mode could take the vehicle from its
//! pilot. The supervisor is told, and orders what is to be ordered once it knows the mode; until then, and if it never
//! wakes, the autopilot's own failsafe acts.

use std::time::Duration;

use super::{Feeding, SetpointBounds};
use crate::autopilot::Stack;
use crate::fly::course::Track;
use crate::fly::setpoint::{Place, Setpoint};
use crate::fly::target::{OutOfRange, Target};
use mavlink::dialects::ardupilotmega::MavMessage;

/// After a supervisor or a stream stood still for longer, no setpoint goes out: what the flight knows may be outdated. It is
/// stepped every 10 ms.
pub(in crate::fly) const SILENT_AFTER: Duration = Duration::from_millis(100);

/// What the setpoints follow.
#[derive(Debug, Clone, PartialEq)]
pub enum Lead {
    /// nothing is sent
    Silent,
    /// a place
    Hold(Place),
    /// a path
    Along(Track),
}

/// What is to be streamed, renewed with every tick of the flight.
#[derive(Debug, Clone, PartialEq)]
pub struct Guide {
    /// what the setpoints follow
    pub lead: Lead,
    /// when it was renewed
    pub issued: Duration,
    /// the mode is not known: nothing is sent until it is
    pub held_back: bool,
    /// whom the setpoints are for, and by which rules; `None` while no vehicle is chosen
    pub target: Option<(Target, &'static Stack)>,
    /// how setpoints are made from the reference
    pub feeding: Feeding,
    /// nothing is sent beyond; `None` while nothing is known of where the vehicle is
    pub bounds: Option<SetpointBounds>,
}

impl Guide {
    /// Nothing to stream.
    #[must_use]
    pub fn silent(issued: Duration) -> Self {
        Self {
            lead: Lead::Silent,
            issued,
            held_back: false,
            target: None,
            feeding: Feeding::whole(),
            bounds: None,
        }
    }

    /// The reference of an instant; `None` where nothing is to be sent.
    #[must_use]
    pub fn setpoint(&self, time: Duration) -> Option<Setpoint> {
        match &self.lead {
            _ if self.held_back => None,
            Lead::Silent => None,
            Lead::Hold(place) => Some(Setpoint::hold(time, place)),
            Lead::Along(track) => track.setpoint(time),
        }
    }

    /// What is sent for an instant: the reference as it is fed, within the bounds.
    #[must_use]
    pub fn sent(&self, time: Duration) -> Option<Setpoint> {
        let fed = self.feeding.apply(&self.setpoint(time)?);
        self.bounds.map_or(Some(fed), |bounds| bounds.keep(&fed))
    }
}

/// What comes of an instant of the stream.
#[derive(Debug, Clone, PartialEq)]
pub enum Streamed {
    /// a setpoint, and its message
    Setpoint(Setpoint, Box<MavMessage>),
    /// the supervisor or the stream stood still for so long: nothing is sent
    Stalled(Duration),
    /// a setpoint that no message can carry: nothing is sent
    Unfit(OutOfRange),
}

/// Makes the setpoints at their times.
#[derive(Debug)]
pub struct Streamer {
    period: Duration,
    next_due: Duration,
    /// last time it was asked while there was something to stream
    polled: Option<Duration>,
    stalled: bool,
}

impl Streamer {
    /// One setpoint each `period`.
    #[must_use]
    pub fn new(period: Duration) -> Self {
        Self { period, next_due: Duration::ZERO, polled: None, stalled: false }
    }

    /// When it is to be asked next.
    #[must_use]
    pub fn due(&self) -> Duration {
        self.next_due
    }

    /// What to send at `now`. After a stall it stays silent until the flight has nothing to stream.
    pub fn poll(&mut self, now: Duration, guide: &Guide) -> Option<Streamed> {
        if now < self.next_due {
            return None;
        }
        self.advance(now);
        let (Some(setpoint), Some((target, _))) = (guide.sent(now), guide.target) else {
            *self = Self { next_due: self.next_due, ..Self::new(self.period) };
            return None;
        };
        let own = self.polled.replace(now).map_or(Duration::ZERO, |last| now.saturating_sub(last));
        if self.stalled {
            return None;
        }
        let gap = own.max(now.saturating_sub(guide.issued));
        if gap <= SILENT_AFTER {
            return Some(match setpoint.message(target) {
                Ok(message) => Streamed::Setpoint(setpoint, Box::new(message)),
                Err(why) => Streamed::Unfit(why),
            });
        }
        self.stalled = true;
        Some(Streamed::Stalled(gap))
    }

    /// To the next instant of the grid, the multiples of the period; those that were missed are gone.
    fn advance(&mut self, now: Duration) {
        let late = now.saturating_sub(self.next_due).as_nanos() / self.period.as_nanos().max(1);
        let missed = u32::try_from(late).unwrap_or(u32::MAX);
        self.next_due += self.period.saturating_mul(missed.saturating_add(1));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::autopilot::PX4;
    use crate::wire::{ComponentId, SystemId};
    use nalgebra::Vector3;
    use proptest::prelude::*;

    fn ms(value: u64) -> Duration {
        Duration::from_millis(value)
    }

    fn guide(issued: Duration) -> Guide {
        let place = Place { position_m: Vector3::new(1.0, 0.0, 2.0), yaw_rad: 0.0 };
        let target = Target::new(SystemId(1), ComponentId(1)).unwrap();
        Guide { lead: Lead::Hold(place), target: Some((target, &PX4)), ..Guide::silent(issued) }
    }

    #[test]
    fn setpoints_come_at_their_period() {
        let mut streamer = Streamer::new(ms(20));
        let sent: Vec<u64> = (0..200)
            .filter(|t| matches!(streamer.poll(ms(*t), &guide(ms(*t))), Some(Streamed::Setpoint(..))))
            .collect();
        assert_eq!(sent, (0..10).map(|k| 20 * k).collect::<Vec<_>>());
    }

    #[test]
    fn one_that_comes_late_is_followed_by_the_next_of_the_grid() {
        let mut streamer = Streamer::new(ms(20));
        let sent: Vec<u64> = [0, 23, 39, 40, 85, 99, 100]
            .into_iter()
            .filter(|t| streamer.poll(ms(*t), &guide(ms(*t))).is_some())
            .collect();
        assert_eq!(sent, [0, 23, 40, 85, 100], "60 is missed");
    }

    #[test]
    fn a_late_supervisor_ends_the_stream_and_nothing_is_commanded() {
        let mut streamer = Streamer::new(ms(20));
        let mut seen = Vec::new();
        for t in 0..1000 {
            // renewed until 400 ms
            match streamer.poll(ms(t), &guide(ms(t.min(400)))) {
                Some(Streamed::Setpoint(..)) => assert!(t <= 500, "at {t} ms"),
                Some(Streamed::Stalled(gap)) => {
                    assert_eq!(gap, ms(120));
                    seen.push(t);
                }
                Some(Streamed::Unfit(why)) => panic!("{why}"),
                None => {}
            }
        }
        assert_eq!(seen, [520]);
    }

    #[test]
    fn after_a_long_stall_no_setpoint_goes_out() {
        let mut streamer = Streamer::new(ms(20));
        assert!(streamer.poll(ms(0), &guide(ms(0))).is_some());
        assert_eq!(streamer.poll(ms(450), &guide(ms(450))), Some(Streamed::Stalled(ms(450))));
        assert!(streamer.poll(ms(470), &guide(ms(470))).is_none());
        assert!(streamer.poll(ms(490), &Guide::silent(ms(490))).is_none());
        assert!(streamer.poll(ms(510), &guide(ms(510))).is_some(), "a new stream");
    }

    #[test]
    fn while_the_mode_is_not_known_nothing_goes_out() {
        let mut streamer = Streamer::new(ms(20));
        for t in 0..400 {
            let doubted = Guide { held_back: (100..300).contains(&t), ..guide(ms(t)) };
            let sent = streamer.poll(ms(t), &doubted);
            assert!(!(doubted.held_back && sent.is_some()), "at {t} ms");
            assert!(!matches!(sent, Some(Streamed::Stalled(_))), "a pause that is wanted is no stall");
        }
    }

    #[test]
    fn what_no_message_can_carry_is_told_and_not_sent() {
        let mut streamer = Streamer::new(ms(20));
        let mut lost = guide(ms(0));
        lost.lead = Lead::Hold(Place { position_m: Vector3::new(f64::NAN, 0.0, 2.0), yaw_rad: 0.0 });
        let Some(Streamed::Unfit(why)) = streamer.poll(ms(0), &lost) else {
            panic!("a setpoint of no number")
        };
        assert_eq!(why.got, "NaN");
        assert!(
            matches!(streamer.poll(ms(20), &guide(ms(20))), Some(Streamed::Setpoint(..))),
            "the next is sent"
        );
    }

    proptest! {
        /// However late it is asked and however late the flight is: each setpoint is for the instant at which
        /// it goes out, never one twice, never one from a flight that is not alive.
        #[test]
        fn nothing_stale_ever_goes_out(steps in proptest::collection::vec((1_u64..130, any::<bool>()), 1..200)) {
            let mut streamer = Streamer::new(ms(10));
            let (mut now, mut issued, mut last) = (ms(0), ms(0), None);
            for (passed, renewed) in steps {
                now += ms(passed);
                if renewed {
                    issued = now;
                }
                if let Some(Streamed::Setpoint(setpoint, _)) = streamer.poll(now, &guide(issued)) {
                    prop_assert_eq!(setpoint.time, now);
                    prop_assert!(last.is_none_or(|last| last < now));
                    prop_assert!(now - issued <= SILENT_AFTER);
                    last = Some(now);
                }
            }
        }
    }
}
