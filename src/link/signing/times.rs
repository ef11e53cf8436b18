//! The times of signing, kept over restarts.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::sync::mpsc;
use std::thread::JoinHandle;

use super::clock::SECOND;
use super::error::SigningError;
use super::owner;
use crate::wire::{ComponentId, SystemId};

const TITLE: &str = "mavid signing times 1";
/// Time is kept ahead by this much, so that it need not be written with each frame: 10 s.
pub(super) const AHEAD: u64 = 10 * SECOND;
/// A signature has 48 bits for its time.
const LATEST: u64 = (1 << 48) - 1;

/// Who signs on which of its links.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct StreamKey {
    pub link: u8,
    pub system: SystemId,
    pub component: ComponentId,
}

/// Times in units of 10 microseconds since 2015-01-01 UTC.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(super) struct Times {
    /// the latest used or heard
    pub own: u64,
    /// the latest heard of each stream
    pub streams: BTreeMap<StreamKey, u64>,
}

/// Keeps times in a file, on a thread of its own: signing never waits for a disk.
#[derive(Debug)]
pub(super) struct TimesFile {
    to_thread: Option<mpsc::Sender<Times>>,
    thread: Option<JoinHandle<()>>,
}

impl TimesFile {
    /// Where the times of a key's file lie: beside the file itself, however many symbolic links lead to it.
    pub fn beside(key_file: &Path) -> Result<PathBuf, SigningError> {
        let real = key_file.canonicalize();
        let path =
            real.map_err(|source| SigningError::File { what: "read", path: key_file.into(), source })?;
        let mut name = path.into_os_string();
        name.push(".times");
        Ok(name.into())
    }

    /// The times of a file, those of now where there is none, and the means to keep them.
    pub fn open(path: PathBuf, now: u64) -> Result<(Times, Self), SigningError> {
        let failed = |what| {
            let path = path.clone();
            move |source| SigningError::File { what, path, source }
        };
        let mut times = match fs::read_to_string(&path) {
            Ok(text) => Times::parse(&path, &text)?,
            Err(error) if error.kind() == io::ErrorKind::NotFound => Times::default(),
            Err(error) => return Err(failed("read")(error)),
        };
        times.own = times.own.max(now);
        let ahead = Times { own: times.own + AHEAD, streams: times.streams.clone() };
        replace(&path, &ahead.text()).map_err(failed("write"))?;
        let (to_thread, orders) = mpsc::channel::<Times>();
        let at = path.clone();
        let thread = std::thread::Builder::new().name("signing times".into()).spawn(move || {
            while let Ok(mut times) = orders.recv() {
                // only the latest matters; a disk that fails is tried again with the next
                while let Ok(later) = orders.try_recv() {
                    times = later;
                }
                let _ = replace(&at, &times.text());
            }
        });
        let thread = thread.map_err(failed("write"))?;
        Ok((times, Self { to_thread: Some(to_thread), thread: Some(thread) }))
    }

    /// Keeps these times; does not wait.
    pub fn keep(&self, times: Times) {
        if let Some(to_thread) = &self.to_thread {
            let _ = to_thread.send(times);
        }
    }
}

impl Drop for TimesFile {
    fn drop(&mut self) {
        self.to_thread = None;
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

/// The file is whole at every moment, either the old or the new, and for its owner alone. Its new text has a name of its own until
/// then: two processes that share a key do not write into each other's.
fn replace(path: &Path, text: &str) -> io::Result<()> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut file = owner::temporary(folder)?;
    file.write_all(text.as_bytes())?;
    file.persist(path)?;
    Ok(())
}

impl Times {
    fn text(&self) -> String {
        let mut text = format!("{TITLE}\nown {}\n", self.own.min(LATEST));
        for (key, time) in &self.streams {
            // writing to a string does not fail
            let _ = writeln!(text, "stream {} {} {} {time}", key.link, key.system, key.component);
        }
        text
    }

    fn parse(path: &Path, text: &str) -> Result<Self, SigningError> {
        let wrong = |line: usize, expected| {
            let got = text.lines().nth(line).unwrap_or_default().into();
            SigningError::Times { path: path.into(), line: line + 1, expected, got }
        };
        let mut lines = text.lines();
        if lines.next() != Some(TITLE) {
            return Err(wrong(0, "`mavid signing times 1`"));
        }
        let own = lines.next().and_then(|line| line.strip_prefix("own ")).and_then(time);
        let mut times = Self { own: own.ok_or_else(|| wrong(1, "`own TIME`"))?, streams: BTreeMap::new() };
        for (index, line) in lines.enumerate() {
            let (key, time) =
                stream(line).ok_or_else(|| wrong(index + 2, "`stream LINK SYSTEM COMPONENT TIME`"))?;
            times.streams.insert(key, time);
        }
        Ok(times)
    }
}

/// A time that a signature can carry: a later one is damage, and would lock us out.
fn time(text: &str) -> Option<u64> {
    text.parse().ok().filter(|time| *time <= LATEST)
}

fn stream(line: &str) -> Option<(StreamKey, u64)> {
    let mut words = line.strip_prefix("stream ")?.split(' ');
    let key = StreamKey {
        link: words.next()?.parse().ok()?,
        system: SystemId(words.next()?.parse().ok()?),
        component: ComponentId(words.next()?.parse().ok()?),
    };
    let time = time(words.next()?)?;
    words.next().is_none().then_some((key, time))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_read_as_they_are_written() {
        let key = StreamKey { link: 3, system: SystemId(70_000), component: ComponentId(191) };
        let times = Times { own: 77, streams: BTreeMap::from([(key, 76)]) };
        assert_eq!(Times::parse(Path::new("k"), &times.text()).unwrap(), times);
        for (text, line) in [
            ("", 1),
            ("mavid signing times 1\nown x\n", 2),
            ("mavid signing times 1\nown 5\nstream 1 2 3\n", 3),
            ("mavid signing times 1\nown 5\nstream 1 2 300 4\n", 3),
            ("mavid signing times 1\nown 18446744073709551615\n", 2),
            ("mavid signing times 1\nown 5\nstream 1 2 3 281474976710656\n", 3),
        ] {
            let error = Times::parse(Path::new("k"), text).unwrap_err().to_string();
            assert!(error.contains(&format!("line {line} ")), "{error}");
        }
    }
}
