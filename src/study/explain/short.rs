//! One flight that is too short for a part to be held back: its names have no other data to stand on.

/// Why no name of a flight is certain.
#[derive(Debug, Clone, PartialEq)]
pub struct Short {
    /// s of flight that can be used
    pub usable_s: f64,
    /// names that were taken back, because the flight shows them too little: each in brief, with its size
    pub unsure: Vec<String>,
}

impl Short {
    /// A clause.
    pub(super) fn doubt(&self) -> String {
        format!(
            "the flight is short ({:.1} s can be used), so no part of it is left to test the answer on; fly longer, or give another flight \
             of this vehicle with --holdout",
            self.usable_s
        )
    }
}
