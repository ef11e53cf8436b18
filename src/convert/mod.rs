//! The streams of a log, and what an explanation leaves of them, for programs that plot: CSV, Parquet, MCAP.

mod csv;
mod layout;
#[cfg(feature = "fleet")]
mod mcap;
#[cfg(feature = "fleet")]
mod parquet;
mod series;

pub use csv::to_csv;
pub use layout::{foxglove_layout, plotjuggler_layout};
#[cfg(feature = "fleet")]
pub use mcap::{ConvertError, to_mcap};
#[cfg(feature = "fleet")]
pub use parquet::series_to_parquet;
pub use series::{TimeSeries, of_recording, of_study};
