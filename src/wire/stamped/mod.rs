//! MAVLink frames with the host's stamps: what a link records and what a telemetry log (`.tlog`) holds. Before each
//! frame stand the 8 bytes of its stamp, microseconds since 1970 UTC, big-endian. No header, no index, no footer.

mod messages;
mod record;
mod stamp;
mod writer;

pub use messages::MessageWriter;
pub use record::Record;
pub use stamp::{ByteOrder, STAMP_BYTES, is_wall_clock};
pub use writer::TlogWriter;
