//! Requests to a vehicle before the flight.

use crate::autopilot::{Autopilot, Stack};
use crate::fly::target::{MessageId, Order, Period};
use mavlink::dialects::ardupilotmega as dialect;

/// The message with what the autopilot is.
pub(super) const AUTOPILOT_VERSION: MessageId = MessageId::of::<dialect::AUTOPILOT_VERSION_DATA>();
/// One in five datagrams lost: the version stays away once in three thousand flights.
const VERSION_CHANCES: u32 = 4;

/// Messages that the safety rules need of every autopilot, with their rates, Hz.
const STREAMS: [(MessageId, u16); 7] = [
    (MessageId::of::<dialect::LOCAL_POSITION_NED_DATA>(), 30),
    (MessageId::of::<dialect::ATTITUDE_QUATERNION_DATA>(), 50),
    (MessageId::of::<dialect::SYS_STATUS_DATA>(), 2),
    (MessageId::of::<dialect::EXTENDED_SYS_STATE_DATA>(), 5),
    (MessageId::of::<dialect::BATTERY_STATUS_DATA>(), 1),
    (MessageId::of::<dialect::CURRENT_MODE_DATA>(), 10),
    (MessageId::of::<dialect::POSITION_TARGET_LOCAL_NED_DATA>(), 27),
];
/// And of PX4: its estimator's report, and its pose with the counter of resets.
const PX4_STREAMS: [(MessageId, u16); 2] =
    [(MessageId::of::<dialect::ESTIMATOR_STATUS_DATA>(), 2), (MessageId::of::<dialect::ODOMETRY_DATA>(), 30)];
/// ArduPilot has no CURRENT_MODE: its HEARTBEAT tells of a pilot who takes over.
const ARDUPILOT_STREAMS: [(MessageId, u16); 2] = [
    (MessageId::of::<dialect::EKF_STATUS_REPORT_DATA>(), 2),
    (MessageId::of::<dialect::HEARTBEAT_DATA>(), 5),
];

/// Requests before the flight.
#[derive(Debug)]
pub(super) struct Checking {
    /// orders to be sent, the last first
    pub(super) orders: Vec<Order>,
    /// whether it is the vehicle that this program started; `None` until it has reported what it is
    pub(super) own: Option<bool>,
    pub(super) all_asked: bool,
    /// number of remaining requests for the version
    pub(super) version_chances: u32,
}

impl Checking {
    pub(super) fn new(stack: &'static Stack) -> Self {
        let own: &[(MessageId, u16)] = match stack.autopilot {
            Autopilot::Px4 => &PX4_STREAMS,
            Autopilot::ArduPilot => &ARDUPILOT_STREAMS,
            Autopilot::Other | Autopilot::Unknown => &[],
        };
        // taken from the end: the version first
        let mut orders: Vec<Order> =
            own.iter().chain(&STREAMS).map(|(id, rate_hz)| interval(*id, *rate_hz)).collect();
        orders.push(Order::request_message(AUTOPILOT_VERSION));
        Self { orders, own: None, all_asked: false, version_chances: VERSION_CHANCES }
    }

    pub(super) fn has_asked(&self) -> bool {
        self.all_asked
    }
}

pub(super) fn interval(id: MessageId, rate_hz: u16) -> Order {
    Order::interval(id, Period::of_whole_rate(rate_hz))
}
