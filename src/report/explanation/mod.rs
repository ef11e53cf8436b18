//! What `explain` says: the sentence, a page for the terminal, JSON, the model file, the report.

mod answer;
mod document;
mod figures;
mod fit;
mod html;
mod located;
mod model;
mod page;
mod prediction;
mod readers;
mod show;
mod story;

pub use document::ExplanationDocument;
pub use located::{AxisShare, Field, Located, StateShare};
pub use page::explanation_page;
pub use prediction::{Predicted, ShownOn};
pub use readers::for_readers;
pub use story::{Estimate, Given, Story};
