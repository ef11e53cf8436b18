//! Requests to a vehicle before the flight.

use crate::autopilot::{Autopilot, Stack};
use crate::fly::target::{Order, Period};

pub(super) const AUTOPILOT_VERSION: u16 = 148;
/// One in five datagrams lost: the version stays away once in three thousand flights.
const VERSION_CHANCES: u32 = 4;

/// Messages that the safety rules need, with their rates, Hz: LOCAL_POSITION_NED, ATTITUDE_QUATERNION, SYS_STATUS,
/// EXTENDED_SYS_STATE, BATTERY_STATUS, CURRENT_MODE, POSITION_TARGET_LOCAL_NED, and the estimator's own report.
const STREAMS: [(u16, u16); 7] = [(32, 30), (31, 50), (1, 2), (245, 5), (147, 1), (436, 10), (85, 27)];
const PX4_STREAMS: [(u16, u16); 2] = [(230, 2), (331, 30)];
/// ArduPilot has no CURRENT_MODE: its HEARTBEAT tells of a pilot who takes over.
const ARDUPILOT_STREAMS: [(u16, u16); 2] = [(193, 2), (0, 5)];

/// Requests before the flight.
#[derive(Debug)]
pub(super) struct Checking {
    pub(super) wanted: Vec<Order>,
    /// whether it is the vehicle that this program started; `None` until it has reported what it is
    pub(super) own: Option<bool>,
    pub(super) all_asked: bool,
    /// number of remaining requests for the version
    pub(super) version_chances: u32,
}

impl Checking {
    pub(super) fn new(stack: &'static Stack) -> Self {
        let own: &[(u16, u16)] = match stack.autopilot {
            Autopilot::Px4 => &PX4_STREAMS,
            Autopilot::ArduPilot => &ARDUPILOT_STREAMS,
            Autopilot::Other | Autopilot::Unknown => &[],
        };
        // taken from the end: the version first
        let mut wanted: Vec<Order> =
            own.iter().chain(&STREAMS).map(|(id, rate_hz)| interval(*id, *rate_hz)).collect();
        wanted.push(Order::request_message(AUTOPILOT_VERSION));
        Self { wanted, own: None, all_asked: false, version_chances: VERSION_CHANCES }
    }

    pub(super) fn has_asked(&self) -> bool {
        self.all_asked
    }
}

pub(super) fn interval(id: u16, rate_hz: u16) -> Order {
    Order::interval(id, Period::of_whole_rate(rate_hz))
}
