//! A reader that gives out no more than one row may have.

use std::io::{self, Read};

/// Bytes of one row, its line breaks inside quotes included. Real ones have some hundred.
pub(super) const ROW_BYTES_MAX: usize = 1 << 20;
/// Bytes that the CSV reader takes at a time, which may be of the next row.
pub(super) const BUFFER: usize = 1 << 16;

/// Hands bytes on until a row has had more than [`ROW_BYTES_MAX`].
#[derive(Debug)]
pub(super) struct Bounded<R> {
    from: R,
    left: usize,
    is_exceeded: bool,
}

impl<R> Bounded<R> {
    pub fn new(from: R) -> Self {
        Self { from, left: ROW_BYTES_MAX, is_exceeded: false }
    }

    /// A row is over; the next may have as much again, and what lies in the buffer is some of it.
    pub fn next_row(&mut self) {
        self.left = ROW_BYTES_MAX;
    }

    /// A row was longer than it may be.
    pub fn is_exceeded(&self) -> bool {
        self.is_exceeded
    }
}

impl<R: Read> Read for Bounded<R> {
    fn read(&mut self, to: &mut [u8]) -> io::Result<usize> {
        if self.left == 0 {
            self.is_exceeded = true;
            return Err(io::Error::new(io::ErrorKind::InvalidData, "a row is too long"));
        }
        let most = to.len().min(self.left);
        let count = self.from.read(&mut to[..most])?;
        self.left -= count;
        Ok(count)
    }
}
