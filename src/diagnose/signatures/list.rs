//! All signatures, in the order in which the search tries them.

use super::{
    angular_damping, battery_sag, blade_flapping, ceiling_effect, com_offset, frame_misalignment,
    ground_effect, gust, imu_misalignment, imu_offset, inflow, linear_drag, mass_change, motor_lag,
    quadratic_drag, rotor_inertia, slung_load, steady_wind, tether, thrust_curve, thrust_tilt,
    translational_lift, transport_delay, vortex_ring, weak_rotor,
};
use crate::diagnose::signature::{LatencyKind, Signature};

/// One signature for each effect.
pub static ALL: &[&Signature] = &[
    &thrust_curve::SIGNATURE,
    &com_offset::SIGNATURE,
    &rotor_inertia::SIGNATURE,
    &angular_damping::SIGNATURE,
    &linear_drag::SIGNATURE,
    &inflow::SIGNATURE,
    &quadratic_drag::SIGNATURE,
    &blade_flapping::SIGNATURE,
    &translational_lift::SIGNATURE,
    &vortex_ring::SIGNATURE,
    &ground_effect::SIGNATURE,
    &tether::SIGNATURE,
    &ceiling_effect::SIGNATURE,
    &weak_rotor::SIGNATURE,
    &battery_sag::SIGNATURE,
    &slung_load::SIGNATURE,
    &mass_change::SIGNATURE,
    &steady_wind::SIGNATURE,
    &thrust_tilt::SIGNATURE,
    &frame_misalignment::SIGNATURE,
    &imu_misalignment::SIGNATURE,
    &imu_offset::SIGNATURE,
    &motor_lag::SIGNATURE,
    &transport_delay::SIGNATURE,
    &gust::SIGNATURE,
];

/// The signature of the effect with this identifier.
#[must_use]
pub fn signature_of(id: &str) -> Option<&'static Signature> {
    ALL.iter().copied().find(|signature| signature.id() == id)
}

/// The signature of the lag or the delay between command and rotor.
#[must_use]
pub fn latency_signature(kind: LatencyKind) -> Option<&'static Signature> {
    ALL.iter().copied().find(|signature| signature.role.latency == Some(kind))
}

/// Whether an effect is a lag or a delay between command and rotor.
#[must_use]
pub fn latency_kind(id: &str) -> Option<LatencyKind> {
    signature_of(id)?.role.latency
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::effects::ALL as EFFECTS;

    #[test]
    fn every_effect_has_a_signature_and_every_signature_an_effect() {
        for effect in EFFECTS {
            let signature = signature_of(effect.id());
            let signature = signature.unwrap_or_else(|| {
                panic!("{0}: expected diagnose/signatures/{0}.rs and its place in ALL", effect.id())
            });
            assert!(!signature.words.noun.is_empty(), "{}: expected a noun", effect.id());
            let parameters = effect.parameters().len();
            let amounts = signature.amounts;
            assert!(!amounts.is_empty() && amounts.iter().all(|slot| *slot < parameters), "{}", effect.id());
            let role = &signature.role;
            let found_otherwise =
                role.latency.is_some() || role.wind.is_some() || signature.joint.is_irregular;
            let forms = signature.whole();
            assert!(found_otherwise || forms.values.len() == parameters, "{}", effect.id());
        }
        assert_eq!(ALL.len(), EFFECTS.len());
        let ids: std::collections::BTreeSet<&str> = ALL.iter().map(|signature| signature.id()).collect();
        assert_eq!(ids.len(), ALL.len(), "each once");
    }
}
