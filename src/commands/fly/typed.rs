//! Lines of standard input as keys, where single keys are not read.
//!
//! A word for arming that was typed before the page of the flight was shown to its end arms nothing: nobody can have
//! read what it agrees to.

use std::io::{self, IsTerminal};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use mavid::fly::view::{ARM_WORD, KeyCommand};
use tokio::sync::mpsc::UnboundedSender;

use crate::commands::{output, typed_early};

/// The keys of a flight told in lines.
pub const KEYS: &str =
    "h, l, r and return: hold, land, return home; :kill and return: motors off; Ctrl-C: hold and end";
/// What is said of a word for arming that came too early.
const EARLY: &str = "typed before the page was shown: ignored; type arm again";
/// Bytes of a line of them: no one types more.
const LINE_MAX: usize = 256;
/// A terminal that says so often that it has ended is gone.
const ENDS_MAX: u32 = 20;

/// Whether the page before the flight was shown to its end. Clones tell the same.
#[derive(Debug, Clone, Default)]
pub struct PageShown(Arc<Mutex<bool>>);

impl PageShown {
    /// Of a flight that has no such page, or has one that is yet to be shown.
    pub fn new(has_page: bool) -> Self {
        Self(Arc::new(Mutex::new(!has_page)))
    }

    /// It was. What was typed before and is not read yet, half a line among it, is thrown away.
    pub fn set(&self) {
        let mut shown = self.locked();
        if !*shown {
            typed_early::throw_away();
            *shown = true;
        }
    }

    fn locked(&self) -> MutexGuard<'_, bool> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// A line, and whether all of it came after the page.
#[derive(Debug, PartialEq, Eq)]
struct Line {
    text: String,
    after_page: bool,
}

/// Bytes as they come become lines.
#[derive(Debug, Default)]
struct Lines {
    begun: Vec<u8>,
    /// a byte of it came before the page
    begun_early: bool,
}

impl Lines {
    fn take(&mut self, bytes: &[u8], after_page: bool) -> Vec<Line> {
        let mut lines = Vec::new();
        for byte in bytes {
            self.begun.push(*byte);
            self.begun_early |= !after_page;
            if *byte == b'\n' || self.begun.len() == LINE_MAX {
                lines.extend(self.end());
            }
        }
        lines
    }

    /// What has come of a line.
    fn end(&mut self) -> Option<Line> {
        let bytes = std::mem::take(&mut self.begun);
        let after_page = !std::mem::take(&mut self.begun_early);
        let text = || String::from_utf8_lossy(&bytes).into_owned();
        (!bytes.is_empty()).then(|| Line { text: text(), after_page })
    }
}

/// What a line asks for, or what is to be said of it.
fn judge(line: &Line) -> Result<KeyCommand, String> {
    match KeyCommand::of_line(&line.text) {
        Some(KeyCommand::Arm) if !line.after_page => Err(EARLY.to_owned()),
        Some(command) => Ok(command),
        None => Err(format!(
            "expected {ARM_WORD} and return before the flight, or {KEYS}; got `{}`",
            line.text.trim_end().escape_debug()
        )),
    }
}

/// Each line a command, until there are no more or the flight is over.
pub fn read_keys(pressed: &UnboundedSender<KeyCommand>, shown: &PageShown) {
    let (mut lines, mut bytes, mut ends) = (Lines::default(), [0; LINE_MAX], 0);
    let mut told_early = false;
    loop {
        let over = || pressed.is_closed();
        let came = match input::read(&mut bytes, shown, &over) {
            Ok(None) => return,
            Ok(Some((0, _))) => match lines.end() {
                Some(line) => vec![line],
                // at a terminal Ctrl-D ends nothing but the line
                None if io::stdin().is_terminal() && ends < ENDS_MAX => {
                    ends += 1;
                    output::message(KEYS);
                    continue;
                }
                None => {
                    output::message("standard input has ended: no more keys, Ctrl-C alone ends the flight");
                    return;
                }
            },
            Ok(Some((count, after_page))) => lines.take(&bytes[..count], after_page),
            Err(error) => {
                output::warning(&format!("keys are no longer read ({error}): Ctrl-C alone ends the flight"));
                return;
            }
        };
        for line in came {
            match judge(&line) {
                Ok(command) if pressed.send(command).is_err() => return,
                Ok(_) => {}
                Err(said) if said == EARLY && std::mem::replace(&mut told_early, true) => {}
                Err(said) => output::message(&said),
            }
        }
    }
}

/// Standard input, read as it comes. Whether the page was shown is looked at in the same instant.
#[cfg(unix)]
mod input {
    use super::PageShown;
    use rustix::event::{PollFd, PollFlags, Timespec, poll};
    use rustix::io::{read as read_some, retry_on_intr};
    use std::io;

    const NO_WAIT: Timespec = Timespec { tv_sec: 0, tv_nsec: 0 };
    /// Between two looks whether the flight is over.
    const LOOK: Timespec = Timespec { tv_sec: 0, tv_nsec: 100_000_000 };

    /// The bytes that came, and whether that was after the page; no bytes at its end, and `None` once the flight is over:
    /// what is typed afterwards is for whoever asks next.
    pub(super) fn read(
        bytes: &mut [u8],
        shown: &PageShown,
        over: &dyn Fn() -> bool,
    ) -> io::Result<Option<(usize, bool)>> {
        let stdin = io::stdin();
        let ready = |limit: Option<&Timespec>| {
            let mut wanted = [PollFd::new(&stdin, PollFlags::IN)];
            retry_on_intr(|| poll(&mut wanted, limit))
        };
        loop {
            if over() {
                return Ok(None);
            }
            if ready(Some(&LOOK))? == 0 {
                continue;
            }
            // whoever shows the page waits here: what is read is of one side of it
            let shown = shown.locked();
            // thrown away meanwhile
            if ready(Some(&NO_WAIT))? == 0 {
                continue;
            }
            let count = retry_on_intr(|| read_some(&stdin, &mut *bytes))?;
            return Ok(Some((count, *shown)));
        }
    }
}

/// Standard input, read as it comes.
#[cfg(not(unix))]
mod input {
    use super::PageShown;
    use std::io::{self, Read};

    /// The bytes that came, and whether that was after the page; none at its end.
    pub(super) fn read(
        bytes: &mut [u8],
        shown: &PageShown,
        _over: &dyn Fn() -> bool,
    ) -> io::Result<Option<(usize, bool)>> {
        let count = io::stdin().lock().read(bytes)?;
        Ok(Some((count, *shown.locked())))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_word_of_which_a_letter_was_typed_before_the_page_arms_nothing() {
        let mut lines = Lines::default();
        let mut said = |bytes: &[u8], after: bool| -> Vec<Result<KeyCommand, String>> {
            lines.take(bytes, after).iter().map(judge).collect()
        };
        let early = || Err(EARLY.to_owned());
        assert_eq!(said(b"arm\narm\nl\n", false), [early(), early(), Ok(KeyCommand::Land)]);
        assert_eq!(said(b"ar", false), []);
        assert_eq!(said(b"m\narm\n", true), [early(), Ok(KeyCommand::Arm)]);
        let wrong = said(b"fly\n", true).pop().unwrap().unwrap_err();
        assert!(wrong.starts_with("expected arm") && wrong.ends_with("got `fly`"), "{wrong}");
        assert_eq!(said(b"ar", true), []);
        assert_eq!(lines.end().map(|line| line.text), Some("ar".to_owned()));
        assert_eq!(lines.end(), None);
        let long = lines.take(&[b'x'; LINE_MAX + 1], true);
        assert_eq!((long.len(), lines.begun.len()), (1, 1));
    }
}
