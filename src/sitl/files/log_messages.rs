//! LOG_REQUEST_LIST, LOG_REQUEST_DATA, LOG_REQUEST_END. LOG_ERASE is not obeyed.

use mavlink::dialects::ardupilotmega::{LOG_DATA_DATA, LOG_ENTRY_DATA};

use crate::sitl::logger::LogStore;

/// Bytes of one LOG_DATA.
const DATA_BYTES: usize = 90;
/// Messages that go out in one period of the main loop.
const MESSAGES_A_LOOP: usize = 8;

/// A download under way.
#[derive(Debug, Clone, Copy)]
struct Sending {
    link: usize,
    id: u16,
    offset: u32,
    left: u32,
}

/// What goes out, and on which link.
#[derive(Debug, Clone)]
pub(in crate::sitl) enum Sent {
    Entry(usize, LOG_ENTRY_DATA),
    Data(usize, LOG_DATA_DATA),
}

/// Sends logs.
#[derive(Debug)]
pub(in crate::sitl) struct LogSender {
    /// number of the oldest log: PX4 counts from 0, ArduPilot from 1
    first: u16,
    /// link, first and last number of entries that are still to be told
    listing: Option<(usize, u16, u16)>,
    sending: Option<Sending>,
}

impl LogSender {
    pub(in crate::sitl) fn new(is_px4: bool) -> Self {
        Self { first: u16::from(!is_px4), listing: None, sending: None }
    }

    /// LOG_REQUEST_LIST.
    pub(in crate::sitl) fn list(&mut self, link: usize, (start, end): (u16, u16)) {
        self.listing = Some((link, start, end));
    }

    /// LOG_REQUEST_DATA.
    pub(in crate::sitl) fn data(&mut self, link: usize, id: u16, offset: u32, count: u32) {
        self.sending = Some(Sending { link, id, offset, left: count });
    }

    /// LOG_REQUEST_END.
    pub(in crate::sitl) fn end(&mut self) {
        (self.listing, self.sending) = (None, None);
    }

    /// What goes out in this period of the main loop.
    pub(in crate::sitl) fn pursue(&mut self, store: &LogStore) -> Vec<Sent> {
        let mut out = Vec::new();
        if let Some((link, start, end)) = self.listing.take() {
            let count = u16::try_from(store.all().len()).unwrap_or(u16::MAX);
            let last = (self.first + count).saturating_sub(1);
            let base = LOG_ENTRY_DATA { num_logs: count, last_log_num: last, ..LOG_ENTRY_DATA::DEFAULT };
            if count == 0 {
                out.push(Sent::Entry(link, base.clone()));
            }
            for (id, log) in (self.first..).zip(store.all()).filter(|(id, _)| (start..=end).contains(id)) {
                let time_utc = u32::try_from(log.unix_s).unwrap_or(u32::MAX);
                out.push(Sent::Entry(
                    link,
                    LOG_ENTRY_DATA { id, time_utc, size: log.size(), ..base.clone() },
                ));
            }
        }
        for _ in 0..MESSAGES_A_LOOP {
            let Some(sending) = &mut self.sending else { break };
            let index = sending.id.checked_sub(self.first).map(usize::from);
            let bytes = index.and_then(|index| store.all().nth(index)).map_or(&[][..], |log| &log.bytes);
            let begin = usize::try_from(sending.offset).unwrap_or(usize::MAX);
            let rest = bytes.get(begin..).unwrap_or(&[]);
            let wanted = usize::try_from(sending.left).unwrap_or(usize::MAX).min(DATA_BYTES);
            let piece = &rest[..wanted.min(rest.len())];
            let mut data = [0; DATA_BYTES];
            data[..piece.len()].copy_from_slice(piece);
            // no more than 90
            let count = u8::try_from(piece.len()).unwrap_or(u8::MAX);
            out.push(Sent::Data(
                sending.link,
                LOG_DATA_DATA { ofs: sending.offset, id: sending.id, count, data },
            ));
            sending.offset += u32::from(count);
            sending.left = sending.left.saturating_sub(u32::from(count));
            if piece.len() < DATA_BYTES || sending.left == 0 {
                self.sending = None;
            }
        }
        out
    }
}
