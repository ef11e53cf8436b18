//! FILE_TRANSFER_PROTOCOL: one session, read only, as both autopilots have it.

use super::folder::{Place, find};
use crate::sitl::logger::LogStore;
use crate::wire::file_transfer::{DATA_BYTES, FileSum, TRANSFER_BYTES, Transfer, operation, refusal};

/// Pieces of a burst after which it ends: PX4's 35 kB, ArduPilot's 500 messages.
const BURST_PX4: u32 = 150;
const BURST_ARDUPILOT: u32 = 500;
/// Pieces of a burst that go out in one period of the main loop.
const PIECES_A_LOOP: u32 = 6;

/// Who is answered, and on which link.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Client {
    link: usize,
    sender: (u8, u8),
}

/// A file that is read.
#[derive(Debug, Clone, Copy)]
struct Session {
    client: Client,
    log: u32,
}

/// A burst under way.
#[derive(Debug, Clone, Copy)]
struct Burst {
    sequence: u16,
    offset: u32,
    size: u8,
    left: u32,
}

/// An answer: on which link, to whom, and the payload.
pub(in crate::sitl) type Answer = (usize, (u8, u8), [u8; TRANSFER_BYTES]);

/// What was answered last.
#[derive(Debug)]
struct Answered {
    client: Client,
    /// number, operation and offset of the request
    asked: (u16, u8, u32),
    answer: [u8; TRANSFER_BYTES],
}

/// Serves files.
#[derive(Debug)]
pub(in crate::sitl) struct FileServer {
    /// messages of a burst
    burst_length: u32,
    session: Option<Session>,
    burst: Option<Burst>,
    /// the last request but bursts, and what it was answered with: one that comes twice is not obeyed twice
    last: Option<Answered>,
}

/// What an answer holds beyond the request's own numbers.
struct Reply {
    size: u8,
    offset: u32,
    data: Vec<u8>,
}

impl Reply {
    fn of(data: Vec<u8>, offset: u32) -> Self {
        Self { size: u8::try_from(data.len()).unwrap_or(u8::MAX), offset, data }
    }

    fn empty() -> Self {
        Self::of(Vec::new(), 0)
    }
}

impl FileServer {
    pub(in crate::sitl) fn new(is_px4: bool) -> Self {
        let burst_length = if is_px4 { BURST_PX4 } else { BURST_ARDUPILOT };
        Self { burst_length, session: None, burst: None, last: None }
    }

    /// Answers a request; a burst is answered by [`Self::pursue`].
    pub(in crate::sitl) fn take(
        &mut self,
        request: &Transfer<'_>,
        (link, sender): (usize, (u8, u8)),
        store: &LogStore,
    ) -> Option<Answer> {
        let client = Client { link, sender };
        let asked = (request.sequence, request.operation, request.offset);
        if let Some(last) = self.last.as_ref().filter(|last| (last.client, last.asked) == (client, asked)) {
            return Some((link, sender, last.answer));
        }
        let result = match request.operation {
            operation::TERMINATE | operation::RESET => {
                (self.session, self.burst) = (None, None);
                Ok(Reply::empty())
            }
            operation::LIST => list(request, store),
            operation::OPEN => self.open(request, client, store),
            operation::READ => self.read(request, client, store),
            operation::CRC => checksum(request, store),
            operation::BURST => match self.begin_burst(request, client) {
                Ok(()) => return None,
                Err(refused) => Err(refused),
            },
            // an answer to somebody else
            operation::ACK | operation::NAK => return None,
            _ => Err(refusal::UNKNOWN),
        };
        let answer = answered(request, result);
        self.last = Some(Answered { client, asked, answer });
        Some((link, sender, answer))
    }

    fn open(&mut self, request: &Transfer<'_>, client: Client, store: &LogStore) -> Result<Reply, u8> {
        if self.session.is_some_and(|session| session.client != client) {
            return Err(refusal::NO_SESSIONS);
        }
        match find(store, &path(request)) {
            Some(Place::File(log)) => {
                self.session = Some(Session { client, log: log.number });
                self.burst = None;
                Ok(Reply::of(log.size().to_le_bytes().to_vec(), 0))
            }
            _ => Err(refusal::NOT_FOUND),
        }
    }

    /// The log that this client has open.
    fn opened(&self, client: Client) -> Result<u32, u8> {
        let own = self.session.filter(|session| session.client == client);
        own.map(|session| session.log).ok_or(refusal::INVALID_SESSION)
    }

    fn read(&mut self, request: &Transfer<'_>, client: Client, store: &LogStore) -> Result<Reply, u8> {
        let log = self.opened(client)?;
        let data = piece(store, log, request.offset, request.size)?;
        Ok(Reply::of(data.to_vec(), request.offset))
    }

    fn begin_burst(&mut self, request: &Transfer<'_>, client: Client) -> Result<(), u8> {
        self.opened(client)?;
        let Transfer { sequence, offset, size, .. } = *request;
        self.burst = Some(Burst { sequence, offset, size, left: self.burst_length });
        Ok(())
    }

    /// What of a burst goes out in this period of the main loop.
    pub(in crate::sitl) fn pursue(&mut self, store: &LogStore) -> Vec<Answer> {
        let (Some(session), Some(mut burst)) = (self.session, self.burst) else { return Vec::new() };
        let mut out = Vec::new();
        for _ in 0..PIECES_A_LOOP {
            let found = piece(store, session.log, burst.offset, burst.size);
            burst.left -= 1;
            let is_over = found.is_err() || burst.left == 0;
            let Burst { sequence, offset, .. } = burst;
            let request = Transfer { offset, ..Transfer::request(sequence, operation::BURST) };
            let found = found.map(|data| Reply::of(data.to_vec(), burst.offset));
            burst.offset += found.as_ref().map_or(0, |reply| u32::from(reply.size));
            burst.sequence = burst.sequence.wrapping_add(1);
            let mut answer = answered(&request, found);
            // its place in the message
            answer[6] = u8::from(is_over);
            out.push((session.client.link, session.client.sender, answer));
            if is_over {
                self.burst = None;
                return out;
            }
        }
        self.burst = Some(burst);
        out
    }
}

fn path(request: &Transfer<'_>) -> String {
    let data = request.whole_data();
    let end = data.iter().position(|byte| *byte == 0).unwrap_or(data.len());
    String::from_utf8_lossy(&data[..end]).into_owned()
}

fn piece(store: &LogStore, log: u32, offset: u32, size: u8) -> Result<&[u8], u8> {
    let bytes = &store.get(log).ok_or(refusal::FAIL)?.bytes;
    let begin = usize::try_from(offset).unwrap_or(usize::MAX);
    let size = match usize::from(size) {
        0 => DATA_BYTES,
        size => size.min(DATA_BYTES),
    };
    match bytes.get(begin..) {
        Some(rest) if !rest.is_empty() => Ok(&rest[..size.min(rest.len())]),
        _ => Err(refusal::END),
    }
}

/// Entries from one on, each ended by a zero.
fn list(request: &Transfer<'_>, store: &LogStore) -> Result<Reply, u8> {
    let Some(Place::Folder(entries)) = find(store, &path(request)) else { return Err(refusal::NOT_FOUND) };
    let first = usize::try_from(request.offset).unwrap_or(usize::MAX);
    let rest = entries.get(first..).filter(|rest| !rest.is_empty()).ok_or(refusal::END)?;
    let mut data = Vec::new();
    for entry in rest {
        if data.len() + entry.len() + 1 > DATA_BYTES {
            break;
        }
        data.extend(entry.bytes());
        data.push(0);
    }
    Ok(Reply::of(data, request.offset))
}

fn checksum(request: &Transfer<'_>, store: &LogStore) -> Result<Reply, u8> {
    match find(store, &path(request)) {
        Some(Place::File(log)) => Ok(Reply::of(FileSum::of(&log.bytes).to_le_bytes().to_vec(), 0)),
        _ => Err(refusal::NOT_FOUND),
    }
}

fn answered(request: &Transfer<'_>, result: Result<Reply, u8>) -> [u8; TRANSFER_BYTES] {
    let (operation, reply) = match result {
        Ok(reply) => (operation::ACK, reply),
        Err(code) => (operation::NAK, Reply::of(vec![code], request.offset)),
    };
    let answer = Transfer {
        sequence: request.sequence.wrapping_add(1),
        // the only one
        session: 0,
        operation,
        size: reply.size,
        answers: request.operation,
        burst_complete: false,
        offset: reply.offset,
        data: &reply.data,
    };
    answer.bytes()
}
