//! The flight on the terminal: a picture, or lines; and the keys that the operator presses.

use std::io::{BufRead, IsTerminal, Read};
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::thread;
use std::time::Duration;

use mavid::fly::view::{KeyCommand, Keys, PlainLog, Screen, ViewModel, page_rows};
use ratatui::crossterm::{event, terminal};
use tokio::sync::mpsc::UnboundedSender;

use super::output;
use super::standard_error::StandardError;

/// The keys of a flight told in lines.
const KEYS: &str =
    "h, l, r and return: hold, land, return home; :kill and return: motors off; Ctrl-C: hold and end";
/// Bytes of a line of them: no one types more.
const LINE_MAX: u64 = 256;
/// How long the view waits for a key or a new picture.
const LOOK: Duration = Duration::from_millis(50);

/// Lines; and lines of standard input as keys, where they may be.
pub fn tell(pictures: &Receiver<ViewModel>, pressed: Option<&UnboundedSender<KeyCommand>>) {
    if let Some(pressed) = pressed.cloned() {
        // it ends with the process: nothing else can be done about a read that waits
        let reading = thread::Builder::new().name("keys".into()).spawn(move || read_keys(&pressed));
        output::message(match reading {
            Ok(_) => KEYS,
            Err(_) => "warning: standard input cannot be read: Ctrl-C alone ends the flight",
        });
    }
    let columns = terminal::size().map_or(0, |(columns, _)| usize::from(columns));
    let mut log = PlainLog::of_width(columns);
    for model in pictures {
        for line in log.lines(&model) {
            output::message(&line);
        }
    }
}

/// A terminal that says so often that it has ended is gone.
const ENDS_MAX: u32 = 20;

/// Each line a command, until there are no more or the flight is over.
fn read_keys(pressed: &UnboundedSender<KeyCommand>) {
    let mut input = std::io::stdin().lock();
    let (mut line, mut ends) = (Vec::new(), 0);
    loop {
        line.clear();
        match input.by_ref().take(LINE_MAX).read_until(b'\n', &mut line) {
            // at a terminal Ctrl-D ends nothing but the line
            Ok(0) if std::io::stdin().is_terminal() && ends < ENDS_MAX => {
                ends += 1;
                output::message(KEYS);
                continue;
            }
            Ok(0) => {
                output::message("standard input has ended: no more keys, Ctrl-C alone ends the flight");
                return;
            }
            Ok(_) => {}
            Err(error) => {
                output::message(&format!(
                    "warning: keys are no longer read ({error}): Ctrl-C alone ends the flight"
                ));
                return;
            }
        }
        let line = String::from_utf8_lossy(&line);
        match KeyCommand::of_line(&line) {
            Some(command) if pressed.send(command).is_err() => return,
            Some(_) => {}
            None => output::message(&format!("{KEYS}; got `{}`", line.trim_end().escape_debug())),
        }
    }
}

/// The terminal view; lines where the terminal cannot be drawn on.
pub fn draw(
    (stderr, log): (&StandardError, PathBuf),
    pictures: &Receiver<ViewModel>,
    pressed: &UnboundedSender<KeyCommand>,
) {
    // log lines would tear the view
    let away = stderr.away(log);
    let Ok(mut screen) = Screen::open(std::io::stderr) else {
        drop(away);
        return tell(pictures, Some(pressed));
    };
    let mut keys = Keys::default();
    loop {
        while event::poll(Duration::ZERO).unwrap_or(false) {
            if let Ok(event::Event::Key(key)) = event::read()
                && let Some(command) = keys.press(key)
            {
                // a flight that is over takes no keys
                let _ = pressed.send(command);
            }
        }
        match pictures.recv_timeout(LOOK) {
            Ok(mut model) => {
                keys.ask(model.awaits_word);
                if let (true, Some(page), Ok((columns, rows))) =
                    (model.awaits_word, &model.page, terminal::size())
                {
                    keys.page(page.lines(usize::from(columns)).len(), page_rows(rows));
                    model.page_from = keys.from();
                }
                model.typed = keys.typed().map(str::to_owned);
                if screen.draw(&model).is_err() {
                    // lines and Ctrl-C need the terminal as it was
                    drop((screen, away));
                    return tell(pictures, Some(pressed));
                }
            }
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => return,
        }
    }
}
