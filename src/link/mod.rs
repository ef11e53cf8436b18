//! MAVLink over sockets and serial ports: whole frames in, whole frames out, with reconnection, statistics
//! and a recording.
//!
//! ```text
//! bytes -> stamp -> Splitter -> recording -> statistics -> LinkReader
//! LinkWriter -> queue or latest-wins slot -> sequence -> bytes -> recording
//! ```
//!
//! [`Link::open`] starts one task for a link and gives its two halves. It connects again by itself; the
//! reader hears of it as [`LinkEvent`]s, and while there is nobody to talk to the writer refuses, so that no
//! old command goes out to a vehicle that comes back.

mod address;
mod carried;
mod clock;
mod error;
mod event;
mod feed;
mod given;
mod halt;
mod incoming;
mod open;
mod options;
mod outgoing;
mod pen;
mod reader;
mod received;
mod recorder;
mod shared;
mod signing;
mod stats;
mod transport;
mod writer;

pub use address::{Address, AddressError};
pub use carried::Carrier;
pub use clock::{HostClock, HostStamp};
pub use error::LinkError;
pub use event::LinkEvent;
pub use feed::LinkFeed;
pub use halt::{Halt, Stop, panic_for_test};
pub use open::{Ends, Link};
pub use options::LinkOptions;
pub use reader::LinkReader;
pub use received::{Received, ReceivedFrame};
pub use recorder::{RecordError, Recorder, RecorderStatus, Store};
pub use signing::{Distrust, Signing, SigningError, SigningKey};
pub(crate) use signing::{TAIL_BYTES, time_of};
pub use stats::LinkStats;
pub use writer::LinkWriter;
