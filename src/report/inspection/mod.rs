//! Views of an inspection: text for the terminal, JSON.

mod json;
mod quantities;
mod text;

pub use json::InspectionDocument;
pub use text::inspection_text;
