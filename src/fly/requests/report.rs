//! Assessment of the rates that arrive.

use super::capacity::bytes_s;
use super::{Answer, Capacity, Need, StreamRequest, granted_hz};
use crate::autopilot::Autopilot;
use crate::fly::finding::Finding;
use crate::signals::{LEAST_ACTUATOR_HZ, LEAST_BODY_RATE_HZ};

/// Share of the requested rate below which a stream is slower than requested. Autopilots round periods to their loop;
/// only a word depends on it.
const SHORT_SHARE: f64 = 0.8;

/// One message.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StreamReport {
    /// the request, with the rate that was requested last
    pub request: StreamRequest,
    /// the vehicle's answer
    pub answer: Answer,
    /// Hz over the window; NaN before there was one
    pub arrived_hz: f64,
    /// it is of actuators, and all its values are zero
    pub blank: bool,
}

impl StreamReport {
    /// Whether it arrives at about the rate that the autopilot gives for the request.
    #[must_use]
    pub fn is_as_asked(&self, autopilot: Autopilot) -> bool {
        granted_hz(autopilot, self.request.rate_hz)
            .is_some_and(|granted| self.arrived_hz >= SHORT_SHARE * granted)
    }

    /// One line: asked for, answered, arrived.
    #[must_use]
    pub fn line(&self) -> String {
        let StreamRequest { name, rate_hz, .. } = self.request;
        let said = match self.answer {
            Answer::NotAsked => "not asked for".to_owned(),
            Answer::Accepted => "accepted".to_owned(),
            Answer::Refused(result) => format!("refused (MAV_RESULT {result})"),
            Answer::Silent => "no answer".to_owned(),
            Answer::OutOfRange => "no message can ask for it".to_owned(),
        };
        format!("{name}: asked {rate_hz:.1} Hz, {said}, {:.1} Hz arrive", self.arrived_hz)
    }
}

/// One need and the best message for it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NeedReport {
    /// which
    pub need: Need,
    /// its fastest message
    pub best: Option<StreamReport>,
    /// Hz below which it is not satisfied
    pub least_hz: f64,
    /// Hz from which it is well satisfied
    pub good_hz: f64,
    /// whether the flight needs it
    pub to_fly: bool,
}

/// Requests, rates that arrive, and whether they are sufficient.
#[derive(Debug, Clone, PartialEq)]
pub struct RatesReport {
    /// one a message of the set
    pub streams: Vec<StreamReport>,
    /// one a need
    pub needs: Vec<NeedReport>,
    /// bytes a second that the set was expected to take
    pub expected_bytes_s: f64,
    /// bytes a second of all that arrived
    pub arrived_bytes_s: f64,
    /// of the link
    pub capacity: Capacity,
    autopilot: Autopilot,
}

/// Least and good rates (Hz) of a need, and whether flying needs it.
fn thresholds(need: Need) -> (f64, f64, bool) {
    match need {
        Need::BodyRates => (LEAST_BODY_RATE_HZ, 90.0, false),
        Need::Actuators => (LEAST_ACTUATOR_HZ, 90.0, false),
        Need::Attitude => (5.0, 45.0, true),
        Need::Position => (5.0, 25.0, true),
        Need::Acceleration => (20.0, 90.0, false),
        Need::Setpoints => (5.0, 15.0, false),
        Need::Battery => (0.2, 0.4, true),
        Need::State => (0.4, 1.5, true),
        Need::Estimator => (0.5, 0.9, false),
    }
}

/// Subject of the check of the needs of identification.
const IDENTIFICATION: &str = "identification";
/// Needs of identification.
const TO_IDENTIFY: [Need; 4] = [Need::BodyRates, Need::Attitude, Need::Position, Need::Actuators];

impl RatesReport {
    pub(super) fn new(
        streams: Vec<StreamReport>,
        autopilot: Autopilot,
        capacity: Capacity,
        arrived_bytes_s: f64,
    ) -> Self {
        let needs = Need::ALL.map(|need| {
            let serving = streams.iter().filter(|s| s.request.needs.contains(&need) && s.arrived_hz > 0.0);
            // nothing but zeros is the best only where there is nothing else
            let rank = |s: &StreamReport| if s.blank { 0.0 } else { s.arrived_hz };
            let best = serving.copied().max_by(|a, b| rank(a).total_cmp(&rank(b)));
            let (least_hz, good_hz, to_fly) = thresholds(need);
            NeedReport { need, best, least_hz, good_hz, to_fly }
        });
        let set: Vec<StreamRequest> = streams.iter().map(|stream| stream.request).collect();
        Self {
            needs: needs.to_vec(),
            expected_bytes_s: bytes_s(&set),
            streams,
            arrived_bytes_s,
            capacity,
            autopilot,
        }
    }

    /// Whether everything that identification needs arrives.
    #[must_use]
    pub fn suffices_to_identify(&self) -> bool {
        TO_IDENTIFY.iter().all(|need| self.serves(*need))
    }

    /// The finding on identification: a warning with the missing needs if something does not arrive.
    #[must_use]
    pub fn identification(&self) -> Finding {
        let short: Vec<&NeedReport> = self
            .needs
            .iter()
            .filter(|report| TO_IDENTIFY.contains(&report.need) && !report.is_served())
            .collect();
        let list = |line: fn(&NeedReport) -> String| {
            short.iter().map(|need| line(need)).collect::<Vec<_>>().join(", ")
        };
        if short.is_empty() {
            return Finding::ok(IDENTIFICATION, "streams to identify the vehicle from", "all of them");
        }
        Finding::warning(
            IDENTIFICATION,
            list(|need| format!("{} at {} Hz at least", need.need.name(), need.least_hz)),
            list(NeedReport::came),
            "little or nothing can be identified from this recording: connect by a faster link or raise the \
             autopilot's rates, or \
             identify from the on-board log",
        )
    }

    /// Whether the messages for this need arrive at the least rate or faster.
    #[must_use]
    pub fn serves(&self, need: Need) -> bool {
        self.needs.iter().any(|report| report.need == need && report.is_served())
    }

    /// The findings: a refusal if a need of the flight is not satisfied, a warning for one of the identification.
    #[must_use]
    pub fn findings(&self) -> Vec<Finding> {
        let needs = self.needs.iter().map(NeedReport::finding);
        let slow = self.streams.iter().filter(|s| s.answer == Answer::Accepted && s.arrived_hz > 0.0);
        let slow = slow.filter(|s| !s.request.on_change && !s.is_as_asked(self.autopilot)).map(|s| {
            Finding::warning(
                "message rate",
                format!("{} at {} Hz", s.request.name, s.request.rate_hz),
                format!("{:.1} Hz", s.arrived_hz),
                "the link or the autopilot holds it back: another ground station, a slow link, or a data rate limit",
            )
        });
        self.link().into_iter().chain(needs).chain(slow).collect()
    }

    fn link(&self) -> Option<Finding> {
        (self.expected_bytes_s > self.capacity.bytes_s).then(|| {
            Finding::warning(
                "link",
                format!("room for {:.1} kB/s", 1e-3 * self.expected_bytes_s),
                format!("{:.1} kB/s", 1e-3 * self.capacity.bytes_s),
                "fly over this link and identify from the on-board log, or connect by a faster one",
            )
        })
    }
}

impl NeedReport {
    /// Whether it arrives at the least rate or faster.
    #[must_use]
    pub fn is_served(&self) -> bool {
        self.best.is_some_and(|best| !best.blank && best.arrived_hz >= self.least_hz)
    }

    /// The best message that arrives for it, in words.
    fn came(&self) -> String {
        self.best.map_or_else(
            || format!("nothing for {}", self.need.name()),
            |best| {
                let zeros = if best.blank { ", nothing but zeros" } else { "" };
                format!("{} at {:.1} Hz{zeros}", best.request.name, best.arrived_hz)
            },
        )
    }

    fn finding(&self) -> Finding {
        let Self { need, least_hz, good_hz, to_fly, .. } = self;
        let came = self.came();
        let expected = format!("{} at {good_hz} Hz, {least_hz} Hz at least", need.name());
        if !self.is_served() && *to_fly {
            let remedy =
                "the flight cannot be watched without it: check the link and the autopilot's stream settings";
            return Finding::refusal("messages", expected, came, remedy);
        }
        if !self.is_served() && *need == Need::Setpoints {
            // an autopilot tells them where it follows some: in the mode that is not entered yet
            return Finding::ok("messages", expected, format!("{came} before our mode is entered"));
        }
        if !self.is_served() {
            let remedy = "identify from the on-board log, or raise what the link carries";
            return Finding::warning("messages", expected, came, remedy);
        }
        Finding::ok("messages", expected, came)
    }
}
