//! Charts as SVG, self-contained, no scripts. Text and axes take the colour of the page around them.

mod axis;
mod bars;
mod colour;
mod data;
mod document;
mod draw;
mod frame;
mod panel;
mod path;
mod strip;

pub use bars::Bars;
pub use document::{inline, svg};
pub use frame::POINTS;
pub use panel::{Band, Line, Panel, Stroke};
pub use path::{Path3, PathValue};
pub use strip::Strip;
