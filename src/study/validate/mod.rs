//! Models against recorded flights: the paper's two validations and open-loop playback.

mod closed_loop;
mod comparisons;
mod error_table;
mod flight;
mod model;
mod ranking;
mod request;
mod result;
mod run;

pub use comparisons::{closed_loop_table, playback_table, prediction_table};
pub use error_table::{Column, ErrorRow, ErrorTable};
pub use ranking::{Prediction, Rank};
pub use request::ValidateRequest;
pub use result::{ValidateStudy, ValidatedFlight, ValidatedModel};
pub use run::validate;
