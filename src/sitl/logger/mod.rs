//! The log that the vehicle writes of its own flight, in memory: PX4's `.ulg` or ArduPilot's `.bin`.

mod bytes;
mod dataflash;
mod dataflash_forms;
mod date;
mod frames;
mod keeper;
mod moment;
mod schedule;
mod store;
mod ulog;
mod ulog_topics;

pub(super) use keeper::{Keeper, Now};
pub(super) use store::{LogFile, LogStore};
