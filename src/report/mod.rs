//! Outputs for people and programs: text, JSON, HTML, charts and model files, as views of a finished study.
//!
//! Nothing here fits, computes a statistic, or prints.

mod bare;
mod chart;
mod comparison;
mod effects;
mod explanation;
mod fleet;
mod html;
mod identification;
mod inspection;
mod markdown;
mod model_parts;
mod number;
mod page;
mod plan;
mod proof;
mod quality;
mod schema;
mod thrust_source;
mod validation;
mod value;
mod vehicle;
mod vehicle_drawing;

pub use chart::{Band, Bars, Line, Panel, Strip, Stroke, svg};
pub use comparison::{ComparisonDocument, comparison_html, comparison_markdown, comparison_text};
pub use effects::{effect_text, effects_text};
pub use explanation::{
    ExplanationDocument, explained_model, explanation_answer, explanation_answer_line, explanation_html,
    explanation_markdown, explanation_page, explanation_text, next_flight_words,
};
pub use fleet::{FleetDocument, fleet_html, fleet_text};
pub use identification::{
    IdentificationDocument, history_charts, identification_html, identification_text, identified_model,
};
pub use inspection::{InspectionDocument, inspection_text};
pub use number::{significant, spoken, with_error};
pub use plan::{EXPECTED_ERRORS, PlanDocument, plan_text};
pub use proof::proof_text;
pub use schema::{document_schema, verbs_with_schema};
pub use validation::{
    ValidationDocument, closed_loop_charts, error_table_text, validation_html, validation_text,
};
pub use vehicle::vehicle_text;
