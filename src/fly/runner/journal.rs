//! Files of a flight beside its recording: the log of events, one JSON object a line, and the vehicle's parameters.
//!
//! A separate thread writes, so that a slow or full disk delays nothing. Notes that find no room in its queue are left
//! out and counted. After a failure it tries again, because space may be freed on a full disk.

use std::fs::{File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{self, Receiver};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::Duration;

use tokio::sync::oneshot;
use tokio::time::timeout;

use super::event_layer::Subscription;
use super::feed::{Entry, Feed, State, locked};
use crate::files::write_whole;
use crate::text;

/// Notes that may wait for the disk: more than a flight usually has.
const WAITING: usize = 1024;
/// How long the end of a flight waits for the disk.
const PATIENCE: Duration = Duration::from_secs(3);

/// The log while it is written.
#[derive(Debug)]
pub(super) struct Journal {
    feed: Feed,
    /// by it the notes of the flight come
    subscription: Option<Subscription>,
    state: Arc<Mutex<State>>,
    over: oneshot::Receiver<()>,
}

impl Journal {
    /// A log of the notes of a flight: appends to a file, or creates a new one.
    pub(super) fn create(path: &Path, subscription: Subscription) -> io::Result<Self> {
        let file: File = OpenOptions::new().create(true).append(true).open(path)?;
        Ok(Self::to_store(file)?.of(subscription))
    }

    fn of(self, subscription: Subscription) -> Self {
        subscription.begin(self.feed.clone());
        Self { subscription: Some(subscription), ..self }
    }

    fn to_store(store: impl Write + Send + 'static) -> io::Result<Self> {
        let (to, from) = mpsc::sync_channel(WAITING);
        let state = Arc::new(Mutex::new(State::default()));
        let (done, over) = oneshot::channel();
        let shared = state.clone();
        thread::Builder::new().name("events".into()).spawn(move || {
            work(store, &from, &shared);
            // whoever asked may have given up
            let _ = done.send(());
        })?;
        Ok(Self { feed: Feed::new(to, state.clone()), subscription: None, state, over })
    }

    /// Writes a file; does not wait for it.
    pub(super) fn keep(&self, path: PathBuf, text: String) {
        self.feed.keep(path, text);
    }

    /// A failure, reported once.
    pub(super) fn news(&self) -> Option<String> {
        let mut state = locked(&self.state);
        let trouble = state.trouble().filter(|_| !state.is_reported)?;
        state.is_reported = true;
        Some(trouble)
    }

    /// Waits until everything is written, or the disk accepts nothing more; returns what is missing.
    pub(super) async fn finish(self) -> Option<String> {
        // the thread ends with the last way to it
        drop((self.subscription, self.feed));
        let ended = timeout(PATIENCE, self.over).await;
        let trouble = locked(&self.state).trouble();
        match ended {
            Ok(Ok(())) => trouble,
            Ok(Err(_)) => Some("the writer of events panicked".to_owned()),
            Err(_) => {
                let told = format!(
                    "the last events are missing: the disk accepted nothing for {} s",
                    PATIENCE.as_secs()
                );
                Some(trouble.map_or(told.clone(), |trouble| format!("{told}; {trouble}")))
            }
        }
    }
}

fn work(mut store: impl Write, from: &Receiver<Entry>, state: &Mutex<State>) {
    // a line that was torn ends before the next begins
    let mut torn = false;
    for entry in from {
        let failure = match entry {
            Entry::Note(note) => {
                let written = text::json_line(&note).map_err(io::Error::from).and_then(|line| {
                    let begin = if torn { "\n" } else { "" };
                    let whole = store.write_all(format!("{begin}{line}\n").as_bytes());
                    torn = whole.is_err();
                    whole
                });
                written.err().map(|error| (1, error.to_string()))
            }
            Entry::File(path, text) => {
                let written = write_whole(&path, text.as_bytes());
                written.err().map(|error| (0, format!("{}: {error}", text::path(&path))))
            }
        };
        // both at once: whoever asks meanwhile is not told a line without its reason
        if let Some((lines, failure)) = failure {
            let mut state = locked(state);
            state.missing += lines;
            state.failure = Some(failure);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fly::outcome::{Level, Note};
    use crate::fly::runner::event_layer::{EVENTS_TARGET, emit, event_layer, flight_span};
    use std::sync::atomic::{AtomicUsize, Ordering};
    use tracing::Subscriber;
    use tracing::subscriber::with_default;
    use tracing_subscriber::filter::LevelFilter;
    use tracing_subscriber::layer::{Layer, SubscriberExt};

    fn note(text: &str) -> Note {
        Note::new(Duration::ZERO, Level::Information, "test", text)
    }

    /// A disk that takes so many bytes; with a gate it waits for a ticket each time.
    struct Disk {
        held: Arc<Mutex<Vec<u8>>>,
        room: Arc<AtomicUsize>,
        gate: Option<Receiver<()>>,
    }

    impl Write for Disk {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            if let Some(gate) = &self.gate {
                let _ = gate.recv();
            }
            let count = bytes.len().min(self.room.load(Ordering::SeqCst));
            if count == 0 {
                return Err(io::Error::new(io::ErrorKind::StorageFull, "the disk is full"));
            }
            self.room.fetch_sub(count, Ordering::SeqCst);
            self.held.lock().unwrap().extend_from_slice(&bytes[..count]);
            Ok(count)
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    /// As the program's, with log lines that nobody asked for.
    fn subscriber() -> impl Subscriber + Send + Sync {
        let lines = tracing_subscriber::fmt::layer().with_writer(io::sink).with_filter(LevelFilter::OFF);
        tracing_subscriber::registry().with(event_layer()).with(lines)
    }

    /// Hands on each piece that is written.
    struct Pieces(mpsc::Sender<String>);

    impl Write for Pieces {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            self.0.send(String::from_utf8(bytes.to_vec()).unwrap()).unwrap();
            Ok(bytes.len())
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    fn journal_of(span: &tracing::Span) -> (Journal, Receiver<String>) {
        let (to, written) = mpsc::channel();
        let journal = Journal::to_store(Pieces(to)).unwrap().of(Subscription::to(span).unwrap());
        (journal, written)
    }

    #[test]
    fn a_note_that_is_said_is_written_at_once_and_as_it_is() {
        with_default(subscriber(), || {
            let span = flight_span(&"udpin:127.0.0.1:14550", "X500");
            let (_journal, written) = journal_of(&span);
            let foreign = "x\u{1b}[31m\n\u{202e} \"quoted\" {0} \u{20ac}";
            for (microseconds, level, text) in [
                (0, Level::Information, "over"),
                (123_456_789_012_345, Level::Warning, foreign),
                (1, Level::Error, ""),
            ] {
                let note = Note::new(Duration::from_micros(microseconds), level, "test", text);
                span.in_scope(|| emit(&note));
                // what waits for nothing further is lost by no kill
                let line = written.recv_timeout(Duration::from_secs(60)).unwrap();
                assert_eq!(line, format!("{}\n", text::json_line(&note).unwrap()));
            }
            // what is said elsewhere is no event of this flight
            emit(&note("elsewhere"));
            span.in_scope(|| tracing::error!(time_s = 1.0, kind = "test", "of another target"));
            span.in_scope(|| emit(&note("last")));
            assert!(written.recv_timeout(Duration::from_secs(60)).unwrap().contains("last"));
        });
    }

    #[test]
    fn each_flight_has_its_own_log_until_it_ends() {
        with_default(subscriber(), || {
            let (one, two) = (flight_span(&"pty:one", "X500"), flight_span(&"pty:two", "X500"));
            let ((first, lines_one), (second, lines_two)) = (journal_of(&one), journal_of(&two));
            let within = one.in_scope(|| tracing::info_span!(target: EVENTS_TARGET, "part"));
            within.in_scope(|| emit(&note("of the first")));
            two.in_scope(|| emit(&note("of the second")));
            drop(first);
            one.in_scope(|| emit(&note("too late")));
            let said = |lines: Receiver<String>| lines.iter().collect::<Vec<_>>();
            drop(second);
            let (one, two) = (said(lines_one), said(lines_two));
            assert!(one.len() == 1 && one[0].contains("of the first"), "{one:?}");
            assert!(two.len() == 1 && two[0].contains("of the second"), "{two:?}");
        });
    }

    #[test]
    fn without_its_layer_no_log_begins() {
        assert!(Subscription::to(&flight_span(&"pty:one", "X500")).is_none());
        with_default(tracing_subscriber::registry(), || {
            assert!(Subscription::to(&flight_span(&"pty:one", "X500")).is_none());
        });
    }

    #[tokio::test]
    async fn a_full_disk_costs_lines_and_is_told_once_and_at_the_end() {
        let (held, room) = (Arc::new(Mutex::new(Vec::new())), Arc::new(AtomicUsize::new(100)));
        let disk = Disk { held: held.clone(), room: room.clone(), gate: None };
        let journal = Journal::to_store(disk).unwrap();
        for number in 0..5 {
            journal.feed.write(note(&format!("before {number}")));
        }
        let told = loop {
            match journal.news() {
                Some(told) => break told,
                None => tokio::task::yield_now().await,
            }
        };
        assert!(told.contains("missing: the disk is full"), "{told}");
        assert_eq!(journal.news(), None);
        // the thread may still be at the lines before
        while locked(&journal.state).missing < 4 {
            tokio::task::yield_now().await;
        }
        room.store(10_000, Ordering::SeqCst);
        journal.feed.write(note("after"));
        let end = journal.finish().await.unwrap();
        assert!(end.starts_with("4 lines of events are missing"), "{end}");
        let text = String::from_utf8(held.lock().unwrap().clone()).unwrap();
        let whole: Vec<&str> =
            text.lines().filter(|line| serde_json::from_str::<serde_json::Value>(line).is_ok()).collect();
        assert!(whole.len() == 2 && whole[1].contains("after"), "{text}");
    }

    #[tokio::test(start_paused = true)]
    async fn a_disk_that_stands_still_is_not_waited_for() {
        let (ticket, gate) = mpsc::channel();
        let room = Arc::new(AtomicUsize::new(usize::MAX));
        let held = Arc::new(Mutex::new(Vec::new()));
        let _default = tracing::subscriber::set_default(subscriber());
        let span = flight_span(&"udpin:127.0.0.1:14550", "X500");
        let journal = Journal::to_store(Disk { held: held.clone(), room, gate: Some(gate) })
            .unwrap()
            .of(Subscription::to(&span).unwrap());
        // who says it waits for nothing: neither for the disk nor for room in the queue
        for number in 0..2000 {
            span.in_scope(|| emit(&note(&format!("{number}"))));
        }
        let told = journal.news().unwrap();
        assert!(told.contains("missing: the disk is too slow"), "{told}");
        let end = journal.finish().await.unwrap();
        assert!(end.contains("the disk accepted nothing for 3 s"), "{end}");
        drop(ticket);
    }
}
