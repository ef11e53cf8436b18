//! The flight as a person watches it: a terminal view, or plain lines.
//!
//! [`ViewModel`] is filled by whoever runs the flight; [`render`] draws it and decides nothing.

mod instruments;
mod keys;
mod model;
mod plain;
mod render;
mod screen;
mod spark;

pub use instruments::{bar, horizon, path_map};
pub use keys::{KILL_WORD, KeyCommand, Keys};
pub use model::{
    Attitude, Battery, EventLine, HISTORY, LinkView, ParameterRow, Phase, Trace, Tracking, ViewModel,
};
pub use plain::PlainLog;
pub use render::{page_rows, render};
pub use screen::Screen;
pub use spark::spark;
