//! The view after the landing, on a thread of its own: neither a slow terminal nor a key holds the analysis up.

use std::path::PathBuf;
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use mavid::fly::view::{LandedView, Screen, StageView};
use mavid::note::Note;
use mavid::study::{Progress, Stage};
use ratatui::crossterm::event::{self, KeyCode, KeyEventKind, KeyModifiers};

use super::watch::View;
use crate::commands::last_word::PATIENCE;
use crate::commands::standard_error::StandardError;

/// Between two pictures.
const LOOK: Duration = Duration::from_millis(100);

/// What both threads know.
#[derive(Debug)]
struct Shared {
    view: LandedView,
    /// since when the last stage goes on
    since: Instant,
    over: bool,
}

/// The view after the landing. It is taken away when this is dropped.
#[derive(Debug)]
pub struct Landed {
    shared: Arc<Mutex<Shared>>,
    /// hears of each picture that the terminal took
    pictures: Mutex<Receiver<()>>,
}

impl Landed {
    /// Takes the terminal over; messages go to the end of a file meanwhile. `None` where it cannot be drawn on.
    pub fn open(stderr: &StandardError, log: PathBuf, (title, flown): (String, Vec<String>)) -> Option<Self> {
        let view = LandedView { title, flown, ..LandedView::default() };
        let shared = Arc::new(Mutex::new(Shared { view, since: Instant::now(), over: false }));
        let (drawn, pictures) = channel();
        let (seen, stderr) = (shared.clone(), stderr.clone());
        let work = move || {
            let away = stderr.away(log);
            let mut next = Next::Ends;
            if let Ok(mut screen) = Screen::open(std::io::stderr) {
                next = draw(&mut screen, &seen);
                while next == Next::Draws && drawn.send(()).is_ok() {
                    next = draw(&mut screen, &seen);
                }
            }
            drop(away);
            if next == Next::Interrupts {
                interrupt();
            }
        };
        thread::Builder::new().name("landed".into()).spawn(work).ok()?;
        Some(Self { shared, pictures: Mutex::new(pictures) })
    }

    fn shared(&self) -> MutexGuard<'_, Shared> {
        locked(&self.shared)
    }

    /// Waits for a picture that is drawn from now on.
    fn picture(&self) -> Result<(), RecvTimeoutError> {
        let pictures = self.pictures.lock().unwrap_or_else(PoisonError::into_inner);
        pictures.try_iter().for_each(drop);
        pictures.recv_timeout(PATIENCE)
    }

    /// Whether the view has ended, or still stands where the terminal takes nothing; `None` while it is drawn.
    fn ended(&self) -> Option<View> {
        match self.picture() {
            Ok(()) => None,
            Err(RecvTimeoutError::Disconnected) => Some(View::Ended),
            Err(RecvTimeoutError::Timeout) => Some(View::Stuck),
        }
    }

    /// Shows the answer, and leaves: at once, or when a person has seen it and goes on. A terminal that takes nothing is not
    /// waited for.
    pub fn answered(self, answer: String, stays: bool) -> View {
        {
            let mut shared = self.shared();
            (shared.view.answer, shared.view.stays) = (Some(answer), stays);
        }
        // the picture that was being drawn, and the one with the answer
        for _ in 0..2 {
            if let Some(ended) = self.ended() {
                return ended;
            }
        }
        self.shared().over = !stays;
        loop {
            if let Some(ended) = self.ended() {
                return ended;
            }
        }
    }
}

impl Drop for Landed {
    fn drop(&mut self) {
        self.shared().over = true;
        // gives the terminal back before anything else is said, unless it takes nothing
        while self.ended().is_none() {}
    }
}

impl Progress for Landed {
    fn stage(&self, stage: Stage) {
        let mut shared = self.shared();
        shared.ends_stage();
        shared.view.stages.push(StageView {
            name: stage.to_string(),
            counted: stage.counted(),
            ..StageView::default()
        });
    }

    fn steps(&self, count: u64) {
        if let Some(stage) = self.shared().view.stages.last_mut() {
            stage.steps = Some((0, count));
        }
    }

    fn step(&self) {
        if let Some((done, _)) = self.shared().view.stages.last_mut().and_then(|stage| stage.steps.as_mut()) {
            *done += 1;
        }
    }

    fn about(&self, done: u64, of: u64) {
        if let Some(stage) = self.shared().view.stages.last_mut() {
            (stage.steps, stage.is_estimate) = (Some((done, of)), true);
        }
    }

    fn note(&self, note: &Note) {
        self.shared().view.notes.push(note.sentence());
    }
}

impl Shared {
    /// The last stage has taken so long.
    fn ends_stage(&mut self) {
        self.tells_time();
        self.ends_estimate();
        self.since = Instant::now();
    }

    fn tells_time(&mut self) {
        let elapsed_s = self.since.elapsed().as_secs_f64();
        if let Some(stage) = self.view.stages.last_mut() {
            stage.elapsed_s = elapsed_s;
        }
    }

    /// An estimate of what was to come is over with its stage.
    fn ends_estimate(&mut self) {
        if let Some(stage) = self.view.stages.last_mut().filter(|stage| stage.is_estimate) {
            stage.steps = None;
        }
    }
}

fn locked(shared: &Mutex<Shared>) -> MutexGuard<'_, Shared> {
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}

/// What follows a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Next {
    Draws,
    Ends,
    /// Ctrl-C: in a terminal whose keys are read one by one it is no signal by itself
    Interrupts,
}

/// One picture, and the keys until the next one.
fn draw(screen: &mut Screen<std::io::Stderr>, shared: &Mutex<Shared>) -> Next {
    let view = {
        let mut shared = locked(shared);
        if shared.over {
            return Next::Ends;
        }
        if shared.view.answer.is_none() {
            shared.tells_time();
        }
        shared.view.clone()
    };
    if screen.draw_landed(&view).is_err() {
        return Next::Ends;
    }
    let until = Instant::now() + LOOK;
    while let Ok(true) = event::poll(until.saturating_duration_since(Instant::now())) {
        let Ok(event::Event::Key(key)) = event::read() else { continue };
        let is_interrupt = key.code == KeyCode::Char('c') && key.modifiers.contains(KeyModifiers::CONTROL);
        match (key.kind, key.code, &view.answer) {
            (KeyEventKind::Release, ..) => {}
            (.., None) if is_interrupt => return Next::Interrupts,
            (.., Some(_)) if is_interrupt => return Next::Ends,
            (_, KeyCode::Enter | KeyCode::Esc | KeyCode::Char(' ' | 'q'), Some(_)) => return Next::Ends,
            _ => {}
        }
    }
    Next::Draws
}

/// As Ctrl-C does it elsewhere.
#[cfg(unix)]
fn interrupt() {
    use rustix::process::{Signal, getpid, kill_process};
    // the program hears its own signals
    let _ = kill_process(getpid(), Signal::INT);
}

/// The next Ctrl-C ends the program: its terminal is as it was.
#[cfg(not(unix))]
fn interrupt() {}
