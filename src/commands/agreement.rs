//! Words that agree at a terminal, and that do not.

/// The word that agrees to a change of the vehicle.
pub const SET: &str = "set";
/// Words that agree.
pub const YES: [&str; 2] = ["y", "yes"];
/// Words that do not.
pub const NO: [&str; 2] = ["n", "no"];
