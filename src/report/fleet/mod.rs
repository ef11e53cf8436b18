//! Views of the report of a fleet: text, JSON and one page of HTML.

mod html;
mod json;
mod text;
mod words;

pub use html::fleet_html;
pub use json::FleetDocument;
pub use text::fleet_text;
