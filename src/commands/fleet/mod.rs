//! `mavid fleet`: logs of many vehicles as tables, and the tables as a report.

mod child;
mod identity;
mod limits;
mod one;
mod report;
mod run;
mod settings;
mod verb;
mod work;
mod worker;

pub use verb::run;
pub use worker::run as run_log;
