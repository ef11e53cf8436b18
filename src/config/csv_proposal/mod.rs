//! A mapping of columns proposed from the names in a header and from the numbers below them.

mod choose;
mod group;
mod numbers;
mod propose;
mod words;

pub use propose::{CsvProposal, propose_csv_mapping};
