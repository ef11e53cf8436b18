//! What sets the scale of the identified parameters.

/// What sets the scale of the identified parameters: only thrust per mass can come out of a flight.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Anchor {
    /// The thrust law is trusted and the mass is identified (the paper).
    #[default]
    Thrust,
    /// The vehicle was weighed and the thrust coefficient is identified.
    Mass,
}
