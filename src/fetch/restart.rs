//! The order to an autopilot to start anew.

use std::time::Duration;

use mavlink::dialects::ardupilotmega::MavMessage;

use super::asked::Asked;
use super::pace::Pace;
use super::peer::Peer;
use super::{Dialogue, FetchError};
use crate::wire::command::ACCEPTED;
use crate::wire::{Frame, Vehicle};

/// Tries; one that starts anew at once may not answer.
const TRIES: u32 = 4;

/// Orders an autopilot to start anew. The autopilots obey only while they are disarmed.
#[derive(Debug)]
pub struct Restart {
    peer: Peer,
    asked: Asked,
    pace: Pace,
    /// MAV_RESULT
    answer: Option<u8>,
    is_over: bool,
}

impl Restart {
    /// Of this vehicle.
    ///
    /// # Errors
    /// No message can name the vehicle.
    pub fn new(vehicle: Vehicle) -> Result<Self, FetchError> {
        let peer = Peer::of(vehicle)?;
        Ok(Self { peer, asked: Asked::default(), pace: Pace::default(), answer: None, is_over: false })
    }

    /// Whether it obeys; one that did not answer may have started anew before it could.
    ///
    /// # Errors
    /// It refused.
    pub fn obeyed(&self) -> Result<(), FetchError> {
        match self.answer {
            None | Some(ACCEPTED) => Ok(()),
            Some(result) => Err(FetchError::Refused {
                asked: "a restart of the autopilot".to_owned(),
                why: format!("MAV_RESULT {result}"),
            }),
        }
    }
}

impl Dialogue for Restart {
    fn poll(&mut self, now: Duration) -> Result<Option<MavMessage>, FetchError> {
        if self.is_done() || !self.asked.is_due(now, &self.pace) {
            return Ok(None);
        }
        if self.asked.send_at_most(TRIES, now, "").is_err() {
            self.is_over = true;
            return Ok(None);
        }
        Ok(Some(self.peer.restart()))
    }

    fn take(&mut self, now: Duration, frame: &Frame<'_>) {
        if let Some(result) = self.peer.heard_restart(frame) {
            self.asked.answered(now, &mut self.pace);
            self.answer = Some(result);
        }
    }

    fn is_done(&self) -> bool {
        self.is_over || self.answer.is_some()
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test ends where it fails")]
    use super::*;
    use crate::autopilot::Autopilot;
    use crate::wire::command::FAILED;
    use crate::wire::{ComponentId, SystemId};

    #[test]
    fn a_refusal_is_told_and_silence_is_none() {
        let (system, component, autopilot) = (SystemId(1), ComponentId(1), Autopilot::Px4);
        let vehicle = Vehicle { system, component, autopilot, kind: None };
        let mut restart = Restart::new(vehicle).unwrap();
        let sent = (0..60).filter(|second| restart.poll(Duration::from_secs(*second)).unwrap().is_some());
        assert_eq!(sent.count(), 4);
        assert!(
            restart.is_done() && restart.obeyed().is_ok(),
            "it may have started anew before it could answer"
        );
        restart.answer = Some(FAILED);
        let said = restart.obeyed().unwrap_err().to_string();
        assert!(said.contains("a restart of the autopilot") && said.contains("MAV_RESULT 4"), "{said}");
    }
}
