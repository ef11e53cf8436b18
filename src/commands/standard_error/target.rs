//! The target of messages.

/// Target of the events that are messages for people.
pub const MESSAGE: &str = "mavid::message";
