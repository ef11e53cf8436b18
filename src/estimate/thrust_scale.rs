//! The rotors' thrust against the stated one.

use super::result::Finding;
use crate::vehicle::{Propulsion, ThrustLaw};

/// Thrust of the rotors relative to the vehicle file, if the mass was weighed.
#[derive(Debug, Clone, PartialEq)]
pub struct ThrustScale {
    /// factor on thrust (-), with its standard error
    pub factor: Finding,
    /// name of the quantity that it scales, as in the vehicle file
    pub name: &'static str,
    /// the scaled quantity
    pub value: Finding,
    /// its unit
    pub unit: &'static str,
}

impl ThrustScale {
    /// By the mass that a flight shows with the stated thrust, and the weighed one.
    #[must_use]
    pub fn of(mass: Finding, weighed_kg: f64, stated: &Propulsion) -> Self {
        let (name, unit, size) = match stated.law {
            ThrustLaw::Speed { .. } => {
                ("thrust_coefficient", "N/(rad/s)^2", stated.thrust_coefficient.unwrap_or(f64::NAN))
            }
            ThrustLaw::Curve { thrust_max_n, .. } => ("thrust_max", "N", thrust_max_n),
        };
        match mass {
            Finding::Determined { value, std } => {
                let factor = weighed_kg / value;
                let relative = std / value;
                let scaled =
                    |size: f64| Finding::Determined { value: size * factor, std: size * factor * relative };
                Self { factor: scaled(1.0), name, value: scaled(size), unit }
            }
            other => Self { factor: other.clone(), name, value: other, unit },
        }
    }
}
