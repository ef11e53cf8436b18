//! What state the vehicle is in.

use super::row::{Moment, Row, Way};
use super::turns::{Turn, armed, landed, mode};
use crate::recording::Quantity;

const STATUS: &[&str] = &["vehicle_status"];

pub(super) const ROWS: &[Row] = &[
    Row {
        topics: STATUS,
        quantity: Quantity::Armed,
        ways: &[Way { fields: &["arming_state"], turn: Turn::By(armed) }],
        when: &[],
        moment: Moment::Published,
    },
    Row {
        topics: STATUS,
        quantity: Quantity::Mode,
        ways: &[Way { fields: &["nav_state"], turn: Turn::By(mode) }],
        when: &[],
        moment: Moment::Published,
    },
    Row {
        topics: &["vehicle_land_detected"],
        quantity: Quantity::LandedState,
        ways: &[Way { fields: &["landed"], turn: Turn::By(landed) }],
        when: &[],
        moment: Moment::Published,
    },
];
