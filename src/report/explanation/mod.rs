//! Views of the study of `explain`: the sentence, text for the terminal, JSON, the model file, HTML.

mod along;
mod answer;
mod answer_line;
mod effect_json;
mod figures;
mod fit_json;
mod hold_out;
mod html;
mod json;
mod limits;
mod markdown;
mod model;
mod motor;
mod no_model;
mod own_wind;
mod pictures;
mod prospect;
mod rivals;
mod shown_by;
mod text;
mod turning_json;
mod whereabouts;

pub use answer::answer as explanation_answer;
pub use answer_line::answer_line as explanation_answer_line;
pub use html::explanation_html;
pub use json::ExplanationDocument;
pub use markdown::explanation_markdown;
pub use model::explained_model;
pub use prospect::next_flight_words;
pub use text::{explanation_page, explanation_text};
