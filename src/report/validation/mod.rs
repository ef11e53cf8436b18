//! The paper's two validations and open-loop playback as tables and charts.

mod charts;
mod comparisons;
mod error_table;
mod heads;
mod html;

pub use charts::closed_loop_charts;
pub use comparisons::{closed_loop_table, playback_table, prediction_table};
pub use error_table::{Column, ErrorRow, ErrorTable};
pub use heads::shortened_names;
pub use html::{ValidatedFlight, validation_report};

pub(super) use comparisons::COMPONENTS;
