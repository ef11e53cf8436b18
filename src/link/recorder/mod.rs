//! The recording of a link: every frame received and sent, byte for byte, with its stamp.
//!
//! A recorder never makes a link wait. Frames go to a thread of its own, which writes them to the file and
//! syncs it each second and whenever a vehicle arms, disarms or changes its mode: killed at any moment, the
//! program loses no more than the last second. What the disk does not take in time waits in memory, up to a
//! bound; beyond it frames are dropped, counted, and the link's reader is told.

mod backlog;
mod error;
mod recording;
mod state;
mod status;
mod store;
mod watch;
mod worker;

pub use error::RecordError;
pub use recording::Recorder;
pub use status::RecorderStatus;
pub use store::Store;
