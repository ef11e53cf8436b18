//! PING: PX4 sends it, and answers it.
#![expect(deprecated, reason = "the definitions prefer TIMESYNC; PX4 still speaks it")]

use mavlink::dialects::ardupilotmega::PING_DATA;

use super::message::Message;

/// A PING with its time in microseconds. `to` is zero where it asks, and else system and component of who asked.
pub(super) fn ping(time_usec: u64, seq: u32, (target_system, target_component): (u8, u8)) -> Message {
    Message::from(PING_DATA { time_usec, seq, target_system, target_component })
}
