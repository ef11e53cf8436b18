//! Records on their way into the store: a record counts as written when the store has taken its last byte.

use std::collections::VecDeque;
use std::io::{self, Write};

use super::store::Store;

/// Handed to the store at a time.
const BATCH: usize = 1 << 16;

/// What a store has taken of the records given to it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Taken {
    /// whole records
    pub records: u64,
    /// their bytes
    pub bytes: u64,
}

/// Records that the store has not taken yet, in order. One of which it took a part continues where it stopped.
#[derive(Debug)]
pub(super) struct Backlog<S> {
    store: S,
    bytes: VecDeque<u8>,
    /// bytes of each record that are still to come; the first may have been taken in part
    left: VecDeque<(usize, usize)>,
    taken: Taken,
    /// records taken since the store was last synced
    unsynced: u64,
    /// records of which nobody knows whether they are on the disk
    doubtful: u64,
}

impl<S: Store> Backlog<S> {
    pub fn new(store: S) -> Self {
        Self {
            store,
            bytes: VecDeque::new(),
            left: VecDeque::new(),
            taken: Taken::default(),
            unsynced: 0,
            doubtful: 0,
        }
    }

    /// Records that the store has not taken.
    pub fn records(&self) -> u64 {
        self.left.len() as u64
    }

    /// Records whose way onto the disk the system did not confirm.
    pub fn doubtful(&self) -> u64 {
        self.doubtful
    }

    /// What the store took since this was last asked.
    pub fn take_taken(&mut self) -> Taken {
        std::mem::take(&mut self.taken)
    }

    /// Hands on what waits, where it is worth a write.
    pub fn drain_if_much(&mut self) -> io::Result<()> {
        if self.bytes.len() < BATCH { Ok(()) } else { self.drain() }
    }

    fn drain(&mut self) -> io::Result<()> {
        while !self.bytes.is_empty() {
            let (first, _) = self.bytes.as_slices();
            match self.store.write(&first[..first.len().min(BATCH)]) {
                Ok(0) => return Err(io::ErrorKind::WriteZero.into()),
                Ok(count) => self.went(count),
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => return Err(error),
            }
        }
        Ok(())
    }

    fn went(&mut self, count: usize) {
        self.bytes.drain(..count);
        let mut count = count;
        while let Some((whole, left)) = self.left.front_mut() {
            let of_it = count.min(*left);
            *left -= of_it;
            count -= of_it;
            if *left > 0 {
                return;
            }
            self.taken.records += 1;
            self.taken.bytes += *whole as u64;
            self.unsynced += 1;
            self.left.pop_front();
        }
    }
}

impl<S: Store> Write for Backlog<S> {
    /// One whole record; never waits for the store.
    fn write(&mut self, record: &[u8]) -> io::Result<usize> {
        self.bytes.extend(record);
        self.left.push_back((record.len(), record.len()));
        Ok(record.len())
    }

    /// Brings all of it onto the disk.
    fn flush(&mut self) -> io::Result<()> {
        self.drain()?;
        let synced = self.store.sync();
        let unsynced = std::mem::take(&mut self.unsynced);
        if synced.is_err() {
            // the system tells it once, and then holds the pages for clean
            self.doubtful += unsynced;
        }
        synced
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Takes so many bytes, and no more.
    struct Small {
        held: Vec<u8>,
        room: usize,
        syncs: bool,
    }

    impl Write for Small {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            let count = bytes.len().min(self.room - self.held.len());
            if count == 0 {
                return Err(io::ErrorKind::StorageFull.into());
            }
            self.held.extend_from_slice(&bytes[..count]);
            Ok(count)
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    impl Store for Small {
        fn sync(&mut self) -> io::Result<()> {
            if self.syncs { Ok(()) } else { Err(io::ErrorKind::Other.into()) }
        }
    }

    #[test]
    fn a_record_counts_when_its_last_byte_is_taken() {
        let mut backlog = Backlog::new(Small { held: Vec::new(), room: 25, syncs: true });
        for number in 0..4 {
            assert_eq!(backlog.write(&[number; 10]).unwrap(), 10);
        }
        assert_eq!(backlog.flush().unwrap_err().kind(), io::ErrorKind::StorageFull);
        assert_eq!(backlog.take_taken(), Taken { records: 2, bytes: 20 });
        assert_eq!((backlog.records(), backlog.store.held.len()), (2, 25));
        backlog.store.room = 100;
        backlog.flush().unwrap();
        assert_eq!(backlog.take_taken(), Taken { records: 2, bytes: 20 });
        let whole: Vec<u8> = (0..4).flat_map(|number| [number; 10]).collect();
        assert_eq!((backlog.store.held.clone(), backlog.records(), backlog.doubtful()), (whole, 0, 0));
    }

    #[test]
    fn what_the_system_does_not_confirm_is_doubtful_for_good() {
        let mut backlog = Backlog::new(Small { held: Vec::new(), room: 100, syncs: false });
        backlog.write_all(&[1; 10]).unwrap();
        backlog.flush().unwrap_err();
        backlog.store.syncs = true;
        backlog.write_all(&[2; 10]).unwrap();
        backlog.flush().unwrap();
        assert_eq!(backlog.doubtful(), 1);
    }
}
