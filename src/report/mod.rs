//! What people and other programs read: documents, tables, charts. Nothing here prints.

mod chart;
mod identification;
mod validation;

pub use chart::{Line, Panel, svg};
pub use identification::{
    IdentificationDocument, InputFile, history_charts, identification_page, model_toml,
};
pub use validation::{
    Column, ErrorRow, ErrorTable, closed_loop_charts, closed_loop_table, playback_table, prediction_table,
};
