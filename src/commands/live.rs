//! Verbs that continue until they are told to end: whatever stands still, they end.
//!
//! Such a verb catches the signals that ask for its end, so nothing else ends it: not where a pipe that nobody reads
//! holds up its last words, nor where it works out what was flown. Its work therefore runs on a thread of its own. Once
//! nothing in it must be waited for any more, a signal gives it a few seconds, and then the program ends without it.

use std::io::Write;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Arc, OnceLock};
use std::thread;
use std::time::{Duration, Instant};

use ratatui::crossterm::cursor::Show;
use ratatui::crossterm::execute;
use ratatui::crossterm::terminal::{self, LeaveAlternateScreen};
use tokio::sync::watch;

use super::last_word::{PATIENCE, last_word, within};
use super::{CommandError, NOT_ALL, Outcome, network, output};

/// From the signal, or from the end of what must be waited for, to that of the program.
const GRACE: Duration = Duration::from_secs(5);
/// The signal of somebody at the keyboard, as [`network::Signals`] names it.
const INTERRUPT: &str = "Ctrl-C";
/// Between two looks at the clock.
const LOOK: Duration = Duration::from_millis(50);

/// What a signal may do to a verb.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Phase {
    /// nothing has begun that it would end by itself
    Before,
    /// a vehicle depends on it
    Flying,
    /// it fetches what it can do without
    Fetching,
    /// it ends by itself, soon
    Ending,
    /// it works out what a flight says that is recorded; it ends by itself where that is soon
    Analysing,
    /// it asks a person, or works out what can be worked out again
    Between,
}

/// What is known of a verb.
#[derive(Debug, Clone, Copy)]
struct VerbState {
    phase: Phase,
    /// a signal has ended what it fetched
    fetch_ended: bool,
}

/// What a running verb tells those that watch over it. Clones tell the same.
#[derive(Debug, Clone)]
pub struct Work {
    state: Arc<watch::Sender<VerbState>>,
    again: Arc<OnceLock<String>>,
}

impl Work {
    fn enters(&self, phase: Phase) {
        self.state.send_modify(|told| told.phase = phase);
    }

    /// The command that continues it after a signal has ended it.
    pub fn continues_by(&self, command: String) {
        // the first is the one that was typed
        let _ = self.again.set(command);
    }

    /// A vehicle depends on it: it alone knows when it may end.
    pub fn flies(&self) {
        self.enters(Phase::Flying);
    }

    /// It asks a person, or works out what can be worked out again: a signal ends it at once.
    pub fn waits(&self) {
        self.enters(Phase::Between);
    }

    /// It fetches what it can do without, and hears of signals: the first Ctrl-C ends the download and not the program.
    pub fn fetches(&self) {
        self.enters(Phase::Fetching);
    }

    /// The download is over; whether a signal ended it. From now on it ends itself.
    pub fn fetched(&self, by_signal: bool) {
        self.state.send_replace(VerbState { phase: Phase::Ending, fetch_ended: by_signal });
    }

    /// It works out what a recorded flight says: a signal ends it, unless it is done soon after.
    pub fn analyses(&self) {
        self.enters(Phase::Analysing);
    }

    /// It hears of signals, or has ended what had to be; by an end soon after one nothing is lost but words and what can
    /// be worked out again.
    pub fn ends_itself(&self) {
        self.enters(Phase::Ending);
    }
}

/// What the signals that came ask for.
#[derive(Debug, Default)]
struct Signalled {
    /// the signal by which the program ends
    asked: Option<String>,
    /// one that ended a download alone has come
    spared: bool,
}

impl Signalled {
    /// A signal came. It may be heard of here only after the download has ended by it.
    fn hear(&mut self, name: String, told: VerbState) {
        let of_download = told.phase == Phase::Fetching || told.fetch_ended;
        if of_download && name == INTERRUPT && !self.spared && self.asked.is_none() {
            self.spared = true;
        } else {
            self.asked.get_or_insert(name);
        }
    }
}

/// Runs a verb on a thread of its own; it says itself how it failed.
pub fn run(
    verb: impl FnOnce(&Work) -> Result<Outcome, CommandError> + Send + 'static,
) -> Result<Outcome, CommandError> {
    panics_do_not_wait();
    let (sender, signalled) = channel();
    watch_signals(sender)?;
    let (told, phase) = watch::channel(VerbState { phase: Phase::Before, fetch_ended: false });
    let again = Arc::new(OnceLock::new());
    let work = Work { state: Arc::new(told), again: again.clone() };
    let (done, outcome) = channel();
    let thread = thread::Builder::new().name("verb".into()).spawn(move || {
        let ended = verb(&work).map_err(report_in_time);
        // whoever started it waits, or the program is over
        let _ = done.send(ended);
    });
    thread.map_err(|error| CommandError::Failure(format!("cannot start a thread: {error}")))?;
    let mut signals = Signalled::default();
    let mut since: Option<Instant> = None;
    loop {
        match outcome.recv_timeout(LOOK) {
            Ok(ended) => return ended,
            // it panicked, which was told
            Err(RecvTimeoutError::Disconnected) => return Err(CommandError::Reported(PANICKED)),
            Err(RecvTimeoutError::Timeout) => {}
        }
        if let Ok(name) = signalled.try_recv() {
            signals.hear(name, *phase.borrow());
        }
        let Some(name) = &signals.asked else { continue };
        let phase = phase.borrow().phase;
        let is_over = match phase {
            Phase::Before | Phase::Between => true,
            Phase::Flying => false,
            Phase::Fetching | Phase::Ending | Phase::Analysing => {
                since.get_or_insert_with(Instant::now).elapsed() >= GRACE
            }
        };
        if is_over {
            let (text, status) = last_words(phase, name, again.get().map(String::as_str));
            last_word(move || {
                leave_view();
                output::error(&text);
            });
            return Err(CommandError::Reported(status));
        }
    }
}

/// What is said of a verb that the program ends by this signal in this phase, and the exit status.
fn last_words(phase: Phase, name: &str, again: Option<&str>) -> (String, u8) {
    match phase {
        Phase::Before => (format!("mavid: ended by {name} before it began"), NOT_ALL),
        Phase::Between => {
            let again = again.map_or_else(
                || "run the same command again to continue".to_owned(),
                |again| format!("to continue: {again}"),
            );
            (format!("mavid: ended by {name}; {again}"), NOT_ALL)
        }
        Phase::Analysing => (
            format!(
                "mavid: ended by {name} while the flight was analysed; its recording is in its file, and mavid explain analyses it"
            ),
            NOT_ALL,
        ),
        // what it still had to say is lost
        Phase::Flying | Phase::Fetching | Phase::Ending => (
            format!(
                "mavid: ended {} s after {name}, before all output was written: standard output, standard error or a disk accepts \
                 no data; what was recorded is in its file",
                GRACE.as_secs()
            ),
            FAILED,
        ),
    }
}

/// A view that is shown gives the terminal back as it was.
fn leave_view() {
    if terminal::is_raw_mode_enabled().unwrap_or(false) {
        let raw = terminal::disable_raw_mode();
        let screen = execute!(std::io::stderr(), LeaveAlternateScreen, Show);
        drop(raw.and(screen));
    }
}

/// Exit status of a verb that failed, and of one that panicked.
const FAILED: u8 = 1;
const PANICKED: u8 = 101;

/// Tells each signal's name, on a runtime of its own.
fn watch_signals(signals: std::sync::mpsc::Sender<String>) -> Result<(), CommandError> {
    let failed = |error: std::io::Error| {
        CommandError::Failure(format!("cannot wait for signals to end the program: {error}"))
    };
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().map_err(failed)?;
    let mut ends = {
        let _within = runtime.enter();
        network::Signals::new()?
    };
    let work = move || {
        while let Ok(name) = runtime.block_on(ends.next()) {
            if signals.send(name.to_owned()).is_err() {
                return;
            }
        }
    };
    thread::Builder::new().name("signals".into()).spawn(work).map(|_| ()).map_err(failed)
}

/// Says how a verb failed, and waits no longer than [`PATIENCE`] for whoever hears it.
fn report_in_time(error: CommandError) -> CommandError {
    let status = error.status();
    let words = error.words();
    if !words.is_empty() {
        let _ = within(PATIENCE, move || words.iter().for_each(|line| output::error(line)));
    }
    CommandError::Reported(status)
}

/// A panic is told, but a terminal that takes nothing does not keep the panicking thread from ending: others still have
/// to tell the vehicle.
fn panics_do_not_wait() {
    std::panic::set_hook(Box::new(|panic| {
        let text = format!("mavid: a fault of this program: {panic}");
        last_word(move || {
            let _ = writeln!(std::io::stderr().lock(), "{text}");
        });
    }));
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What the program ends by after these signals, each with what was known of the verb when it was heard of.
    fn asked(signals: &[(&str, Phase, bool)]) -> Option<String> {
        let mut heard = Signalled::default();
        for (name, phase, fetch_ended) in signals {
            heard.hear((*name).to_owned(), VerbState { phase: *phase, fetch_ended: *fetch_ended });
        }
        heard.asked
    }

    #[test]
    fn what_a_signal_ends_is_not_all_done_and_what_cannot_be_told_is_a_failure() {
        for phase in [Phase::Before, Phase::Between, Phase::Analysing] {
            let (said, status) = last_words(phase, INTERRUPT, None);
            assert!(said.starts_with("mavid: ended by Ctrl-C") && status == NOT_ALL, "{said}: {status}");
        }
        let (said, status) = last_words(Phase::Ending, "SIGTERM", None);
        assert!(
            said.contains("5 s after SIGTERM, before all output was written") && status == FAILED,
            "{said}"
        );
        let (said, _) = last_words(Phase::Between, INTERRUPT, Some("mavid demo --out mavid-demo"));
        assert_eq!(said, "mavid: ended by Ctrl-C; to continue: mavid demo --out mavid-demo");
        let ended = CommandError::Ended("ended by Ctrl-C".to_owned());
        assert_eq!((ended.status(), CommandError::Failure(String::new()).status()), (NOT_ALL, FAILED));
    }

    #[test]
    fn the_first_interrupt_of_a_download_ends_it_and_the_second_the_program() {
        let interrupted = Some(INTERRUPT.to_owned());
        assert_eq!(asked(&[(INTERRUPT, Phase::Fetching, false)]), None);
        // heard of when the download had ended by it
        assert_eq!(asked(&[(INTERRUPT, Phase::Ending, true)]), None);
        for first in [(INTERRUPT, Phase::Fetching, false), (INTERRUPT, Phase::Ending, true)] {
            for second in [(INTERRUPT, Phase::Fetching, false), (INTERRUPT, Phase::Ending, true)] {
                assert_eq!(asked(&[first, second]), interrupted);
            }
        }
        // during the analysis of a flight whose download came to its end, and before any download
        assert_eq!(asked(&[(INTERRUPT, Phase::Ending, false)]), interrupted);
        assert_eq!(
            asked(&[(INTERRUPT, Phase::Flying, false), (INTERRUPT, Phase::Fetching, false)]),
            interrupted
        );
        // nobody at a keyboard asks for the analysis
        let terminated = Some("SIGTERM".to_owned());
        assert_eq!(asked(&[("SIGTERM", Phase::Fetching, false)]), terminated);
    }
}
