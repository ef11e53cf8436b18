//! Signs what a link sends and checks what it receives.

use std::collections::BTreeSet;
use std::path::Path;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::clock::{SECOND, STALE, clock_warning, now};
use super::distrust::Distrust;
use super::error::SigningError;
use super::key::SigningKey;
use super::owner;
use super::signature::{SIGNATURE_BYTES, TAIL_BYTES, equal_in_constant_time};
use super::times::{AHEAD, StreamKey, Times, TimesFile};
use crate::note::{About, Note};
use crate::wire::message_id::RADIO_STATUS;
use crate::wire::{Frame, Version};

/// Largest number of streams that are distinguished; further ones are refused.
const STREAMS: usize = 1024;

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
    warnings: Vec<Note>,
    state: Mutex<State>,
}

#[derive(Debug)]
struct State {
    times: Times,
    /// streams of which a frame was believed since this began
    heard: BTreeSet<StreamKey>,
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
        let at = TimesFile::beside(key_file)?;
        warnings.extend(owner::times_exposure(&at));
        let now = now();
        let (times, file) = TimesFile::open(at, now)?;
        warnings.extend(clock_warning(times.own.saturating_sub(now)));
        let warnings = warnings.into_iter().map(|text| Note::warning(About::Signing, text)).collect();
        Ok(Self::new(key, times, Some(file), warnings))
    }

    /// What was odd about the files when they were opened, in words: a key that others may read or write, a clock that
    /// was set back.
    #[must_use]
    pub fn warnings(&self) -> &[Note] {
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

    pub(super) fn new(key: SigningKey, times: Times, file: Option<TimesFile>, warnings: Vec<Note>) -> Self {
        let state = State { kept: times.own, times, heard: BTreeSet::new(), file };
        Self { shared: Arc::new(Shared { key, warnings, state: Mutex::new(state) }), link_id: 0 }
    }

    /// The same key and times for another link.
    #[must_use]
    pub fn for_link(&self, link_id: u8) -> Self {
        Self { link_id, ..self.clone() }
    }

    /// Fills in the tail of a frame that was serialised for signing.
    pub(in crate::link) fn sign(&self, frame: &mut [u8]) {
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
    pub(in crate::link) fn verify(&self, frame: &Frame<'_>) -> Result<(), Distrust> {
        self.verify_at(frame, now())
    }

    /// The same at a time of the caller's clock.
    pub fn verify_at(&self, frame: &Frame<'_>, now: u64) -> Result<(), Distrust> {
        let header = frame.header();
        if !header.is_signed() {
            return match header.version {
                // a radio's own report, which no radio signs
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
    pub(in crate::link) fn ahead_s(&self) -> u64 {
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
            // a stream that was heard in an earlier run is as new as any: frames signed since then may be played back
            _ if !self.heard.contains(&stream) && time + STALE < self.times.own => {
                return Err(Distrust::Old { behind_s: (self.times.own - time) / SECOND });
            }
            None if self.times.streams.len() >= STREAMS => return Err(Distrust::Replayed),
            _ => {}
        }
        self.heard.insert(stream);
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
