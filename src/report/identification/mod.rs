//! What `identify` says: JSON, a page for the terminal, the model file, the paper's figures 4 and 5.

mod correlation;
mod document;
mod html;
mod input;
mod model;
mod page;
mod thrust_source;
mod value;
mod with;

pub use document::IdentificationDocument;
pub use html::IdentificationStory;
pub use input::InputFile;
pub use model::{history_charts, model_toml};
pub use page::identification_page;
pub use with::WithEffects;

pub(super) use thrust_source::thrust_name;
