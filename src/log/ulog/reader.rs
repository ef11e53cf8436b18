//! Reads a ULog message by message, over any reader, in bounded memory.

use crate::autopilot::{ULOG_HEAD_BYTES, ULOG_MAGIC};
use std::io::Read;

use super::message::{
    Likeness, MOST_BYTES, Message, PREFIX_BYTES, Shape, appended_offsets, data_bytes, parse, shape,
    subscription,
};
use super::report::UlogReport;
use super::schema::Schema;
use crate::log::error::LogError;
use crate::log::lookahead::LookAhead;

/// In sight for every judgement: a message and the next, and as much of what follows as tells what it is.
const LOOK_BYTES: usize = 2 * MOST_BYTES + ULOG_HEAD_BYTES + 256;
/// In sight at once of a log that is read whole.
const WHOLE_CHUNK_BYTES: usize = 4 << 20;
/// Messages of numbers that are not known, one behind the other, that speak for each other.
const WITNESSES: usize = 3;
/// Offsets of data that were appended after the file had been closed; a file has room for three.
const MOST_APPENDED: usize = 3;

/// Reads a ULog.
///
/// A ULog has no checksums. A message counts only where the next one, or the end of the file, follows on it: what stands
/// before damage may be damaged itself. Damage is skipped to the next two messages in a row whose contents fit their
/// kind; a cut-off last message ends the log. All of it is counted.
#[derive(Debug)]
pub struct UlogReader<R: Read> {
    bytes: LookAhead<R>,
    schema: Schema,
    appended: Vec<u64>,
    /// length of the message that `next_message` gave last
    given: usize,
    /// length of the data message that follows on it, where one was seen
    following: Option<usize>,
    report: UlogReport,
}

/// A message and where it stands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Entry<'a> {
    /// byte offset in the file
    pub offset: u64,
    /// length, prefix included
    pub bytes: usize,
    /// what it says
    pub message: Message<'a>,
}

/// What is to be done at the reading position.
enum Step {
    Take {
        bytes: usize,
    },
    /// the file ends here
    End,
    /// the file ends within a message
    CutOff,
    /// the message before appended data was never finished
    Jump {
        bytes: usize,
    },
    Damage,
}

impl<R: Read> UlogReader<R> {
    /// Reads from the start of `from`; no buffering of its own is needed.
    pub fn new(from: R) -> Self {
        Self::over(LookAhead::new(from))
    }

    /// The same, for a log that is read whole: more of it is in sight at once.
    pub(super) fn whole(from: R) -> Self {
        Self::over(LookAhead::with_chunk(from, WHOLE_CHUNK_BYTES))
    }

    fn over(bytes: LookAhead<R>) -> Self {
        Self {
            bytes,
            schema: Schema::default(),
            appended: Vec::new(),
            given: 0,
            following: None,
            report: UlogReport::default(),
        }
    }

    /// The next message, `None` at the end.
    ///
    /// # Errors
    /// The reader beneath fails, or the file is empty, or does not begin as a ULog.
    pub fn next_message(&mut self) -> Result<Option<Entry<'_>>, LogError> {
        loop {
            self.bytes.skip(std::mem::take(&mut self.given));
            self.bytes.look(LOOK_BYTES)?;
            self.report.bytes = self.bytes.offset();
            if let Some(bytes) = self.data_on_data() {
                self.given = bytes;
                break;
            }
            if self.bytes.offset() == 0 {
                self.check_beginning()?;
            }
            match self.step() {
                Step::Take { bytes } => {
                    self.given = bytes;
                    let is_read = self.take(bytes);
                    let rest = self.bytes.sight().get(bytes..).unwrap_or_default();
                    self.following = data_bytes(rest, &self.schema).filter(|_| self.appended.is_empty());
                    if is_read {
                        break;
                    }
                    self.report.note_unreadable(self.bytes.offset(), bytes);
                }
                Step::End => return Ok(None),
                Step::CutOff => self.resynchronise(true)?,
                Step::Jump { bytes } => {
                    self.report.note_skipped(self.bytes.offset(), bytes as u64);
                    self.bytes.skip(bytes);
                }
                Step::Damage => self.resynchronise(false)?,
            }
        }
        Ok(self.given())
    }

    /// Gives `take` the data in sight that follow on each other from here on, as [`Self::next_message`] would give them one by
    /// one: the number of the topic, the stamp, and the fields. It ends before the first one that `take` does not want.
    ///
    /// # Errors
    /// The reader beneath fails.
    pub(super) fn run(
        &mut self,
        take: &mut impl FnMut(u16, Option<u64>, &[u8]) -> bool,
    ) -> Result<(), LogError> {
        self.bytes.skip(std::mem::take(&mut self.given));
        self.bytes.look(LOOK_BYTES)?;
        let least = if self.bytes.is_all() { 0 } else { LOOK_BYTES };
        let mut sight = self.bytes.sight();
        while let Some(bytes) = self.following.filter(|_| sight.len() >= least) {
            let next = sight.split_at_checked(bytes).and_then(|(message, rest)| {
                let [_, _, _, low, high, body @ ..] = message else { return None };
                let id = u16::from_le_bytes([*low, *high]);
                let stamp_us = self.schema.stamp_us(id, body);
                Some((data_bytes(rest, &self.schema)?, id, stamp_us, body, rest))
            });
            let Some((following, id, stamp_us, body, rest)) = next else { break };
            if !take(id, stamp_us, body) {
                break;
            }
            self.report.messages += 1;
            self.report.note_data(id, stamp_us);
            self.following = Some(following);
            self.given += bytes;
            sight = rest;
        }
        Ok(())
    }

    /// What was met so far; complete once `next_message` has returned `None`.
    #[must_use]
    pub fn report(&self) -> &UlogReport {
        &self.report
    }

    /// The report, when reading is done.
    #[must_use]
    pub fn into_report(self) -> UlogReport {
        self.report
    }

    /// Length of the message at the reading position where it is data that was seen there before, and data follow again: what
    /// most of a log is. It is counted.
    #[inline]
    fn data_on_data(&mut self) -> Option<usize> {
        let bytes = self.following.take()?;
        let (message, rest) = self.bytes.sight().split_at_checked(bytes)?;
        self.following = Some(data_bytes(rest, &self.schema)?);
        let [_, _, _, low, high, body @ ..] = message else { return None };
        let subscription = self.schema.subscription(u16::from_le_bytes([*low, *high]))?;
        self.report.messages += 1;
        self.report.note_data(subscription.id, subscription.layout.stamp_us(body));
        Some(bytes)
    }

    fn check_beginning(&self) -> Result<(), LogError> {
        let sight = self.bytes.sight();
        match sight {
            [] => Err(LogError::Empty),
            _ if sight.starts_with(&ULOG_MAGIC) && sight.len() >= ULOG_HEAD_BYTES => Ok(()),
            _ => Err(LogError::WrongContent {
                format: "PX4 log",
                expected: "the letters ULog, a version and a stamp",
                came: if sight.starts_with(&ULOG_MAGIC) {
                    format!("the first {} bytes of one: give the whole log", sight.len())
                } else {
                    format!("a file that begins with {:02x?}", &sight[..sight.len().min(ULOG_HEAD_BYTES)])
                },
            }),
        }
    }

    /// Judges what stands at the reading position.
    fn step(&self) -> Step {
        let (sight, offset) = (self.bytes.sight(), self.bytes.offset());
        if sight.is_empty() {
            return Step::End;
        }
        let Some(this) = shape(sight, &self.schema) else { return Step::CutOff };
        if let Some(bytes) = self.before_appended(offset, this, sight) {
            return Step::Jump { bytes };
        }
        match (this.likeness, sight.get(this.bytes..)) {
            (Likeness::None, _) => Step::Damage,
            (_, None) => Step::CutOff,
            (_, Some(_)) if sight.starts_with(&ULOG_MAGIC) => Step::Take { bytes: this.bytes },
            (likeness, Some(rest)) if self.is_followed(likeness, rest) => Step::Take { bytes: this.bytes },
            _ => Step::Damage,
        }
    }

    /// Bytes to the next appended data, where the message at `offset` would run into them.
    fn before_appended(&self, offset: u64, this: Shape, sight: &[u8]) -> Option<usize> {
        let next = self.appended.iter().copied().find(|appended| *appended > offset)?;
        let bytes = usize::try_from(next - offset).ok()?;
        let runs_in = this.likeness == Likeness::None || this.bytes > bytes;
        let begins = || shape(sight.get(bytes..)?, &self.schema).map(|shape| shape.likeness);
        (runs_in && bytes <= MOST_BYTES && begins() == Some(Likeness::Strong)).then_some(bytes)
    }

    /// Whether what follows on a message lets it be one: a message whose contents fit its kind, the end of the file, or
    /// several whose subscription was lost.
    fn is_followed(&self, likeness: Likeness, rest: &[u8]) -> bool {
        let mut rest = rest;
        for _ in 0..WITNESSES {
            let Some(next) = shape(rest, &self.schema) else { return self.bytes.is_all() };
            let is_data = rest.get(PREFIX_BYTES - 1) == Some(&b'D');
            match (next.likeness, rest.get(next.bytes..)) {
                (Likeness::None, _) => return false,
                (Likeness::Strong, _) => return true,
                (Likeness::Weak, Some(after)) if is_data || likeness == Likeness::Strong => rest = after,
                (Likeness::Weak, _) => return false,
            }
        }
        true
    }

    /// Takes in what a message defines; `false` where its body is not what its kind says.
    fn take(&mut self, bytes: usize) -> bool {
        let message = &self.bytes.sight()[..bytes];
        let (kind, body) = (message[PREFIX_BYTES - 1], &message[PREFIX_BYTES..]);
        self.report.messages += 1;
        if message.starts_with(&ULOG_MAGIC) {
            // one log behind another: numbers have a meaning of their own in each
            self.schema = Schema::default();
            self.appended.clear();
            self.report.note_begin();
            return true;
        }
        match kind {
            b'B' => {
                self.appended.extend(appended_offsets(body).take(MOST_APPENDED));
                self.appended.sort_unstable();
                true
            }
            b'F' => self.schema.define(body),
            b'A' => {
                let Some((id, instance, name)) = subscription(body) else { return false };
                let Some(taken) = self.schema.subscribe(id, instance, name) else { return false };
                self.report.note_subscription(taken);
                true
            }
            b'D' => {
                let Some(Message::Data { subscription, bytes }) = parse(kind, body, &self.schema) else {
                    self.report.note_orphan(self.bytes.offset());
                    return true;
                };
                self.report.note_data(subscription.id, subscription.layout.stamp_us(bytes));
                true
            }
            b'O' => {
                self.report.note_dropout(body);
                true
            }
            b'I' | b'P' | b'Q' | b'L' | b'C' => parse(kind, body, &self.schema).is_some(),
            _ => true,
        }
    }

    /// The message that was taken.
    fn given(&self) -> Option<Entry<'_>> {
        let message = &self.bytes.sight()[..self.given];
        let (kind, body) = (*message.get(PREFIX_BYTES - 1)?, message.get(PREFIX_BYTES..)?);
        let message = if kind == b'D' {
            parse(kind, body, &self.schema).unwrap_or(Message::Other { kind })
        } else if message.starts_with(&ULOG_MAGIC) {
            let stamp = message.get(ULOG_MAGIC.len() + 1..)?.first_chunk()?;
            Message::Begin { start_us: u64::from_le_bytes(*stamp) }
        } else if kind == b'A' {
            Message::Subscribe(self.schema.subscription(subscription(body)?.0)?)
        } else {
            parse(kind, body, &self.schema).unwrap_or(Message::Other { kind })
        };
        Some(Entry { offset: self.bytes.offset(), bytes: self.given, message })
    }

    /// Skips to the next place at which two messages stand in a row, or to the end; there a message may be cut off, or
    /// zeros stand.
    fn resynchronise(&mut self, mut cut_off: bool) -> Result<(), LogError> {
        let start = self.bytes.offset();
        // behind the last byte that is no zero
        let mut written_to = start;
        loop {
            let (sight, is_all) = (self.bytes.sight(), self.bytes.is_all());
            // of what begins further on, the end may not be in sight
            let sure = if is_all { sight.len() } else { sight.len().saturating_sub(LOOK_BYTES) };
            let found = (1..sure).find(|at| self.resumes(&sight[*at..]));
            let skipped = found.unwrap_or(if is_all { sight.len() } else { sure.saturating_sub(1) });
            if let Some(last) = sight[..skipped].iter().rposition(|byte| *byte != 0) {
                written_to = self.bytes.offset() + last as u64 + 1;
            }
            self.bytes.skip(skipped);
            if found.is_some() {
                written_to = self.bytes.offset();
                cut_off = false;
            }
            if found.is_some() || is_all {
                break;
            }
            self.bytes.look(2 * LOOK_BYTES)?;
        }
        let end = self.bytes.offset();
        let kept_to = if cut_off { start } else { written_to };
        if end > kept_to {
            self.report.note_cut_off(kept_to, end - kept_to);
        }
        if kept_to > start {
            self.report.note_skipped(start, kept_to - start);
        }
        Ok(())
    }

    /// A message whose contents fit, and another on it or the end of the file.
    fn resumes(&self, sight: &[u8]) -> bool {
        let Some(this) = shape(sight, &self.schema).filter(|this| this.likeness == Likeness::Strong) else {
            return false;
        };
        let Some(rest) = sight.get(this.bytes..) else { return false };
        match shape(rest, &self.schema) {
            None => rest.is_empty() && self.bytes.is_all(),
            Some(next) => next.likeness == Likeness::Strong,
        }
    }
}
