//! What people and other programs read: documents, tables, charts. Nothing here prints.

mod chart;
mod identification;

pub use chart::{Line, Panel, svg};
pub use identification::{
    IdentificationDocument, InputFile, history_charts, identification_page, model_toml,
};
