//! Parameters of an autopilot that follow from a model.

use crate::text::with_error;

/// A value may be so many of its standard errors beyond a documented limit for the limit to stand in its place. It is the usual 95 %.
const BEYOND: f64 = 2.0;

/// What a parameter with documented limits holds of a value with its standard error: the value, or the limit where its error reaches
/// that, and what is to be said of it before the reason. `None` of a value that is further beyond.
pub(super) fn within((value, std): (f64, f64), (least, most): (f64, f64)) -> Option<(f64, String)> {
    if (least..=most).contains(&value) {
        return Some((value, String::new()));
    }
    let limit = value.clamp(least, most);
    let told = || {
        let value = with_error(value, std);
        format!(
            "the limit of {limit} that the autopilot documents, in place of {value}, which is beyond it by at most two standard errors; "
        )
    };
    ((value - limit).abs() <= BEYOND * std).then(|| (limit, told()))
}

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_whose_error_reaches_the_limit_is_the_limit() {
        let limits = (0.0, 1.0);
        assert_eq!(within((0.7, 0.01), limits), Some((0.7, String::new())));
        let (held, told) = within((1.029, 0.02), limits).unwrap();
        assert!(held == 1.0 && told.contains("the limit of 1 ") && told.contains("1.03 +- 0.02"), "{told}");
        assert_eq!(within((-0.1, 0.06), limits).unwrap().0, 0.0);
        assert_eq!((within((1.029, 0.01), limits), within((f64::NAN, 0.1), limits)), (None, None));
    }
}
