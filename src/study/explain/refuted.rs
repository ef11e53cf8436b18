//! Names that flights which were not used refute.

use crate::note::{About, Note};
use crate::text::significant;

/// Names that the flights explained would give, and that flights which were not used refute.
#[derive(Debug, Clone, PartialEq)]
pub struct Refuted {
    /// each in brief, with its size
    pub names: Vec<String>,
    /// by how much errors over 0.5 s are larger with them, mean over the quantities, %
    pub worse_percent: f64,
}

impl Refuted {
    pub(super) fn note(&self) -> Note {
        let text = format!(
            "the flights explained alone would give a name to {}; with it, errors over 0.5 s are {} % larger in the mean on the \
             hold-out, so it gets none",
            self.names.join(", "),
            significant(self.worse_percent, 2)
        );
        Note::warning(About::HoldOut, text)
    }
}
