//! Why a vehicle cannot be simulated.

use super::MAX_ROTORS;

/// Why a vehicle cannot be simulated.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PhysicsError {
    /// mass not positive and finite
    #[error("mass must be positive and finite, got {mass_kg} kg")]
    Mass {
        /// what came, kg
        mass_kg: f64,
    },
    /// inertia without inverse or not positive definite
    #[error(
        "inertia must be symmetric and positive definite, got {inertia_kg_m2:?} kg m^2 (xx xy xz yy yz zz)"
    )]
    Inertia {
        /// xx xy xz yy yz zz of what came, kg m^2
        inertia_kg_m2: [f64; 6],
    },
    /// no rotors, or more than the fixed capacity
    #[error("expected 1 to {MAX_ROTORS} rotors, got {count}")]
    RotorCount {
        /// what came
        count: usize,
    },
    /// the propulsion does not give a finite thrust
    #[error(
        "thrust of one rotor at full command must be positive and finite, got {thrust_n} N (a `speed` law needs a thrust coefficient)"
    )]
    Thrust {
        /// what came, N
        thrust_n: f64,
    },
    /// the vehicle's description lacks what an effect needs
    #[error("effect {id} needs the vehicle's {what}; add it to the vehicle file")]
    Missing {
        /// effect
        id: &'static str,
        /// what is missing
        what: &'static str,
    },
    /// no effect of this name
    #[error("no effect `{id}`; expected one of {expected}")]
    UnknownEffect {
        /// what came
        id: String,
        /// the identifiers that there are
        expected: String,
    },
    /// a parameter of an effect by its name
    #[error("effect {id}, `{name}`: expected {expected}, got {got}")]
    EffectParameter {
        /// effect
        id: &'static str,
        /// parameter
        name: String,
        /// the range, or the names
        expected: String,
        /// what came
        got: String,
    },
    /// number of values for an effect
    #[error("effect {id} takes {expected} parameters, got {got}")]
    ParameterCount {
        /// effect
        id: &'static str,
        /// how many it has
        expected: usize,
        /// how many came
        got: usize,
    },
}
