//! The flight with who watches it: a drawn view, or lines.

use std::path::PathBuf;
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel, sync_channel};
use std::thread;
use std::time::Duration;

use mavid::fly::view::{KeyCommand, Keys, PlainLog, Screen, ViewModel, page_rows};
use mavid::fly::{self, Console, Record, Ride};
use ratatui::crossterm::{event, terminal};
use tokio::sync::mpsc::{UnboundedSender, unbounded_channel};

use super::typed::{KEYS, PageShown, read_keys};
use crate::commands::last_word::{PATIENCE, last_word};
use crate::commands::live::Work;
use crate::commands::standard_error::StandardError;
use crate::commands::{CommandError, output};

/// Pictures that may wait for a slow terminal.
const PICTURES: usize = 4;
/// How long the view waits for a key or a new picture.
const LOOK: Duration = Duration::from_millis(50);

/// What became of who watched a flight.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum View {
    /// it ended with the flight
    Ended,
    /// It stands still: its terminal takes nothing. Whatever else is said there is not waited for.
    Stuck,
}

/// The flight, watched by another thread: neither a slow terminal nor a key holds it up, and it is waited for
/// for [`PATIENCE`] after the flight.
pub fn fly_it(
    ride: Ride,
    work: &Work,
    watch: impl FnOnce(&Receiver<ViewModel>, &UnboundedSender<KeyCommand>) + Send + 'static,
) -> Result<(Record, View), CommandError> {
    let failed = |error: &dyn std::fmt::Display| CommandError::Failure(error.to_string());
    // the link's tasks carry the setpoints
    let runtime = tokio::runtime::Builder::new_multi_thread()
        .enable_all()
        .on_thread_start(|| {
            // the thread of setpoints says where this is refused
            let _ = fly::raise_priority();
        })
        .build()
        .map_err(|error| failed(&error))?;
    let (show, pictures) = sync_channel(PICTURES);
    let (pressed, keys) = unbounded_channel();
    let (watches, ended) = channel::<()>();
    let viewer = thread::Builder::new().name("view".into()).spawn(move || {
        watch(&pictures, &pressed);
        drop(watches);
    });
    viewer.map_err(|error| failed(&error))?;
    work.flies();
    let record = runtime.block_on(fly::run(ride, Console { view: show, keys }));
    work.ends_itself();
    // its pictures have ended with the flight
    let view = match ended.recv_timeout(PATIENCE) {
        Err(RecvTimeoutError::Timeout) => {
            // its keys would continue without an echo; nothing else can be done for a terminal that takes nothing
            last_word(|| drop(terminal::disable_raw_mode()));
            View::Stuck
        }
        _ => View::Ended,
    };
    record.map(|record| (record, view)).map_err(|error| failed(&error))
}

/// How a flight is watched.
#[derive(Debug, Clone)]
pub struct Watch {
    /// by a drawn view on this, and not by lines
    pub drawn: Option<StandardError>,
    /// where messages and log lines go meanwhile: they would tear the view
    pub log: PathBuf,
    /// lines of standard input are keys
    pub typed: bool,
    /// there is a page to read and a word to type before it is armed
    pub has_page: bool,
}

/// Watches until the flight is over.
pub fn watch(how: &Watch, pictures: &Receiver<ViewModel>, pressed: &UnboundedSender<KeyCommand>) {
    match &how.drawn {
        Some(stderr) => draw(stderr, how, pictures, pressed),
        None => tell((how.typed, how.has_page), pictures, pressed),
    }
}

/// Lines; and lines of standard input as keys, where they may be.
fn tell(
    (typed, has_page): (bool, bool),
    pictures: &Receiver<ViewModel>,
    pressed: &UnboundedSender<KeyCommand>,
) {
    let shown = PageShown::new(has_page);
    if typed {
        let (pressed, shown) = (pressed.clone(), shown.clone());
        // it ends soon after the flight
        let reading = thread::Builder::new().name("keys".into()).spawn(move || read_keys(&pressed, &shown));
        match reading {
            Ok(_) => output::message(KEYS),
            Err(_) => output::warning("standard input cannot be read: Ctrl-C alone ends the flight"),
        }
    }
    let columns = terminal::size().map_or(0, |(columns, _)| usize::from(columns));
    let mut log = PlainLog::of_width(columns).before_a_page(true);
    for model in pictures {
        for line in log.lines(&model) {
            output::message(&line);
        }
        // only where all of the lines above were taken
        if model.awaits_word {
            shown.set();
        }
    }
}

/// The terminal view; lines where the terminal cannot be drawn on.
fn draw(
    stderr: &StandardError,
    how: &Watch,
    pictures: &Receiver<ViewModel>,
    pressed: &UnboundedSender<KeyCommand>,
) {
    let away = stderr.away(how.log.clone());
    let Ok(mut screen) = Screen::open(std::io::stderr) else {
        drop(away);
        return tell((true, how.has_page), pictures, pressed);
    };
    let mut keys = Keys::before(how.has_page);
    // what was typed before there was a view is for nothing in it
    take_keys(pressed, Keys::press_early);
    loop {
        take_keys(pressed, |key| keys.press(key));
        match pictures.recv_timeout(LOOK) {
            Ok(mut model) => {
                let is_asked_now = keys.ask(model.awaits_word);
                if let (true, Some(page), Ok((columns, rows))) =
                    (model.awaits_word, &model.page, terminal::size())
                {
                    keys.page(page.lines(usize::from(columns)).len(), page_rows(rows));
                    model.page_from = keys.from();
                }
                model.keys_wait = keys.wait();
                model.typed = keys.typed().map(str::to_owned);
                model.refused = keys.refused().map(str::to_owned);
                if screen.draw(&model).is_err() {
                    // lines and Ctrl-C need the terminal as it was
                    drop((screen, away));
                    return tell((true, how.has_page), pictures, pressed);
                }
                if is_asked_now {
                    take_keys(pressed, Keys::press_early);
                }
            }
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => return,
        }
    }
}

/// Takes the keys that were pressed until now.
fn take_keys(
    pressed: &UnboundedSender<KeyCommand>,
    mut press: impl FnMut(event::KeyEvent) -> Option<KeyCommand>,
) {
    while event::poll(Duration::ZERO).unwrap_or(false) {
        if let Ok(event::Event::Key(key)) = event::read()
            && let Some(command) = press(key)
        {
            // a flight that is over takes no keys
            let _ = pressed.send(command);
        }
    }
}
