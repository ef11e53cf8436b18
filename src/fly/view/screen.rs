//! The terminal: taken over, drawn on, and given back whatever happens.

use super::landed::{LandedView, render_landed};
use super::model::ViewModel;
use super::render::render;
use ratatui::Terminal;
use ratatui::backend::CrosstermBackend;
use ratatui::crossterm::cursor::Show;
use ratatui::crossterm::execute;
use ratatui::crossterm::terminal::{
    EnterAlternateScreen, LeaveAlternateScreen, disable_raw_mode, enable_raw_mode,
};
use std::io::{self, Write};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::channel;
use std::thread;
use std::time::Duration;

/// How long a panic waits for the terminal.
const PATIENCE: Duration = Duration::from_millis(300);

/// A terminal in use. Leaving it, or a panic anywhere, gives it back as it was.
pub struct Screen<W: Write> {
    terminal: Terminal<CrosstermBackend<W>>,
    open: fn() -> W,
    taken: Arc<AtomicBool>,
}

impl<W: Write + 'static> Screen<W> {
    /// Takes the terminal over; `open` gives its stream, such as standard error.
    ///
    /// # Errors
    /// If there is no terminal, or it cannot be drawn on.
    pub fn open(open: fn() -> W) -> io::Result<Self> {
        enable_raw_mode()?;
        let taken = Arc::new(AtomicBool::new(true));
        let in_panic = Arc::clone(&taken);
        let previous = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |panic| {
            let taken = Arc::clone(&in_panic);
            let (done, given_back) = channel();
            let work = move || {
                give_back(&taken, open);
                // whoever panics may not have waited
                let _ = done.send(());
            };
            // a terminal that takes nothing must not hold up whoever still has to tell the vehicle
            if thread::Builder::new().name("screen".into()).spawn(work).is_ok() {
                let _ = given_back.recv_timeout(PATIENCE);
            }
            previous(panic);
        }));
        let terminal = execute!(open(), EnterAlternateScreen)
            .and_then(|()| Terminal::new(CrosstermBackend::new(open())))
            .inspect_err(|_| give_back(&taken, open))?;
        Ok(Self { terminal, open, taken })
    }

    /// Draws the model.
    ///
    /// # Errors
    /// What the terminal reports.
    pub fn draw(&mut self, model: &ViewModel) -> io::Result<()> {
        self.terminal.draw(|frame| render(frame, model)).map(|_| ())
    }

    /// Draws what follows the landing.
    ///
    /// # Errors
    /// What the terminal reports.
    pub fn draw_landed(&mut self, view: &LandedView) -> io::Result<()> {
        self.terminal.draw(|frame| render_landed(frame, view)).map(|_| ())
    }
}

impl<W: Write> Drop for Screen<W> {
    fn drop(&mut self) {
        give_back(&self.taken, self.open);
    }
}

/// Once; a terminal that cannot be given back is left to its user.
fn give_back<W: Write>(taken: &AtomicBool, open: fn() -> W) {
    if taken.swap(false, Ordering::SeqCst) {
        let raw = disable_raw_mode();
        let screen = execute!(open(), LeaveAlternateScreen, Show);
        drop(raw.and(screen));
    }
}
