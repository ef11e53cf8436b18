//! How wide the terminal is.

use ratatui::crossterm::terminal;

/// Columns where there is no terminal.
const COLUMNS: usize = 80;
/// Sentences in longer lines are hard to read.
const MOST: usize = 120;

/// Columns of the terminal; `None` where there is none, or it does not say.
pub fn of_terminal() -> Option<usize> {
    let columns = terminal::size().map_or(0, |(columns, _)| usize::from(columns));
    (columns > 0).then_some(columns)
}

/// Columns and rows of the terminal; `None` where there is none, or it does not say.
pub fn size_of_terminal() -> Option<(usize, usize)> {
    let (columns, rows) = terminal::size().ok()?;
    (columns > 0 && rows > 0).then_some((usize::from(columns), usize::from(rows)))
}

/// Columns of sentences for people.
pub fn columns() -> usize {
    of_terminal().map_or(COLUMNS, |columns| columns.min(MOST))
}
