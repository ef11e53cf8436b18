//! A frame on its way from the vehicle.

use std::time::Duration;

use super::LinkId;

/// A frame that the vehicle sends.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Outgoing {
    /// on which connection
    pub link: LinkId,
    /// when it arrives, since the vehicle was made
    pub time: Duration,
    /// one MAVLink 2 frame
    pub bytes: Vec<u8>,
}
