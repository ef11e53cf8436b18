//! One file an effect; the identifiers are those of reports and files.

mod angular_damping;
mod battery_sag;
mod blade_flapping;
mod catalogue;
mod ceiling_effect;
mod com_offset;
mod frame_misalignment;
mod ground_effect;
mod gust;
mod imu_misalignment;
mod imu_offset;
mod inflow;
mod linear_drag;
mod mass_change;
mod motor_lag;
mod quadratic_drag;
mod rotor_inertia;
mod slung_load;
mod steady_wind;
mod tether;
mod thrust_curve;
mod thrust_tilt;
mod translational_lift;
mod transport_delay;
mod vortex_ring;
mod weak_rotor;

pub use angular_damping::AngularDamping;
pub use battery_sag::BatterySag;
pub use blade_flapping::BladeFlapping;
pub use catalogue::{ALL, by_id};
pub use ceiling_effect::CeilingEffect;
pub use com_offset::ComOffset;
pub use frame_misalignment::FrameMisalignment;
pub use ground_effect::GroundEffect;
pub use gust::Gust;
pub use imu_misalignment::ImuMisalignment;
pub use imu_offset::ImuOffset;
pub use inflow::Inflow;
pub use linear_drag::LinearDrag;
pub use mass_change::MassChange;
pub use motor_lag::MotorLag;
pub use quadratic_drag::QuadraticDrag;
pub use rotor_inertia::RotorInertia;
pub use slung_load::SlungLoad;
pub use steady_wind::SteadyWind;
pub use tether::Tether;
pub use thrust_curve::ThrustCurve;
pub use thrust_tilt::ThrustTilt;
pub use translational_lift::TranslationalLift;
pub use transport_delay::TransportDelay;
pub use vortex_ring::VortexRing;
pub use weak_rotor::WeakRotor;

#[cfg(test)]
mod tests;
