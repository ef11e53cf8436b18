//! A file's bytes from a place on, with a stretch of what follows in sight; memory does not grow with the file.

use std::io::{ErrorKind, Read};

use super::error::LogError;

/// Reads so much at once, and holds as much beyond what is asked for.
const CHUNK_BYTES: usize = 1 << 20;

/// A file's bytes from a place on.
#[derive(Debug)]
pub(super) struct LookAhead<R> {
    from: R,
    buffer: Vec<u8>,
    at: usize,
    filled: usize,
    ended: bool,
    base: u64,
    chunk_bytes: usize,
}

impl<R: Read> LookAhead<R> {
    /// At the first byte of `from`, which needs no buffering of its own.
    pub(super) fn new(from: R) -> Self {
        Self::with_chunk(from, CHUNK_BYTES)
    }

    /// The same, which reads so much at once.
    pub(super) fn with_chunk(from: R, chunk_bytes: usize) -> Self {
        Self { from, buffer: Vec::new(), at: 0, filled: 0, ended: false, base: 0, chunk_bytes }
    }

    /// Makes sure that `bytes` bytes are in sight, or all that are left.
    ///
    /// # Errors
    /// The reader beneath fails.
    pub(super) fn look(&mut self, bytes: usize) -> Result<(), LogError> {
        if self.ended || self.filled - self.at >= bytes {
            return Ok(());
        }
        self.buffer.copy_within(self.at..self.filled, 0);
        self.base += self.at as u64;
        self.filled -= self.at;
        self.at = 0;
        self.buffer.resize(self.buffer.len().max(bytes + self.chunk_bytes), 0);
        while self.filled < self.buffer.len() {
            match self.from.read(&mut self.buffer[self.filled..]) {
                Ok(0) => {
                    self.ended = true;
                    break;
                }
                Ok(read) => self.filled += read,
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(source) => {
                    return Err(LogError::Read { offset: self.base + self.filled as u64, source });
                }
            }
        }
        Ok(())
    }

    /// The bytes in sight.
    pub(super) fn sight(&self) -> &[u8] {
        &self.buffer[self.at..self.filled]
    }

    /// No bytes follow those in sight.
    pub(super) fn is_all(&self) -> bool {
        self.ended
    }

    /// Offset in the file of the first byte in sight.
    pub(super) fn offset(&self) -> u64 {
        self.base + self.at as u64
    }

    /// Goes on by `bytes` bytes, at most to the end of what is in sight.
    pub(super) fn skip(&mut self, bytes: usize) {
        self.at = (self.at + bytes).min(self.filled);
    }
}
