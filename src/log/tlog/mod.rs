//! Telemetry logs (`.tlog`): before each MAVLink frame the 8 bytes of its host stamp, microseconds since
//! 1970 UTC, big-endian. No header, no index, no footer.

mod encode;
mod messages;
mod reader;
mod record;
mod stamp;
mod writer;

pub use encode::write_recording;
pub use messages::MessageWriter;
pub use reader::TlogReader;
pub use record::Record;
pub(super) use stamp::is_wall_clock;
pub use stamp::{ByteOrder, STAMP_BYTES};
pub use writer::TlogWriter;
