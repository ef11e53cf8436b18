//! Parameters of an autopilot that follow from a model.

/// One parameter that follows from the model.
#[derive(Debug, Clone, PartialEq)]
pub struct AircraftParameter {
    /// the autopilot's name of it
    pub name: String,
    /// in `unit`
    pub value: f64,
    /// standard error in `unit`; `None` of a switch
    pub std: Option<f64>,
    /// the autopilot's own unit
    pub unit: &'static str,
    /// a whole number
    pub is_integer: bool,
    /// from what it follows, and where it holds
    pub why: String,
}

impl AircraftParameter {
    /// A number with its standard error.
    pub(super) fn number(
        name: impl Into<String>,
        (value, std): (f64, f64),
        unit: &'static str,
        why: impl Into<String>,
    ) -> Self {
        Self { name: name.into(), value, std: Some(std), unit, is_integer: false, why: why.into() }
    }

    /// A value without an error: it switches something.
    pub(super) fn switch(
        name: impl Into<String>,
        value: f64,
        is_integer: bool,
        why: impl Into<String>,
    ) -> Self {
        Self { name: name.into(), value, std: None, unit: "-", is_integer, why: why.into() }
    }
}

/// The parameters, and what has none.
#[derive(Debug, Clone, PartialEq)]
pub struct AircraftParameters {
    /// those that follow from the model
    pub parameters: Vec<AircraftParameter>,
    /// sentence by sentence: what of the model has no parameter, and which parameter does not follow from it
    pub left_out: Vec<String>,
    /// the file
    pub text: String,
}
