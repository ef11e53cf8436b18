//! What of a file has come: everything up to a place, and pieces after it.

use std::collections::BTreeMap;

/// Pieces further than this behind the first missing byte are not kept: memory is bounded.
const AHEAD: u64 = 1 << 20;
/// Pieces that are kept at most.
const PIECES: usize = 1 << 14;

/// What of a file has come.
#[derive(Debug)]
pub(super) struct Window {
    size: u64,
    /// all before it has come
    begin: u64,
    /// all after it has not
    end: u64,
    pieces: BTreeMap<u64, Vec<u8>>,
    ready: Vec<u8>,
}

impl Window {
    /// Of a file of `size` bytes of which the first `begin` are there.
    pub(super) fn new(begin: u64, size: u64) -> Self {
        Self { size, begin, end: begin, pieces: BTreeMap::new(), ready: Vec::new() }
    }

    /// Bytes without a gap from the beginning.
    pub(super) fn begin(&self) -> u64 {
        self.begin
    }

    /// After the last byte that came.
    pub(super) fn end(&self) -> u64 {
        self.end
    }

    pub(super) fn size(&self) -> u64 {
        self.size
    }

    pub(super) fn is_whole(&self) -> bool {
        self.begin >= self.size
    }

    /// Takes a piece; whether something of it was missing.
    pub(super) fn take(&mut self, offset: u64, data: &[u8]) -> bool {
        let end = (offset + data.len() as u64).min(self.size);
        if end <= self.begin.max(offset) || offset > self.begin + AHEAD {
            return false;
        }
        let cut = |from: u64, to: u64| {
            let at = |place: u64| usize::try_from(place - offset).unwrap_or(usize::MAX);
            data.get(at(from)..at(to)).unwrap_or(&[])
        };
        self.end = self.end.max(end);
        if offset <= self.begin {
            self.ready.extend_from_slice(cut(self.begin, end));
            self.begin = end;
            self.join();
            return true;
        }
        let before = self.pieces.range(..=offset).next_back();
        let is_known = before.is_some_and(|(from, piece)| from + piece.len() as u64 >= end);
        if is_known || self.pieces.len() >= PIECES {
            return false;
        }
        self.pieces.insert(offset, cut(offset, end).to_vec());
        true
    }

    /// Pieces that the beginning has reached.
    fn join(&mut self) {
        while let Some(entry) = self.pieces.first_entry() {
            let from = *entry.key();
            if from > self.begin {
                return;
            }
            let piece = entry.remove();
            let known = usize::try_from(self.begin - from).unwrap_or(usize::MAX);
            if let Some(new) = piece.get(known..) {
                self.ready.extend_from_slice(new);
                self.begin += new.len() as u64;
            }
        }
    }

    /// What goes on where the bytes before ended.
    pub(super) fn ready(&mut self) -> Vec<u8> {
        std::mem::take(&mut self.ready)
    }

    /// What is missing before the last byte that came: from and to.
    pub(super) fn gaps(&self) -> Vec<(u64, u64)> {
        let (mut gaps, mut at) = (Vec::new(), self.begin);
        for (from, piece) in &self.pieces {
            if *from > at {
                gaps.push((at, *from));
            }
            at = at.max(from + piece.len() as u64);
        }
        gaps
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_in_any_order_twice_and_overlapping_make_the_file() {
        let file: Vec<u8> = (0..100).collect();
        let mut window = Window::new(10, 100);
        let take = |window: &mut Window, from: usize, to: usize| window.take(from as u64, &file[from..to]);
        assert!(take(&mut window, 30, 40) && take(&mut window, 50, 70) && !take(&mut window, 55, 60));
        assert!(!take(&mut window, 0, 10));
        assert_eq!((window.begin(), window.end()), (10, 70));
        assert_eq!(window.gaps(), [(10, 30), (40, 50)]);
        assert!(take(&mut window, 5, 35));
        assert_eq!(window.ready(), file[10..40]);
        assert!(take(&mut window, 38, 52) && take(&mut window, 65, 100));
        assert_eq!((window.ready(), window.is_whole()), (file[40..].to_vec(), true));
        assert_eq!(window.gaps(), []);
    }

    #[test]
    fn what_lies_behind_the_end_or_far_ahead_is_not_kept() {
        let mut window = Window::new(0, 1 << 40);
        assert!(!window.take(AHEAD + 1, &[1]) && !window.take(u64::from(u32::MAX), &[1; 200]));
        let mut small = Window::new(0, 3);
        assert!(!small.take(3, &[9]) && small.take(0, &[1, 2, 3, 4, 5]));
        assert_eq!((small.ready(), small.end()), (vec![1, 2, 3], 3));
    }
}
