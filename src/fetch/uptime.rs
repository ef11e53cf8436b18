//! How long a vehicle has been running.

use std::time::Duration;

use mavlink::dialects::ardupilotmega::MavMessage;

use super::asked::Asked;
use super::pace::Pace;
use super::peer::Peer;
use super::{Dialogue, FetchError};
use crate::wire::message_id::{ATTITUDE, LOCAL_POSITION_NED, SYSTEM_TIME};
use crate::wire::{Frame, Vehicle};

/// Messages with the time since the start in ms, and where in them it is.
const SAYS: [(u32, usize); 3] = [(SYSTEM_TIME, 8), (ATTITUDE, 0), (LOCAL_POSITION_NED, 0)];
/// Tries; a vehicle need not say it.
const TRIES: u32 = 6;

/// Asks a vehicle for how long it has been running.
#[derive(Debug)]
pub struct Uptime {
    vehicle: Vehicle,
    asked: Asked,
    pace: Pace,
    /// what it said; nothing where it did not
    said: Option<Option<f64>>,
}

impl Uptime {
    /// Of this vehicle.
    #[must_use]
    pub fn new(vehicle: Vehicle) -> Self {
        Self { vehicle, asked: Asked::default(), pace: Pace::default(), said: None }
    }

    /// s since its start; `None` where it does not say.
    #[must_use]
    pub fn up_s(&self) -> Option<f64> {
        self.said.flatten()
    }
}

impl Dialogue for Uptime {
    fn poll(&mut self, now: Duration) -> Result<Option<MavMessage>, FetchError> {
        if self.said.is_some() || !self.asked.is_due(now, &self.pace) {
            return Ok(None);
        }
        if self.asked.send_at_most(TRIES, now, "").is_err() {
            self.said = Some(None);
            return Ok(None);
        }
        Ok(Some(Peer::of(self.vehicle)?.request_system_time()))
    }

    fn take(&mut self, _now: Duration, frame: &Frame<'_>) {
        let header = frame.header();
        let is_own = header.system == self.vehicle.system && header.component == self.vehicle.component;
        let says = SAYS.iter().find(|(id, _)| is_own && *id == header.message_id);
        if let (Some((_, offset)), None) = (says, self.said) {
            let up = Duration::from_millis(frame.payload().u32(*offset).into());
            self.said = Some((!up.is_zero()).then_some(up.as_secs_f64()));
        }
    }

    fn is_done(&self) -> bool {
        self.said.is_some()
    }
}
