//! Views of the study of `validate`: text for the terminal, JSON, HTML, and the paper's figures 6 to 9.

mod charts;
mod heads;
mod html;
mod json;
mod text;

pub use charts::closed_loop_charts;
pub use html::validation_html;
pub use json::ValidationDocument;
pub use text::{error_table_text, validation_text};
