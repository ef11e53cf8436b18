//! What people and other programs read: documents, tables, charts. Nothing here prints.

mod chart;
mod explanation;
mod html;
mod identification;
mod model_parts;
mod number;
mod quality;
mod recorded;
mod validation;

pub use chart::{Band, Bars, Line, Panel, Strip, Stroke, svg};
pub use explanation::{
    AxisShare, Estimate, ExplanationDocument, Field, Given, Located, Predicted, ShownOn, StateShare, Story,
    explanation_page, for_readers,
};
pub use identification::{
    IdentificationDocument, IdentificationStory, InputFile, WithEffects, history_charts, identification_page,
    model_toml,
};
pub use number::{significant, spoken, with_error};
pub use validation::{
    Column, ErrorRow, ErrorTable, ValidatedFlight, closed_loop_charts, closed_loop_table, playback_table,
    prediction_table, shortened_names, validation_report,
};
