//! How a link is to be.

use std::time::Duration;

use super::clock::HostClock;
use super::halt::Halt;
use super::recorder::Recorder;
use super::signing::Signing;
use crate::wire::{ComponentId, SystemId};

/// How a link is to be.
#[derive(Debug, Clone)]
pub struct LinkOptions {
    /// system id of the messages sent (default 255, a ground station)
    pub system: SystemId,
    /// component id of the messages sent (default 190, a ground station's)
    pub component: ComponentId,
    /// where the stamps come from: share one clock among the links of a process
    pub clock: HostClock,
    /// a `udpin` link forgets its peer after this silence and answers the next that sends a heartbeat; until then it goes
    /// on sending to it. Longer than the 5 s for which a flight streams setpoints into a silence: where the downlink
    /// alone is lost, the vehicle still hears them
    pub peer_timeout: Duration,
    /// a `tcpout` link that is refused is open all the same, and continues trying: whichever end is started first,
    /// the other is waited for
    pub patient: bool,
    /// signs what is sent, and believes only what is signed; without it signed frames pass unchecked
    pub signing: Option<Signing>,
    /// records every frame received and sent
    pub recorder: Option<Recorder>,
    /// for tests: where the link's task is stopped
    pub halt: Halt,
}

impl Default for LinkOptions {
    fn default() -> Self {
        Self {
            system: SystemId(255),
            component: ComponentId(190),
            clock: HostClock::start(),
            peer_timeout: Duration::from_secs(8),
            patient: false,
            signing: None,
            recorder: None,
            halt: Halt::default(),
        }
    }
}
