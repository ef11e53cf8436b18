//! Views of the study of `identify`: text for the terminal, JSON, the model file, HTML, and the paper's figures 4 and
//! 5.

mod html;
mod json;
mod model;
mod text;
mod with_json;
mod with_text;
mod words;

pub use html::identification_html;
pub use json::IdentificationDocument;
pub use model::{history_charts, identified_model};
pub use text::identification_text;
