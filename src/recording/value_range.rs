//! The possible values of each quantity. On-board logs have no checksums, so a damaged message may hold any number, and one of
//! 1e30 dominates every sum.

use super::quantity::Quantity;

/// A larger value, in SI, is damage and no measurement, whatever the unit of its log; infinite where any value may be
/// meant. Far beyond what any vehicle does, and far below what damage brings. A smaller bound would cut a racing
/// machine's measurements, a larger one would let damage through.
pub(super) const fn most(quantity: Quantity) -> f64 {
    match quantity {
        Quantity::Attitude => 1e2,
        Quantity::AngularRate => 1e4,
        Quantity::SpecificForce
        | Quantity::WorldAcceleration
        | Quantity::Velocity
        | Quantity::GpsVelocity => 1e5,
        // shares, or thousandths: commands are rebuilt from them
        Quantity::ThrustSetpoint | Quantity::TorqueSetpoint | Quantity::ThrustVectorSetpoint => 1e5,
        Quantity::ActuatorCommand | Quantity::ActuatorDemand | Quantity::RotorSpeed => 1e6,
        Quantity::Position | Quantity::BarometricHeight => 1e8,
        _ => f64::INFINITY,
    }
}
