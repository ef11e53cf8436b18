//! What `identify` says: JSON, a page for the terminal, the model file, the paper's figures 4 and 5.

mod document;
mod html;
mod model;
mod page;
mod with;

pub use document::{IdentificationDocument, InputFile};
pub use html::IdentificationStory;
pub use model::{history_charts, model_toml};
pub use page::identification_page;
pub use with::WithEffects;

pub(super) use document::thrust_name;
