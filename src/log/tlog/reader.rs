//! Reads telemetry logs record by record, over any reader, in bounded memory.

use std::io::Read;

use super::report::TlogReport;
use crate::log::error::LogError;
use crate::log::lookahead::LookAhead;
use crate::wire::{
    ByteOrder, Check, CrcSeeds, Frame, Header, MARKER_V1, MARKER_V2, MAX_FRAME_BYTES, Record, STAMP_BYTES,
    Start, is_wall_clock,
};

const RECORD_BYTES: usize = STAMP_BYTES + MAX_FRAME_BYTES;
/// What must lie ahead for every judgement: a record and the three that confirm it.
const LOOKAHEAD: usize = 4 * RECORD_BYTES;
/// A file without a record in its first bytes is no telemetry log.
const SEARCH_BYTES: u64 = 1 << 20;
/// Records whose stamps tell the byte order.
const ORDER_RECORDS: usize = 3;
/// Neighbouring stamps further apart than three days are no neighbours (pymavlink's measure).
const NEIGHBOUR_US: u64 = 3 * 86_400 * 1_000_000;

/// Reads a telemetry log.
///
/// Takes MAVLink 1 and 2 mixed, several frames behind one stamp, stamps that jump or run backwards (file
/// order is kept), and little-endian stamps. Damage is skipped to the next record with a plausible stamp
/// and a right checksum; a cut-off last record or a tail of zeros ends the log. All of it is counted.
#[derive(Debug)]
pub struct TlogReader<R: Read> {
    bytes: LookAhead<R>,
    /// bytes of the record that was given out last
    given: usize,
    /// how the file begins, for its refusal
    beginning: Option<String>,
    seeds: CrcSeeds,
    order: Option<ByteOrder>,
    last_stamp_us: Option<u64>,
    report: TlogReport,
}

/// What stands at the reading position.
enum Found {
    /// a record; `stamp_bytes` is 0 where it shares the stamp before
    Record {
        stamp_us: u64,
        stamp_bytes: usize,
        frame_bytes: usize,
        known: bool,
    },
    /// a whole record with a wrong checksum
    BadCrc {
        bytes: usize,
    },
    /// a record that the file's end cuts off
    CutOff,
    Nothing,
}

impl<R: Read> TlogReader<R> {
    /// Reads from the start of `from`; no buffering of its own is needed.
    pub fn new(from: R) -> Self {
        Self {
            bytes: LookAhead::new(from),
            given: 0,
            beginning: None,
            seeds: CrcSeeds::new(),
            order: None,
            last_stamp_us: None,
            report: TlogReport::default(),
        }
    }

    /// The next record, `None` at the end.
    ///
    /// # Errors
    /// The reader beneath fails, or the file is empty, or nothing in it looks like a telemetry log.
    pub fn next_record(&mut self) -> Result<Option<Record<'_>>, LogError> {
        let Some((stamp_us, stamp_bytes, frame_bytes, known)) = self.advance()? else { return Ok(None) };
        self.given = stamp_bytes + frame_bytes;
        let offset = self.bytes.offset() + stamp_bytes as u64;
        let record = Frame::at_start(&self.bytes.sight()[stamp_bytes..self.given]).map(|frame| Record {
            stamp_us,
            offset,
            known,
            frame,
        });
        if let Some(record) = &record {
            self.report.tally(record, self.last_stamp_us, stamp_bytes == 0);
        }
        self.last_stamp_us = Some(stamp_us);
        Ok(record)
    }

    /// Moves to the next record: its stamp, the stamp's bytes, the frame's bytes, whether it is known.
    fn advance(&mut self) -> Result<Option<(u64, usize, usize, bool)>, LogError> {
        self.bytes.skip(std::mem::take(&mut self.given));
        loop {
            self.look_ahead()?;
            if self.bytes.sight().is_empty() {
                return self.finish().map(|()| None);
            }
            match self.find() {
                Found::Record { stamp_us, stamp_bytes, frame_bytes, known } => {
                    return Ok(Some((stamp_us, stamp_bytes, frame_bytes, known)));
                }
                Found::BadCrc { bytes } => {
                    self.report.note_bad_crc(self.bytes.offset());
                    self.bytes.skip(bytes);
                }
                Found::CutOff => self.resynchronise(true)?,
                Found::Nothing => self.resynchronise(false)?,
            }
        }
    }

    /// What was met so far; complete once `next_record` has returned `None`.
    #[must_use]
    pub fn report(&self) -> &TlogReport {
        &self.report
    }

    /// The report, when reading is done.
    #[must_use]
    pub fn into_report(self) -> TlogReport {
        self.report
    }

    /// Makes sure that enough bytes lie ahead, or all that are left.
    fn look_ahead(&mut self) -> Result<(), LogError> {
        self.bytes.look(LOOKAHEAD)?;
        if self.beginning.is_none() {
            self.beginning = Some(self.described());
        }
        self.report.bytes = self.bytes.offset() + self.bytes.sight().len() as u64;
        if self.order.is_none() {
            self.order = self.tell_order();
        }
        Ok(())
    }

    /// What stands at the reading position, for a person.
    fn described(&self) -> String {
        let sight = self.bytes.sight();
        let frames = if self.is_checked_frame(0) { ": MAVLink frames without stamps" } else { "" };
        format!("{:02x?}{frames}", &sight[..sight.len().min(16)])
    }

    fn finish(&self) -> Result<(), LogError> {
        if self.report.bytes == 0 {
            return Err(LogError::Empty);
        }
        if self.report.frames == 0 { Err(self.not_a_tlog()) } else { Ok(()) }
    }

    fn not_a_tlog(&self) -> LogError {
        LogError::WrongContent {
            format: "telemetry log",
            expected: "8-byte stamp in microseconds, then a MAVLink frame, repeated",
            came: format!("a file that begins with {}", self.beginning.as_deref().unwrap_or("nothing")),
        }
    }

    fn frame(&self, at: usize) -> Option<Frame<'_>> {
        Frame::at_start(self.bytes.sight().get(at..)?)
    }

    fn is_checked_frame(&self, at: usize) -> bool {
        self.frame(at).is_some_and(|frame| frame.check(&self.seeds) == Check::Right)
    }

    fn stamp(&self, at: usize) -> Option<u64> {
        self.order.unwrap_or_default().stamp_us(self.bytes.sight().get(at..)?)
    }

    /// A stamp is plausible next to the last one, or on its own as a wall clock's.
    fn plausible(&self, stamp_us: u64) -> bool {
        is_wall_clock(stamp_us)
            || self.last_stamp_us.is_some_and(|last| last.abs_diff(stamp_us) < NEIGHBOUR_US)
    }

    /// What stands at the reading position, where a record should begin.
    fn find(&self) -> Found {
        if let Some(found) = self.find_behind_same_stamp() {
            return found;
        }
        let stamped = STAMP_BYTES;
        let frame = self.frame(stamped);
        let check = frame.map(|frame| frame.check(&self.seeds));
        if let (Some(frame), Some(Check::Right), Some(stamp_us)) = (frame, check, self.stamp(0)) {
            return self.stamped_record(stamp_us, frame, true);
        }
        let Some(stamp_us) = self.stamp(0) else { return Found::CutOff };
        if !self.plausible(stamp_us) {
            return Found::Nothing;
        }
        match frame {
            Some(frame) if self.is_one_record(stamped + frame.bytes().len()) => match check {
                Some(Check::UnknownMessage) => self.stamped_record(stamp_us, frame, false),
                _ => Found::BadCrc { bytes: STAMP_BYTES + frame.bytes().len() },
            },
            None if self.bytes.is_all() && self.header(stamped) != Start::NotAFrame => Found::CutOff,
            _ => Found::Nothing,
        }
    }

    fn stamped_record(&self, stamp_us: u64, frame: Frame<'_>, known: bool) -> Found {
        Found::Record { stamp_us, stamp_bytes: STAMP_BYTES, frame_bytes: frame.bytes().len(), known }
    }

    /// Some ground stations put one stamp before a chunk of several sent frames.
    fn find_behind_same_stamp(&self) -> Option<Found> {
        if !self.marked(0) {
            return None;
        }
        let stamp_us = self.last_stamp_us?;
        let frame = self.frame(0)?;
        if self.stamp(0).is_some_and(|stamp_us| self.plausible(stamp_us)) {
            return None;
        }
        let frame_bytes = frame.bytes().len();
        let check = frame.check(&self.seeds);
        // without a stamp, noise looks like a frame too easily: its sender or what follows must vouch for it
        let follows = self.fits_next(frame_bytes);
        let speaks = self.report.knows(frame.header());
        let known = check == Check::Right;
        if !(known && (follows || speaks) || check == Check::UnknownMessage && follows && speaks) {
            return None;
        }
        Some(Found::Record { stamp_us, stamp_bytes: 0, frame_bytes, known })
    }

    fn header(&self, at: usize) -> Start {
        Header::read(self.bytes.sight().get(at..).unwrap_or_default())
    }

    /// A record, or the end of the log, may begin at `at`.
    fn fits_next(&self, at: usize) -> bool {
        let in_sight = self.bytes.sight().len();
        if at >= in_sight {
            return at == in_sight && self.bytes.is_all();
        }
        let stamped = self.stamp(at).is_none_or(|stamp_us| self.plausible(stamp_us))
            && self.header(at + STAMP_BYTES) != Start::NotAFrame;
        stamped || self.is_checked_frame(at)
    }

    /// The log goes on at `end`, and no run of checked records begins behind the reading position and reaches `end`: the
    /// bytes to there are one record although its checksum does not prove it.
    fn is_one_record(&self, end: usize) -> bool {
        self.fits_next(end) && !(1..end).any(|inside| self.run_of_checked_records(inside, end) >= end)
    }

    fn run_of_checked_records(&self, from: usize, until: usize) -> usize {
        let mut at = from;
        while at < until && self.marked(at + STAMP_BYTES) && self.checked_record_at(at) {
            at += STAMP_BYTES + self.frame(at + STAMP_BYTES).map_or(0, |frame| frame.bytes().len());
        }
        at
    }

    fn marked(&self, at: usize) -> bool {
        self.bytes.sight().get(at).is_some_and(|byte| matches!(*byte, MARKER_V1 | MARKER_V2))
    }

    /// Skips to the next record. What is skipped is damage; at the file's end, zeros or a record cut off
    /// are its tail.
    fn resynchronise(&mut self, cut_off: bool) -> Result<(), LogError> {
        let from = self.bytes.offset();
        let mut only_zeros = true;
        loop {
            only_zeros &= self.bytes.sight().first() == Some(&0);
            self.bytes.skip(1);
            self.look_ahead()?;
            let skipped = self.bytes.offset() - from;
            if self.bytes.sight().is_empty() {
                if only_zeros || cut_off {
                    self.report.truncated_tail_bytes += skipped;
                } else {
                    self.report.note_resync(from, skipped);
                }
                return Ok(());
            }
            if self.report.frames == 0 && skipped > SEARCH_BYTES {
                return Err(self.not_a_tlog());
            }
            if self.restarts() {
                self.report.note_resync(from, skipped);
                return Ok(());
            }
        }
    }

    /// Behind damage a record must prove itself: a right checksum, and a plausible stamp or, where the host's clock was
    /// set meanwhile, a sender that spoke before or a next record; or, where the message is not known, a next record
    /// that fits.
    fn restarts(&mut self) -> bool {
        if !self.marked(STAMP_BYTES) {
            return false;
        }
        if self.report.frames == 0 {
            self.order = self.tell_order();
        }
        let Some(stamp_us) = self.stamp(0) else { return false };
        let Some(frame) = self.frame(STAMP_BYTES) else { return false };
        let plausible = self.plausible(stamp_us);
        let next = STAMP_BYTES + frame.bytes().len();
        match frame.check(&self.seeds) {
            Check::Right => {
                plausible || self.report.knows(frame.header()) || self.is_checked_neighbour(next, stamp_us)
            }
            Check::Wrong => false,
            Check::UnknownMessage => {
                let is_last = next == self.bytes.sight().len() && self.bytes.is_all();
                plausible && (is_last || self.checked_record_at(next))
            }
        }
    }

    /// A record with a right checksum, and a stamp next to another's, whatever clock both are of.
    fn is_checked_neighbour(&self, at: usize, stamp_us: u64) -> bool {
        self.stamp(at).is_some_and(|next| next.abs_diff(stamp_us) < NEIGHBOUR_US)
            && self.is_checked_frame(at + STAMP_BYTES)
    }

    fn checked_record_at(&self, at: usize) -> bool {
        self.stamp(at).is_some_and(|stamp_us| self.plausible(stamp_us))
            && self.is_checked_frame(at + STAMP_BYTES)
    }

    /// Tells the byte order from the stamps of the next records: little-endian only where every stamp is a wall clock's
    /// that way and none the other way.
    fn tell_order(&mut self) -> Option<ByteOrder> {
        let (mut at, mut records, mut big, mut little) = (0, 0, 0, 0);
        while records < ORDER_RECORDS {
            let Some(frame) = self.frame(at + STAMP_BYTES) else { break };
            if frame.check(&self.seeds) == Check::Wrong {
                break;
            }
            let bytes = &self.bytes.sight()[at..];
            big += usize::from(ByteOrder::Big.stamp_us(bytes).is_some_and(is_wall_clock));
            little += usize::from(ByteOrder::Little.stamp_us(bytes).is_some_and(is_wall_clock));
            records += 1;
            at += STAMP_BYTES + frame.bytes().len();
        }
        let order = match records {
            0 => return None,
            _ if big == 0 && little == records => ByteOrder::Little,
            _ => ByteOrder::Big,
        };
        self.report.byte_order = order;
        Some(order)
    }
}
