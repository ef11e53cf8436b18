//! PX4's own logs (ULog, `.ulg`).
//!
//! The reader is our own: `px4-ulog` 0.6 ends at the first damage without a word, and neither says where a message stood
//! nor what was lost.

mod clock;
mod craft;
mod decode;
mod format;
mod message;
mod reader;
mod report;
mod resets;
mod schema;
mod topics;
mod whole;

pub(super) use format::FORMAT;
pub use message::Message;
pub use reader::{Entry, UlogReader};
pub use report::{TopicCount, UlogReport};
pub use schema::{Cell, Layout, NumberType, Subscription};
