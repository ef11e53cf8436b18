//! A log by file transfer: bursts, the gaps that they left, the checksum.

use std::time::Duration;

use mavlink::dialects::ardupilotmega::MavMessage;

use super::asked::Asked;
use super::fetched::{Fetched, Sum};
use super::ftp::{Answer, Ftp, Question};
use super::peer::Peer;
use super::remote::MOST_BYTES;
use super::window::Window;
use super::{Dialogue, FetchError};
use crate::wire::Frame;
use crate::wire::file_transfer::{DATA_BYTES, Transfer, operation, refusal};

/// Reads that are under way at once.
const AT_ONCE: usize = 8;
/// Tries of one read: of a long log over a link that loses a fifth both ways, none fails.
const READ_TRIES: u32 = 24;
/// Tries of all else.
const TRIES: u32 = 12;
/// Bursts in a row that bring nothing, at most.
const BARREN: u32 = 10;
/// Times that a session which the vehicle has forgotten is opened again.
const REOPENED: u32 = 8;
/// A gap of so many bytes is filled by a burst, not by reads.
const BURST_BYTES: u64 = 64 * DATA_BYTES as u64;
/// Answers of a burst are no further from its request.
const BURST_NUMBERS: u16 = 0x4000;
/// Bytes of which a vehicle calculates the checksum in a second, at least.
const SUM_BYTES_A_SECOND: u64 = 1_000_000;
const SUM_TRIES: u32 = 4;

#[derive(Debug)]
enum Step {
    Open(Question),
    Reset(Question),
    Read,
    Sum(Question),
    Again(Question),
    Close(Question),
    Done,
}

#[derive(Debug)]
struct Burst {
    sequence: u16,
    began: Duration,
    heard: Option<Duration>,
    is_over: bool,
    brought: bool,
}

#[derive(Debug)]
struct Read {
    offset: u64,
    size: u64,
    sequence: u16,
    asked: Asked,
}

/// Reads one file.
#[derive(Debug)]
pub(super) struct FtpReading {
    ftp: Ftp,
    path: String,
    step: Step,
    session: u8,
    begin: u64,
    window: Option<Window>,
    burst: Option<Burst>,
    reads: Vec<Read>,
    barren: u32,
    /// the vehicle says that the file ends where there should be more
    ends_early: bool,
    reopened: u32,
    has_reset: bool,
    failure: Option<FetchError>,
    sum: Sum,
    grown_to: Option<u64>,
}

impl FtpReading {
    /// Of the file at `path` of which `begin` bytes are there already.
    pub(super) fn new(peer: Peer, path: &str, begin: u64) -> Self {
        Self {
            ftp: Ftp::new(peer),
            step: Step::Open(Question::new(operation::OPEN, 0, path)),
            path: path.to_owned(),
            session: 0,
            begin,
            window: None,
            burst: None,
            reads: Vec::new(),
            barren: 0,
            ends_early: false,
            reopened: 0,
            has_reset: false,
            failure: None,
            sum: Sum::NotOffered,
            grown_to: None,
        }
    }

    /// Of the file at `path` of which all `size` bytes are there: its checksum, and whether the vehicle wrote on.
    pub(super) fn sum_of(peer: Peer, path: &str, size: u64) -> Self {
        let step = Step::Sum(Question::new(operation::CRC, 0, path));
        Self { step, window: Some(Window::new(size, size)), ..Self::new(peer, path, size) }
    }

    pub(super) fn window(&mut self) -> Option<&mut Window> {
        self.window.as_mut()
    }

    pub(super) fn fetched(&self) -> Option<Fetched> {
        let size = self.window.as_ref().filter(|_| self.is_done())?.size();
        Some(Fetched { size, sum: self.sum, grown_to: self.grown_to })
    }

    /// Ends the session, whatever is under way.
    pub(super) fn farewell(&mut self, now: Duration) -> MavMessage {
        let sequence = self.ftp.number(now);
        let request = Transfer { session: self.session, ..Transfer::request(sequence, operation::TERMINATE) };
        self.ftp.peer.transfer(&request)
    }

    fn refused(&self, code: u8) -> FetchError {
        FetchError::Refused { asked: self.path.clone(), why: refusal::words(code).to_owned() }
    }

    /// The vehicle opened the file, or would not.
    fn opened(&mut self, answer: &Answer, session: u8) -> Result<(), FetchError> {
        let size = match answer {
            Answer::Data(data) => data.first_chunk().copied().map(u32::from_le_bytes),
            // sessions that nobody ended stay open: once all of them are ended
            Answer::Refused(refusal::NO_SESSIONS | refusal::FAIL) if !self.has_reset => {
                self.has_reset = true;
                self.step = Step::Reset(Question::new(operation::RESET, 0, ""));
                return Ok(());
            }
            Answer::Refused(code) => return Err(self.refused(*code)),
        };
        let Some(size) = size.map(u64::from) else { return Err(self.refused(refusal::FAIL)) };
        if size > MOST_BYTES {
            return Err(FetchError::TooLong { stated: size });
        }
        self.session = session;
        if self.window.is_none() {
            if self.begin > size {
                return Err(FetchError::Short { stated: self.begin, came: size });
            }
            self.window = Some(Window::new(self.begin, size));
        }
        self.step = Step::Read;
        Ok(())
    }

    /// The session is gone: it is opened again, and goes on where it was.
    fn reopen(&mut self) {
        self.reopened += 1;
        (self.burst, self.reads) = (None, Vec::new());
        if self.reopened > REOPENED {
            self.failure = Some(self.refused(refusal::INVALID_SESSION));
        }
        self.step = Step::Open(Question::new(operation::OPEN, 0, &self.path));
    }

    fn read(&mut self, now: Duration) -> Result<Option<MavMessage>, FetchError> {
        let Some(window) = &self.window else { return Ok(None) };
        if window.is_whole() {
            self.step = Step::Sum(Question::new(operation::CRC, 0, &self.path));
            return self.poll(now);
        }
        if let Some(burst) = &self.burst {
            let since = now.saturating_sub(burst.heard.unwrap_or(burst.began));
            if !burst.is_over && since < self.ftp.pace.silence(self.barren) {
                return Ok(None);
            }
            self.barren = if burst.brought { 0 } else { self.barren + 1 };
            self.burst = None;
            if self.barren >= BARREN {
                let expected = format!("{} from byte {} on", self.path, window.begin());
                return Err(FetchError::Silent { expected, tries: self.barren, seconds: since.as_secs() });
            }
        }
        let mut gaps = window.gaps();
        let (begin, end, size) = (window.begin(), window.end(), window.size());
        self.reads.retain(|read| read.offset + read.size > begin);
        let is_wide = gaps.first().is_some_and(|(from, to)| to - from >= BURST_BYTES);
        if gaps.is_empty() && self.ends_early {
            gaps.push((begin, size.min(begin + DATA_BYTES as u64)));
        }
        if self.reads.is_empty() && (gaps.is_empty() || is_wide && !self.ends_early) {
            return Ok(Some(self.begin_burst(now, if is_wide { begin } else { end })));
        }
        self.fill(now, &gaps)
    }

    fn begin_burst(&mut self, now: Duration, from: u64) -> MavMessage {
        let sequence = self.ftp.number(now);
        self.burst = Some(Burst { sequence, began: now, heard: None, is_over: false, brought: false });
        self.request(sequence, operation::BURST, from, DATA_BYTES as u64)
    }

    fn request(&self, sequence: u16, operation: u8, offset: u64, size: u64) -> MavMessage {
        let request = Transfer {
            session: self.session,
            offset: u32::try_from(offset).unwrap_or(u32::MAX),
            size: u8::try_from(size).unwrap_or(u8::MAX),
            ..Transfer::request(sequence, operation)
        };
        self.ftp.peer.transfer(&request)
    }

    /// Reads what is missing, some pieces at once.
    fn fill(&mut self, now: Duration, gaps: &[(u64, u64)]) -> Result<Option<MavMessage>, FetchError> {
        let pace = self.ftp.pace;
        if let Some(at) = self.reads.iter().position(|read| read.asked.is_due(now, &pace)) {
            let Read { offset, size, sequence, .. } = self.reads[at];
            let expected = format!("{} from byte {offset} on", self.path);
            self.reads[at].asked.send_at_most(READ_TRIES, now, &expected)?;
            return Ok(Some(self.request(sequence, operation::READ, offset, size)));
        }
        if self.reads.len() >= AT_ONCE {
            return Ok(None);
        }
        let pieces = gaps.iter().flat_map(|(from, to)| {
            (*from..*to).step_by(DATA_BYTES).map(move |offset| (offset, (to - offset).min(DATA_BYTES as u64)))
        });
        let mut asked = Asked::default();
        for (offset, size) in pieces {
            if self.reads.iter().any(|read| offset < read.offset + read.size && read.offset < offset + size) {
                continue;
            }
            asked.send_at_most(READ_TRIES, now, "")?;
            let sequence = self.ftp.number(now);
            self.reads.push(Read { offset, size, sequence, asked });
            return Ok(Some(self.request(sequence, operation::READ, offset, size)));
        }
        Ok(None)
    }

    fn take_burst(&mut self, now: Duration, transfer: &Transfer<'_>) {
        let (Some(burst), Some(window)) = (&mut self.burst, &mut self.window) else { return };
        let number = transfer.sequence.wrapping_sub(burst.sequence);
        if !(1..BURST_NUMBERS).contains(&number) || transfer.session != self.session {
            return;
        }
        match burst.heard.replace(now) {
            Some(before) => self.ftp.pace.spaced(now.saturating_sub(before)),
            None => self.ftp.pace.answered(now.saturating_sub(burst.began)),
        }
        burst.is_over |= transfer.burst_complete;
        match Answer::of(transfer) {
            Answer::Data(data) => {
                burst.brought |= window.take(u64::from(transfer.offset), &data);
            }
            Answer::Refused(code) => {
                burst.is_over = true;
                self.ends_early = code == refusal::END && window.end() < window.size();
                if code == refusal::INVALID_SESSION {
                    self.reopen();
                } else if code != refusal::END {
                    self.failure = Some(self.refused(code));
                }
            }
        }
        self.ftp.heard(transfer.sequence);
    }

    fn take_read(&mut self, now: Duration, transfer: &Transfer<'_>) {
        let is = |read: &Read| read.sequence.wrapping_add(1) == transfer.sequence;
        let (Some(at), Some(window)) = (self.reads.iter().position(is), &mut self.window) else { return };
        let read = self.reads.swap_remove(at);
        read.asked.answered(now, &mut self.ftp.pace);
        match Answer::of(transfer) {
            // by the offset of the request: an answer that states another is none
            Answer::Data(data) if u64::from(transfer.offset) == read.offset => {
                self.ends_early &= !window.take(read.offset, &data);
            }
            Answer::Data(_) => {}
            Answer::Refused(refusal::END) => {
                self.failure = Some(FetchError::Short { stated: window.size(), came: read.offset });
            }
            Answer::Refused(refusal::INVALID_SESSION) => self.reopen(),
            Answer::Refused(code) => self.failure = Some(self.refused(code)),
        }
    }
}

/// The checksum in the vehicle's answer.
fn sum_of(answer: &Answer) -> Sum {
    match answer {
        Answer::Data(data) => {
            let sum = data.first_chunk().copied();
            sum.map_or(Sum::NotOffered, |sum| Sum::Is(u32::from_le_bytes(sum)))
        }
        Answer::Refused(_) => Sum::NotOffered,
    }
}

impl Dialogue for FtpReading {
    fn poll(&mut self, now: Duration) -> Result<Option<MavMessage>, FetchError> {
        if let Some(failure) = self.failure.take() {
            return Err(failure);
        }
        let size = self.window.as_ref().map_or(0, Window::size);
        let next = match &mut self.step {
            Step::Open(question) => match question.answer() {
                Some(answer) => {
                    let session = question.session();
                    self.opened(&answer, session)?;
                    None
                }
                None => return question.poll(now, &mut self.ftp, ("the opening of the log", TRIES, None)),
            },
            Step::Reset(question) => match question.answer() {
                Some(_) => Some(Step::Open(Question::new(operation::OPEN, 0, &self.path))),
                None => return question.poll(now, &mut self.ftp, ("the end of other sessions", TRIES, None)),
            },
            Step::Read => return self.read(now),
            Step::Sum(question) => {
                let patience = Duration::from_secs(2 + size / SUM_BYTES_A_SECOND);
                self.sum = match question.answer() {
                    Some(answer) => sum_of(&answer),
                    None => match question.poll(now, &mut self.ftp, ("", SUM_TRIES, Some(patience))) {
                        Ok(message) => return Ok(message),
                        Err(_) => Sum::Unanswered,
                    },
                };
                Some(Step::Again(Question::new(operation::OPEN, 0, &self.path)))
            }
            Step::Again(question) => {
                match question.answer() {
                    Some(Answer::Data(data)) => {
                        let now_s = data.first_chunk().copied().map(u32::from_le_bytes).map(u64::from);
                        self.grown_to = now_s.filter(|now_s| *now_s != size);
                    }
                    Some(Answer::Refused(_)) => {}
                    None => {
                        if let Ok(message) = question.poll(now, &mut self.ftp, ("", TRIES, None)) {
                            return Ok(message);
                        }
                    }
                }
                let session = question.session();
                Some(Step::Close(Question::new(operation::TERMINATE, 0, "").within(session)))
            }
            Step::Close(question) => match question.answer() {
                Some(_) => Some(Step::Done),
                None => match question.poll(now, &mut self.ftp, ("", 3, None)) {
                    Ok(message) => return Ok(message),
                    Err(_) => Some(Step::Done),
                },
            },
            Step::Done => return Ok(None),
        };
        if let Some(next) = next {
            self.step = next;
        }
        self.poll(now)
    }

    fn take(&mut self, now: Duration, frame: &Frame<'_>) {
        match &mut self.step {
            Step::Open(question)
            | Step::Reset(question)
            | Step::Sum(question)
            | Step::Again(question)
            | Step::Close(question) => {
                question.take(now, &mut self.ftp, frame);
            }
            Step::Read => {
                let Some(transfer) = self.ftp.peer.heard_transfer(frame) else { return };
                match transfer.answers {
                    operation::BURST => self.take_burst(now, &transfer),
                    operation::READ => self.take_read(now, &transfer),
                    _ => {}
                }
            }
            Step::Done => {}
        }
    }

    fn is_done(&self) -> bool {
        matches!(self.step, Step::Done)
    }
}
