//! What the diagnosis knows of each effect: one file an effect, of the same name as in [`crate::physics::effects`].

mod angular_damping;
mod battery_sag;
mod blade_flapping;
mod ceiling_effect;
mod com_offset;
mod effect_quantity;
mod frame_misalignment;
mod ground_effect;
mod gust;
mod imu_misalignment;
mod imu_offset;
mod inflow;
mod linear_drag;
mod list;
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

pub(super) use com_offset::REPACKED_M;
pub use effect_quantity::{DeterminedBy, EFFECT_QUANTITIES, EffectQuantity};
pub(super) use imu_offset::is_near;
pub use list::{ALL, is_irregular, latency_kind, latency_signature, signature_of, with_role};
pub(super) use steady_wind::CALM_M_S;
