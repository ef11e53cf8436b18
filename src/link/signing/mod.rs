//! MAVLink 2 message signing: <https://mavlink.io/en/guide/message_signing.html>.
//!
//! ```text
//! signature = first 48 bits of SHA-256(key + marker, header, payload, checksum + link id + time)
//! ```
//!
//! Time counts 10 microseconds since 2015-01-01 UTC and never repeats; it and the last time heard of each
//! stream are kept in a file beside the key's, so that neither a restart nor a clock set back lets an old
//! frame through, or locks us out.

mod key;
mod times;

use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use sha2::{Digest, Sha256};

use super::clock::utc_us;
use crate::log::{ComponentId, Frame, SystemId};
use crate::text;
pub use key::SigningKey;
use times::{StreamKey, Times, TimesFile};

/// 2015-01-01 UTC in microseconds since 1970.
const EPOCH_US: u64 = 1_420_070_400_000_000;
/// A stream not heard before may be this much behind: a minute.
const STALE: u64 = 60 * 100_000;
/// Time is kept ahead by this much, so that it need not be written with each frame: 10 s.
const AHEAD: u64 = 10 * 100_000;
/// Streams told apart; further ones are refused.
const STREAMS: usize = 1024;
/// Link id, time, signature.
pub(crate) const TAIL_BYTES: usize = 13;
const SIGNATURE_BYTES: usize = 6;
/// A radio's own report, which no radio signs.
const RADIO_STATUS: u32 = 109;

/// Why signing cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum SigningError {
    /// a file cannot be read or written
    #[error("cannot {what} {}: {source}", text::path(&path))]
    File {
        /// read or write
        what: &'static str,
        /// which file
        path: PathBuf,
        /// what the system said
        source: std::io::Error,
    },
    /// the key file holds no key
    #[error("expected a key (32 bytes, 64 hexadecimal digits, or a passphrase) in {}, got {got}", text::path(&path))]
    Key {
        /// which file
        path: PathBuf,
        /// what is in it, without telling it
        got: &'static str,
    },
    /// the file of times is damaged
    #[error(
        "expected {expected} in line {line} of {}, got `{got}`: without the times, old frames could be played \
         back; delete the file to accept that",
        text::path(&path)
    )]
    Times {
        /// which file
        path: PathBuf,
        /// counted from 1
        line: usize,
        /// what should be there
        expected: &'static str,
        /// what is there
        got: String,
    },
}

/// Why a frame is not believed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Distrust {
    /// it carries no signature
    Unsigned,
    /// its signature was not made with our key
    Wrong,
    /// its time was heard already, or is too far in the past
    Replayed,
}

/// Signs what a link sends and checks what it receives. Clones share key and times: links of one process
/// must, each with an id of its own ([`for_link`](Self::for_link)).
#[derive(Debug, Clone)]
pub struct Signing {
    shared: Arc<Shared>,
    link_id: u8,
}

#[derive(Debug)]
struct Shared {
    key: SigningKey,
    state: Mutex<State>,
}

#[derive(Debug)]
struct State {
    times: Times,
    /// written to the file: no own time beyond it is used before it is moved
    kept: u64,
    file: Option<TimesFile>,
}

impl Signing {
    /// Signing with the key of a file; its times are kept beside it, in `FILE.times`.
    ///
    /// # Errors
    /// The key or the times cannot be read, or the times cannot be written.
    pub fn open(key_file: &Path) -> Result<Self, SigningError> {
        let key = SigningKey::read(key_file)?;
        let mut name = key_file.as_os_str().to_owned();
        name.push(".times");
        let (times, file) = TimesFile::open(name.into(), now())?;
        Ok(Self::new(key, times, Some(file)))
    }

    /// Signing with a key alone; times are not kept over a restart.
    #[must_use]
    pub fn with_key(key: SigningKey) -> Self {
        Self::new(key, Times { own: now(), ..Times::default() }, None)
    }

    /// The same, begun at a time of the caller's clock: for whoever has no other ([`time_of`]).
    #[must_use]
    pub(crate) fn with_key_at(key: SigningKey, time: u64) -> Self {
        Self::new(key, Times { own: time, ..Times::default() }, None)
    }

    fn new(key: SigningKey, times: Times, file: Option<TimesFile>) -> Self {
        let state = State { kept: times.own, times, file };
        Self { shared: Arc::new(Shared { key, state: Mutex::new(state) }), link_id: 0 }
    }

    /// The same key and times for another link.
    #[must_use]
    pub fn for_link(&self, link_id: u8) -> Self {
        Self { link_id, ..self.clone() }
    }

    /// Fills in the tail of a frame that was serialised for signing.
    pub(super) fn sign(&self, frame: &mut [u8]) {
        self.sign_at(frame, now());
    }

    /// The same at a time of the caller's clock.
    pub(crate) fn sign_at(&self, frame: &mut [u8], now: u64) {
        let Some(at) = frame.len().checked_sub(TAIL_BYTES) else { return };
        let time = self.state().next(now);
        frame[at] = self.link_id;
        frame[at + 1..at + 7].copy_from_slice(&time.to_le_bytes()[..6]);
        let signature = self.shared.key.signature(&frame[..at + 7]);
        frame[at + 7..].copy_from_slice(&signature);
    }

    /// Whether a frame is to be believed.
    ///
    /// # Errors
    /// It is not, and why.
    pub(super) fn verify(&self, frame: &Frame<'_>) -> Result<(), Distrust> {
        self.verify_at(frame, now())
    }

    /// The same at a time of the caller's clock.
    pub(crate) fn verify_at(&self, frame: &Frame<'_>, now: u64) -> Result<(), Distrust> {
        let header = frame.header();
        if !header.is_signed() {
            return if header.message_id == RADIO_STATUS { Ok(()) } else { Err(Distrust::Unsigned) };
        }
        let bytes = frame.bytes();
        let (signed, signature) = bytes.split_at(bytes.len() - SIGNATURE_BYTES);
        if !equal_in_constant_time(&self.shared.key.signature(signed), signature) {
            return Err(Distrust::Wrong);
        }
        let tail = &bytes[bytes.len() - TAIL_BYTES..];
        let time = tail[1..7].iter().rev().fold(0, |time, &byte| time << 8 | u64::from(byte));
        let stream = StreamKey { link: tail[0], system: header.system, component: header.component };
        self.state().hear(stream, time, now)
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.shared.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl State {
    fn next(&mut self, now: u64) -> u64 {
        self.times.own = now.max(self.times.own + 1);
        self.keep(now);
        self.times.own
    }

    fn hear(&mut self, stream: StreamKey, time: u64, now: u64) -> Result<(), Distrust> {
        self.times.own = now.max(self.times.own);
        let fresh = match self.times.streams.get(&stream) {
            Some(last) => time > *last,
            None => time + STALE >= self.times.own && self.times.streams.len() < STREAMS,
        };
        if !fresh {
            return Err(Distrust::Replayed);
        }
        self.times.streams.insert(stream, time);
        self.times.own = time.max(self.times.own);
        self.keep(now);
        Ok(())
    }

    fn keep(&mut self, now: u64) {
        if self.times.own < self.kept {
            return;
        }
        self.kept = self.times.own.max(now) + AHEAD;
        if let Some(file) = &self.file {
            file.keep(Times { own: self.kept, streams: self.times.streams.clone() });
        }
    }
}

impl Drop for State {
    /// The exact times, for a restart that is quick.
    fn drop(&mut self) {
        if let Some(file) = &self.file {
            file.keep(std::mem::take(&mut self.times));
        }
    }
}

/// How long it takes does not tell how much is right.
fn equal_in_constant_time(a: &[u8], b: &[u8]) -> bool {
    a.len() == b.len() && std::hint::black_box(a.iter().zip(b).fold(0, |differ, (a, b)| differ | a ^ b)) == 0
}

/// The signing time of the wall clock.
fn now() -> u64 {
    time_of(utc_us())
}

/// The signing time of microseconds since 1970 UTC.
pub(crate) fn time_of(utc_us: u64) -> u64 {
    utc_us.saturating_sub(EPOCH_US) / 10
}

impl SigningKey {
    fn signature(&self, signed: &[u8]) -> [u8; SIGNATURE_BYTES] {
        let digest = Sha256::new().chain_update(self.bytes()).chain_update(signed).finalize();
        std::array::from_fn(|index| digest[index])
    }
}

#[cfg(test)]
mod tests;
