//! The methods by their names.

/// A method's name as in files and JSON.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Method {
    /// standard model (34), least squares (40)
    Ls,
    /// standard model (34), gradient descent (42)
    Gd,
    /// filtered model (38), least squares (40)
    Fmls,
    /// filtered model (38), gradient descent (42)
    Fmgd,
    /// weak form, weighted least squares
    Weak,
    /// weak form together with the effects that the flights show, sizes of forces with the flight path, torques by instruments
    Joint,
}

impl Method {
    /// Short name in tables and JSON.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Ls => "LS",
            Self::Gd => "GD",
            Self::Fmls => "FMLS",
            Self::Fmgd => "FMGD",
            Self::Weak => "WEAK",
            Self::Joint => "JOINT",
        }
    }
}
