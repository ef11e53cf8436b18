//! Estimates as they are handed on: a value with its standard error, or why there is none.

use super::identify::Method;
use super::theta::{NAMES, THETA, Theta, ThetaCovariance, UNITS, scale_of};
use super::weak::WeakEstimate;

/// A moment of inertia whose standard error exceeds this share of its nominal size is not determined.
const LARGEST_RELATIVE_STD: f64 = 0.3;

/// One parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// as in files
    pub name: &'static str,
    /// as in files
    pub unit: &'static str,
    /// what the flight says of it
    pub finding: Finding,
}

/// A number or the reason why there is none.
#[derive(Debug, Clone, PartialEq)]
pub enum Finding {
    /// determined by the flight
    Determined {
        /// in the parameter's unit
        value: f64,
        /// standard error, same unit
        std: f64,
    },
    /// known beforehand (a weighed mass)
    Given {
        /// in the parameter's unit
        value: f64,
    },
    /// the flight says nothing useful
    NotDetermined {
        /// for the user
        reason: String,
    },
}

/// `Theta` with its covariance.
#[derive(Debug, Clone, PartialEq)]
pub struct Estimated {
    /// NaN where there is no column
    pub theta: Theta,
    /// same order
    pub covariance: ThetaCovariance,
}

impl Estimated {
    /// The rigid-body part of a weak-form estimate.
    #[must_use]
    pub fn of(weak: &WeakEstimate) -> Self {
        Self { theta: weak.theta, covariance: weak.covariance }
    }
}

/// What one method says.
#[derive(Debug, Clone, PartialEq)]
pub struct MethodResult {
    /// which
    pub method: Method,
    /// in `Theta`'s order
    pub parameters: [Parameter; THETA],
    /// the raw numbers
    pub estimated: Estimated,
}

impl MethodResult {
    /// Judges each parameter against the nominal sizes.
    #[must_use]
    pub fn new(method: Method, estimated: &Estimated, nominal: &Theta) -> Self {
        let parameters = std::array::from_fn(|index| Parameter {
            name: NAMES[index],
            unit: UNITS[index],
            finding: by_method(method, finding(estimated, nominal, index)),
        });
        Self { method, parameters, estimated: estimated.clone() }
    }
}

/// Gradient descent with a fixed gain never stops following the noise; that is not the flight's fault.
fn by_method(method: Method, finding: Finding) -> Finding {
    match (method, finding) {
        (Method::Gd | Method::Fmgd, Finding::NotDetermined { .. }) => Finding::NotDetermined {
            reason:
                "gradient descent with this gain keeps following the noise; a smaller --sigma averages longer"
                    .into(),
        },
        (_, finding) => finding,
    }
}

/// Judges one parameter.
#[must_use]
pub fn finding(estimated: &Estimated, nominal: &Theta, index: usize) -> Finding {
    let (value, variance) = (estimated.theta[index], estimated.covariance[(index, index)]);
    if !value.is_finite() || !variance.is_finite() {
        let missing = if index == 0 { "vertical motion" } else { "body rates" };
        return Finding::NotDetermined { reason: format!("the recording holds no {missing}") };
    }
    let std = variance.max(0.0).sqrt();
    let size = scale_of(nominal, index).max(scale_of(&estimated.theta.map(f64::abs), index));
    let relative = std / size;
    if relative > LARGEST_RELATIVE_STD {
        return Finding::NotDetermined {
            reason: format!(
                "standard error {:.0} % of its size; fly more angular acceleration about this axis",
                100.0 * relative
            ),
        };
    }
    let moment = matches!(index, 0 | 1 | 4 | 6);
    if moment && value <= 2.0 * std {
        return Finding::NotDetermined {
            reason: format!("estimate {value:.3e} +- {std:.1e} is not clear of zero"),
        };
    }
    Finding::Determined { value, std }
}
