//! `mavid prove CASES --answers FILE`: explains a folder of cases, seals the verdicts, then scores them.

mod answers;
mod case;
mod document;
mod page;
mod score;
mod seal;
mod verb;

pub use verb::run;
