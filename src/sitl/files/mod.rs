//! The vehicle's files over MAVLink: its logs, by file transfer and by the older log messages. Nothing can be changed.

mod folder;
mod log_messages;
mod transfer;

pub(super) use log_messages::{LogSender, Sent};
pub(super) use transfer::{Answer, FileServer};
