//! Why a link cannot be used.

use std::io;

/// Why a link cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum LinkError {
    /// it could not be opened
    #[error("cannot open {address}: {source}{}", in_use(source))]
    Open {
        /// which one
        address: String,
        /// what the system said
        source: io::Error,
    },
    /// the machine has no such links
    #[error("cannot open {address}: {kind} links are not available on this system")]
    Unavailable {
        /// which one
        address: String,
        /// what kind
        kind: &'static str,
    },
    /// nobody is at the other end now; what was given was not sent and will not be
    #[error("not sent: no peer at the other end of {address}")]
    NotConnected {
        /// which link
        address: String,
    },
    /// the other end takes less than it is sent; what was given was not sent
    #[error("not sent: {queued} frames are already waiting on {address}")]
    QueueFull {
        /// which link
        address: String,
        /// frames that wait
        queued: usize,
    },
    /// what was given is not one whole frame
    #[error("expected one complete MAVLink frame, got {bytes} bytes that are not one")]
    NotAFrame {
        /// how many bytes were given
        bytes: usize,
    },
    /// the link has ended: its task is gone, or the replay is over
    #[error("the link has ended")]
    Closed,
}

/// What to do where another program has a local port.
fn in_use(source: &io::Error) -> &'static str {
    match source.kind() {
        io::ErrorKind::AddrInUse => {
            ". Another program has this port, perhaps another ground station: close it, or let the vehicle send to another port"
        }
        _ => "",
    }
}
