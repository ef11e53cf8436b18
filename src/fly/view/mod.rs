//! The flight as a person watches it: a terminal view, or plain lines.
//!
//! [`ViewModel`] is filled by whoever runs the flight, and [`LandedView`] by whoever analyses it; [`render`] and
//! [`render_landed`] draw them and decide nothing.

mod instruments;
mod keys;
mod landed;
mod model;
mod plain;
mod render;
mod screen;
mod spark;

pub use instruments::{bar, horizon, path_map};
pub use keys::{ARM_WORD, KILL_WORD, KeyCommand, Keys};
pub use landed::{LandedView, StageView, render_landed};
pub use model::{
    Attitude, Battery, EventLine, HISTORY, LinkView, ParameterRow, Phase, TWIN, Trace, Tracking, ViewModel,
};
pub use plain::PlainLog;
pub use render::{page_rows, render};
pub use screen::Screen;
pub use spark::spark;
