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
mod owner;
mod times;
mod told;

use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use sha2::{Digest, Sha256};

use super::clock::utc_us;
use crate::log::{ComponentId, Frame, SystemId, Version};
use crate::text;
pub use key::SigningKey;
use times::{StreamKey, Times, TimesFile};
pub(super) use told::Told;

/// 2015-01-01 UTC in microseconds since 1970.
const EPOCH_US: u64 = 1_420_070_400_000_000;
/// Signing times of a second.
const SECOND: u64 = 100_000;
/// A stream not heard before may be this much behind: a minute.
const STALE: u64 = 60 * SECOND;
/// Time is kept ahead by this much, so that it need not be written with each frame: 10 s.
const AHEAD: u64 = 10 * SECOND;
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
    /// it is MAVLink 1, which has no signatures
    Downgraded,
    /// its signature was not made with our key
    Wrong,
    /// its time was heard already
    Replayed,
    /// the first of its stream, and signed too far in the past
    Old {
        /// s behind our signing time
        behind_s: u64,
    },
}

impl fmt::Display for Distrust {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unsigned => f.write_str(
                "it does not sign; set the key up on the vehicle (over USB), or leave out --signing-key-file",
            ),
            Self::Downgraded => f.write_str(
                "it speaks MAVLink 1, which cannot be signed; set its port to MAVLink 2 (PX4: MAV_PROTO_VER, ArduPilot: \
                 SERIALn_PROTOCOL)",
            ),
            Self::Wrong => f.write_str(
                "it signs with another key; expected the vehicle's key in the file of --signing-key-file, or set this \
                 one up on the vehicle",
            ),
            Self::Replayed => f.write_str(
                "it sends what was heard before: somebody plays messages back, or the vehicle's signing time stands still",
            ),
            Self::Old { behind_s } => write!(
                f,
                "it signs {behind_s} s in the past, expected at most 60 s; set the clock of the vehicle (by GPS or \
                 SYSTEM_TIME) or of this computer",
            ),
        }
    }
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
    /// what was odd about the files
    warnings: Vec<String>,
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
        let mut warnings = Vec::from_iter(owner::exposure(key_file));
        let mut name = key_file.as_os_str().to_owned();
        name.push(".times");
        let now = now();
        let (times, file) = TimesFile::open(name.into(), now)?;
        warnings.extend(clock_warning(times.own.saturating_sub(now)));
        Ok(Self::new(key, times, Some(file), warnings))
    }

    /// What was odd about the files when they were opened, in words: a key that others may read or write, a clock that
    /// was set back.
    #[must_use]
    pub fn warnings(&self) -> &[String] {
        &self.shared.warnings
    }

    /// Signing with a key alone; times are not kept over a restart.
    #[must_use]
    pub fn with_key(key: SigningKey) -> Self {
        Self::new(key, Times { own: now(), ..Times::default() }, None, Vec::new())
    }

    /// The same, begun at a time of the caller's clock: for whoever has no other.
    #[must_use]
    pub fn with_key_at(key: SigningKey, time: u64) -> Self {
        Self::new(key, Times { own: time, ..Times::default() }, None, Vec::new())
    }

    fn new(key: SigningKey, times: Times, file: Option<TimesFile>, warnings: Vec<String>) -> Self {
        let state = State { kept: times.own, times, file };
        Self { shared: Arc::new(Shared { key, warnings, state: Mutex::new(state) }), link_id: 0 }
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
    pub fn sign_at(&self, frame: &mut [u8], now: u64) {
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
    pub fn verify_at(&self, frame: &Frame<'_>, now: u64) -> Result<(), Distrust> {
        let header = frame.header();
        if !header.is_signed() {
            return match header.version {
                _ if header.message_id == RADIO_STATUS => Ok(()),
                Version::V1 => Err(Distrust::Downgraded),
                Version::V2 => Err(Distrust::Unsigned),
            };
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

    /// By how much our signing time is ahead of this computer's clock, s: others sign ahead of it.
    pub(super) fn ahead_s(&self) -> u64 {
        self.state().times.own.saturating_sub(now()) / SECOND
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
        match self.times.streams.get(&stream) {
            Some(last) if time <= *last => return Err(Distrust::Replayed),
            None if time + STALE < self.times.own => {
                return Err(Distrust::Old { behind_s: (self.times.own - time) / SECOND });
            }
            None if self.times.streams.len() >= STREAMS => return Err(Distrust::Replayed),
            _ => {}
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

/// What to say where signing times are ahead of this computer's clock by so much.
fn clock_warning(ahead: u64) -> Option<String> {
    (ahead > STALE).then(|| {
        format!(
            "this computer's clock is {} s behind the last signing time: it was set back, or another's was ahead; \
             messages are signed from that time on, and the clock is to be set",
            ahead / SECOND
        )
    })
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
