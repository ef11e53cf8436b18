//! A folder of cases: each explained, all verdicts sealed, then scored by answers.
//!
//! The answers are to be read after the verdicts are written, so this is four functions and not one: [`case_folders`],
//! [`verdict`], [`seal`], [`prove`].

mod answers;
mod case;
mod folders;
mod result;
mod run;
mod score;
mod seal;

pub use case::{CaseEffect, CaseParameter, CaseVerdict, Gain, verdict};
pub use folders::case_folders;
pub use result::Proof;
pub use run::prove;
pub use score::{ProofSummary, ScoredCase, SizeError};
pub use seal::{SealedVerdicts, seal};
