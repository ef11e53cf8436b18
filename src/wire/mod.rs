//! MAVLink: bytes to frames, frames to samples, and back.
//!
//! ```text
//! bytes -> Splitter -> Frame -> Decoder -> recording::Event
//! messages -> MessageWriter -> frames with the host's stamps
//! ```

mod checksum;
mod clock;
pub mod command;
mod decode;
mod embedded;
mod encode;
pub mod file_transfer;
mod frame;
pub mod heartbeat;
pub mod mav_frame;
pub mod message_id;
mod sender;
mod splitter;
mod stamped;

pub use self::checksum::{CrcSeeds, checksum};
pub use clock::{Anchor, BACKWARD_US, HOST_LEAP_US, HOST_STEP_US, Stamp, WITNESSES};
pub use decode::{DecodeReport, Decoder, STATUSTEXT_BYTES, Source, Vehicle};
pub use embedded::{EMBEDDED_UID2, Nonce, UID2_BYTES};
pub use encode::write_recording;
pub use frame::{
    Check, ComponentId, Frame, Header, MARKER_V1, MARKER_V2, MAX_FRAME_BYTES, Payload, Start, SystemId,
    Version,
};
pub use sender::{MessageCounts, Sender};
pub use splitter::{SplitCounts, Splitter};
pub use stamped::{ByteOrder, MessageWriter, Record, STAMP_BYTES, TlogWriter, is_wall_clock};
