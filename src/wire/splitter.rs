//! Finds MAVLink frames in a stream of bytes. It does no I/O: feed it, then take frames.

use super::checksum::CrcSeeds;
use super::frame::{Check, ComponentId, Frame, Header, MARKER_V1, MARKER_V2, Start, SystemId};

/// How far a chain of frames is followed to tell whether an unproven frame ends where it says.
const CHAIN: usize = 3;
/// Senders that are remembered, the first that prove themselves.
const SENDERS: usize = 64;

/// What the splitter met so far.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct SplitCounts {
    /// frames given out
    pub frames: u64,
    /// of these, frames whose message id is not known, taken by their length
    pub unknown: u64,
    /// whole frames dropped for a wrong checksum
    pub bad_crc: u64,
    /// bytes that belong to no frame
    pub skipped_bytes: u64,
}

/// Splits bytes of a link or a raw capture into frames.
///
/// A frame of a known message with a right checksum is given out at once. A frame that proves nothing
/// (unknown message, or wrong checksum) is one unit where it stands right behind another frame or comes from a
/// sender of checked frames, and the stream continues with a frame at its end. It is none where checked frames
/// begin inside it and run to or across its end, as they do behind noise that looks like a header. Where
/// neither holds, its sender is known and a checked frame lies inside, nothing of it is given out: a payload
/// must not be able to fake a message.
#[derive(Debug, Clone)]
pub struct Splitter {
    seeds: CrcSeeds,
    buffer: Vec<u8>,
    at: usize,
    ended: bool,
    /// the last bytes were a frame's, not skipped
    in_step: bool,
    senders: Vec<(SystemId, ComponentId)>,
    counts: SplitCounts,
}

impl Default for Splitter {
    fn default() -> Self {
        Self::new()
    }
}

enum Shape {
    NotAFrame,
    Incomplete,
    Frame(Header, Check),
}

enum Verdict {
    Wait,
    Slide,
    Take { bytes: usize, known: bool },
    Drop { bytes: usize, bad_crc: bool },
}

impl Splitter {
    /// An empty splitter for the dialect's messages.
    #[must_use]
    pub fn new() -> Self {
        Self {
            seeds: CrcSeeds::new(),
            buffer: Vec::new(),
            at: 0,
            ended: false,
            in_step: true,
            senders: Vec::new(),
            counts: SplitCounts::default(),
        }
    }

    /// Adds received bytes. Frames taken before are forgotten. At most a few frames' length stays
    /// unjudged, so the buffer is bounded by that and by the largest piece fed.
    pub fn feed(&mut self, bytes: &[u8]) {
        self.buffer.drain(..self.at);
        self.at = 0;
        self.ended = false;
        self.buffer.extend_from_slice(bytes);
    }

    /// No bytes will follow those fed so far (end of file, end of a datagram, a silent link): what waited
    /// for its continuation is decided with what is there. A frame cut off here is lost.
    pub fn flush(&mut self) {
        self.ended = true;
    }

    /// The next frame; `None` until more bytes are fed.
    pub fn next_frame(&mut self) -> Option<Frame<'_>> {
        let start = loop {
            match self.judge() {
                Verdict::Wait => return None,
                Verdict::Slide => self.skip(1, false),
                Verdict::Drop { bytes, bad_crc } => {
                    self.counts.bad_crc += u64::from(bad_crc);
                    self.skip(bytes, true);
                }
                Verdict::Take { bytes, known } => {
                    self.in_step = true;
                    self.counts.frames += 1;
                    self.counts.unknown += u64::from(!known);
                    let start = self.at;
                    self.at += bytes;
                    break start;
                }
            }
        };
        let frame = Frame::at_start(&self.buffer[start..])?;
        let sender = (frame.header().system, frame.header().component);
        if !self.senders.contains(&sender)
            && self.senders.len() < SENDERS
            && frame.check(&self.seeds) == Check::Right
        {
            self.senders.push(sender);
        }
        Some(frame)
    }

    /// What was met so far.
    #[must_use]
    pub fn counts(&self) -> &SplitCounts {
        &self.counts
    }

    fn skip(&mut self, bytes: usize, in_step: bool) {
        self.at += bytes;
        self.in_step = in_step;
        self.counts.skipped_bytes += bytes as u64;
    }

    fn shape(&self, at: usize) -> Shape {
        let bytes = self.buffer.get(at..).unwrap_or_default();
        match Header::read(bytes) {
            Start::NotAFrame => Shape::NotAFrame,
            Start::TooShort => Shape::Incomplete,
            Start::Header(header) => match Frame::at_start(bytes) {
                Some(frame) => Shape::Frame(header, frame.check(&self.seeds)),
                None => Shape::Incomplete,
            },
        }
    }

    fn judge(&self) -> Verdict {
        if self.at == self.buffer.len() {
            return Verdict::Wait;
        }
        match self.shape(self.at) {
            Shape::NotAFrame => Verdict::Slide,
            Shape::Incomplete if self.ended => Verdict::Slide,
            Shape::Incomplete => Verdict::Wait,
            Shape::Frame(header, Check::Right) => Verdict::Take { bytes: header.frame_bytes(), known: true },
            Shape::Frame(header, check) => self.judge_unproven(&header, check),
        }
    }

    /// A frame whose checksum does not prove it.
    fn judge_unproven(&self, header: &Header, check: Check) -> Verdict {
        let sender = (header.system, header.component);
        let known_sender = self.senders.contains(&sender);
        if !known_sender && !self.in_step {
            return Verdict::Slide;
        }
        let bytes = header.frame_bytes();
        let end = self.at + bytes;
        let mut encloses = false;
        for inside in self.at + 1..end {
            if !matches!(self.buffer[inside], MARKER_V1 | MARKER_V2) {
                continue;
            }
            match self.run_of_checked_frames(inside, end) {
                Some(reached) if reached >= end => return Verdict::Slide,
                Some(reached) => encloses |= reached > inside,
                None => return Verdict::Wait,
            }
        }
        match self.goes_on(end, CHAIN, sender) {
            None => Verdict::Wait,
            Some(true) if check == Check::UnknownMessage => Verdict::Take { bytes, known: false },
            Some(true) => Verdict::Drop { bytes, bad_crc: true },
            Some(false) if encloses && known_sender => {
                Verdict::Drop { bytes, bad_crc: check == Check::Wrong }
            }
            Some(false) => Verdict::Slide,
        }
    }

    /// Where the run of checked frames that begins at `from` ends, at or behind `until` at the latest;
    /// `None` where a frame that may belong to it is not complete yet.
    fn run_of_checked_frames(&self, from: usize, until: usize) -> Option<usize> {
        let mut at = from;
        while at < until {
            match self.shape(at) {
                Shape::Frame(header, Check::Right) => at += header.frame_bytes(),
                Shape::Incomplete if !self.ended => return None,
                _ => break,
            }
        }
        Some(at)
    }

    /// Whether a frame begins at `at`, seen through up to `chain` frames of `sender` or of known senders that
    /// prove nothing themselves; `None` where too few bytes are there to tell.
    fn goes_on(&self, at: usize, chain: usize, sender: (SystemId, ComponentId)) -> Option<bool> {
        if chain == 0 {
            return Some(true);
        }
        if at == self.buffer.len() {
            return self.ended.then_some(true);
        }
        match self.shape(at) {
            Shape::NotAFrame => Some(false),
            Shape::Incomplete => self.ended.then_some(false),
            Shape::Frame(_, Check::Right) => Some(true),
            Shape::Frame(header, _) => {
                let next = (header.system, header.component);
                if next == sender || self.senders.contains(&next) {
                    self.goes_on(at + header.frame_bytes(), chain - 1, sender)
                } else {
                    Some(false)
                }
            }
        }
    }
}
