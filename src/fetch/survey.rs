//! What a vehicle offers, and by which number it is known.

use std::time::Duration;

use mavlink::dialects::ardupilotmega::{MavMessage, MavProtocolCapability};

use super::asked::Asked;
use super::pace::Pace;
use super::peer::Peer;
use super::remote::Protocol;
use super::{Dialogue, FetchError};
use crate::wire::message_id::AUTOPILOT_VERSION;
use crate::wire::{Frame, UID2_BYTES, Vehicle};

/// Where the numbers of the processor begin in AUTOPILOT_VERSION.
const UID_AT: usize = 8;
const UID2_AT: usize = 60;
/// Tries; a vehicle that does not answer is asked all the same for its logs.
const TRIES: u32 = 8;

/// What a vehicle offers.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Offer {
    /// it has MAVLink's file transfer; `None` where it does not say
    pub ftp: Option<bool>,
    /// the number of its processor, hexadecimal; `None` where it does not say
    pub uid: Option<String>,
}

impl Offer {
    /// The better protocol of those that it has.
    #[must_use]
    pub fn protocol(&self) -> Protocol {
        if self.ftp == Some(false) { Protocol::Log } else { Protocol::Ftp }
    }
}

/// Asks a vehicle what it offers.
#[derive(Debug)]
pub struct Survey {
    vehicle: Vehicle,
    asked: Asked,
    pace: Pace,
    offer: Option<Offer>,
}

impl Survey {
    /// Of this vehicle.
    #[must_use]
    pub fn new(vehicle: Vehicle) -> Self {
        Self { vehicle, asked: Asked::default(), pace: Pace::default(), offer: None }
    }

    /// What it offers, as far as it said.
    #[must_use]
    pub fn offer(self) -> Offer {
        self.offer.unwrap_or_default()
    }
}

impl Dialogue for Survey {
    fn poll(&mut self, now: Duration) -> Result<Option<MavMessage>, FetchError> {
        if self.offer.is_some() || !self.asked.is_due(now, &self.pace) {
            return Ok(None);
        }
        if self.asked.send_at_most(TRIES, now, "").is_err() {
            self.offer = Some(Offer::default());
            return Ok(None);
        }
        // autopilots of before 2018 know the older command alone
        let is_old = self.asked.tries().is_multiple_of(3);
        let peer = Peer::of(self.vehicle)?;
        Ok(Some(if is_old { peer.request_capabilities() } else { peer.request_version() }))
    }

    fn take(&mut self, now: Duration, frame: &Frame<'_>) {
        let header = frame.header();
        let is = header.system == self.vehicle.system
            && header.component == self.vehicle.component
            && header.message_id == AUTOPILOT_VERSION;
        if !is || self.offer.is_some() {
            return;
        }
        self.asked.answered(now, &mut self.pace);
        let payload = frame.payload();
        let capabilities = MavProtocolCapability::from_bits_truncate(payload.u64(0));
        let long: Vec<u8> = (0..UID2_BYTES).map(|at| payload.u8(UID2_AT + at)).collect();
        let short: Vec<u8> = (0..8).map(|at| payload.u8(UID_AT + at)).collect();
        let uid = [long, short].into_iter().find(|uid| uid.iter().any(|byte| *byte != 0));
        self.offer = Some(Offer {
            ftp: Some(capabilities.contains(MavProtocolCapability::MAV_PROTOCOL_CAPABILITY_FTP)),
            uid: uid.map(|uid| uid.iter().map(|byte| format!("{byte:02x}")).collect()),
        });
    }

    fn is_done(&self) -> bool {
        self.offer.is_some()
    }
}
