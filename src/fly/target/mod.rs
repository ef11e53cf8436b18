//! Whom messages are for, and the messages themselves.
//!
//! Every message that this ground station sends to a vehicle is made here or by [`super::Setpoint`], from types whose
//! values are in the range that MAVLink's definitions give their fields. What cannot be in range is an
//! [`OutOfRange`] before there is a message.

mod message;
mod order;
mod range;
mod vehicle;

pub use message::{heartbeat, timesync};
pub use order::Order;
pub use range::{MessageId, OutOfRange, ParameterName, Period, TakeoffHeight, within};
pub use vehicle::Target;
