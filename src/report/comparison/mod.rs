//! Views of the study of `compare`: text, JSON and `report.html` with the drawing of the vehicle.

mod cells;
mod columns;
mod drawing;
mod flight_name;
mod html;
mod json;
mod markdown;
mod own;
mod plots;
mod text;
mod words;

pub use html::comparison_html;
pub use json::ComparisonDocument;
pub use markdown::comparison_markdown;
pub(super) use plots::{CAPTION, plots};
pub use text::comparison_text;
pub(super) use words::{step_words, value_of};
