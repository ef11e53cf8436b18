//! Requests of the file transfer and the numbers by which their answers are known.

use std::time::Duration;

use mavlink::dialects::ardupilotmega::MavMessage;

use super::FetchError;
use super::asked::Asked;
use super::pace::Pace;
use super::peer::Peer;
use crate::wire::Frame;
use crate::wire::file_transfer::{DATA_BYTES, Transfer, operation, refusal};

/// What the vehicle answered.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Answer {
    /// what was asked for
    Data(Vec<u8>),
    /// why not
    Refused(u8),
}

impl Answer {
    pub(super) fn of(transfer: &Transfer<'_>) -> Self {
        match transfer.operation {
            operation::ACK => Self::Data(transfer.whole_data()),
            _ => Self::Refused(transfer.whole_data().first().copied().unwrap_or(refusal::FAIL)),
        }
    }
}

/// A vehicle's file transfer.
#[derive(Debug)]
pub(super) struct Ftp {
    pub(super) peer: Peer,
    pub(super) pace: Pace,
    /// of the next request; `None` before the first
    sequence: Option<u16>,
}

impl Ftp {
    pub(super) fn new(peer: Peer) -> Self {
        Self { peer, pace: Pace::default(), sequence: None }
    }

    /// The number of a new request. The first is none that an earlier program is likely to have begun with: a vehicle that
    /// gets the number of its last answer repeats that.
    pub(super) fn number(&mut self, now: Duration) -> u16 {
        let sequence = self.sequence.unwrap_or_else(|| u16::try_from(now.as_micros() & 0x7FFF).unwrap_or(0));
        self.sequence = Some(sequence.wrapping_add(1));
        sequence
    }

    /// An answer moved the vehicle's numbers on: further requests come after it.
    pub(super) fn heard(&mut self, sequence: u16) {
        let next = self.sequence.unwrap_or(sequence);
        // newer by less than half of all numbers
        if sequence.wrapping_sub(next) < 0x8000 {
            self.sequence = Some(sequence.wrapping_add(1));
        }
    }
}

/// One question that has one answer, asked until it comes.
#[derive(Debug)]
pub(super) struct Question {
    operation: u8,
    session: u8,
    offset: u32,
    data: Vec<u8>,
    asked: Asked,
    sequence: Option<u16>,
    answer: Option<Answer>,
}

impl Question {
    /// With a path, or without data.
    pub(super) fn new(operation: u8, offset: u32, path: &str) -> Self {
        let data = path.bytes().take(DATA_BYTES).collect();
        Self { operation, session: 0, offset, data, asked: Asked::default(), sequence: None, answer: None }
    }

    pub(super) fn within(self, session: u8) -> Self {
        Self { session, ..self }
    }

    /// The request, where it is due; `patience` in place of what the link has shown.
    pub(super) fn poll(
        &mut self,
        now: Duration,
        ftp: &mut Ftp,
        (expected, most, patience): (&str, u32, Option<Duration>),
    ) -> Result<Option<MavMessage>, FetchError> {
        let due = match patience {
            Some(patience) => self.asked.is_due_after(now, patience),
            None => self.asked.is_due(now, &ftp.pace),
        };
        if self.answer.is_some() || !due {
            return Ok(None);
        }
        self.asked.send_at_most(most, now, expected)?;
        // the same number again: a vehicle that has answered it repeats the answer
        let sequence = *self.sequence.get_or_insert_with(|| ftp.number(now));
        let size = u8::try_from(self.data.len()).unwrap_or(u8::MAX);
        let request = Transfer {
            session: self.session,
            offset: self.offset,
            size,
            data: &self.data,
            ..Transfer::request(sequence, self.operation)
        };
        Ok(Some(ftp.peer.transfer(&request)))
    }

    /// Takes a frame; whether it was the answer.
    pub(super) fn take(&mut self, now: Duration, ftp: &mut Ftp, frame: &Frame<'_>) -> bool {
        let Some(transfer) = ftp.peer.heard_transfer(frame) else { return false };
        let expected = self.sequence.map(|sequence| sequence.wrapping_add(1));
        let is = transfer.answers == self.operation && Some(transfer.sequence) == expected;
        if !is || self.answer.is_some() {
            return false;
        }
        self.asked.answered(now, &mut ftp.pace);
        ftp.heard(transfer.sequence);
        if self.operation == operation::OPEN {
            self.session = transfer.session;
        }
        self.answer = Some(Answer::of(&transfer));
        true
    }

    /// The answer, once it is there.
    pub(super) fn answer(&mut self) -> Option<Answer> {
        self.answer.take()
    }

    /// The session that the vehicle opened.
    pub(super) fn session(&self) -> u8 {
        self.session
    }
}
