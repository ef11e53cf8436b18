//! All signatures, in the order in which the search tries them.

use crate::diagnose::signature::{LatencyKind, Role, Signature};

/// One signature for each effect.
pub static ALL: &[&Signature] = &[
    &super::thrust_curve::SIGNATURE,
    &super::com_offset::SIGNATURE,
    &super::rotor_inertia::SIGNATURE,
    &super::angular_damping::SIGNATURE,
    &super::linear_drag::SIGNATURE,
    &super::inflow::SIGNATURE,
    &super::quadratic_drag::SIGNATURE,
    &super::blade_flapping::SIGNATURE,
    &super::translational_lift::SIGNATURE,
    &super::vortex_ring::SIGNATURE,
    &super::ground_effect::SIGNATURE,
    &super::tether::SIGNATURE,
    &super::ceiling_effect::SIGNATURE,
    &super::weak_rotor::SIGNATURE,
    &super::battery_sag::SIGNATURE,
    &super::slung_load::SIGNATURE,
    &super::mass_change::SIGNATURE,
    &super::steady_wind::SIGNATURE,
    &super::thrust_tilt::SIGNATURE,
    &super::frame_misalignment::SIGNATURE,
    &super::imu_misalignment::SIGNATURE,
    &super::imu_offset::SIGNATURE,
    &super::motor_lag::SIGNATURE,
    &super::transport_delay::SIGNATURE,
    &super::gust::SIGNATURE,
];

/// The signature of the effect with this identifier.
#[must_use]
pub fn signature_of(id: &str) -> Option<&'static Signature> {
    ALL.iter().copied().find(|signature| signature.id() == id)
}

/// Whether an identifier is that of wind that changes irregularly: it is found in the residual, and no model has it.
#[must_use]
pub fn is_irregular(id: &str) -> bool {
    signature_of(id).is_some_and(|signature| signature.joint.irregular.is_some())
}

/// The first signature whose role meets a condition.
#[must_use]
pub fn with_role(meets: impl Fn(&Role) -> bool) -> Option<&'static Signature> {
    ALL.iter().copied().find(|signature| meets(&signature.role))
}

/// The signature of the lag or the delay between command and rotor.
#[must_use]
pub fn latency_signature(kind: LatencyKind) -> Option<&'static Signature> {
    with_role(|role| role.latency == Some(kind))
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
                role.latency.is_some() || role.wind.is_some() || signature.joint.irregular.is_some();
            let forms = signature.whole();
            assert!(found_otherwise || forms.values.len() == parameters, "{}", effect.id());
        }
        assert_eq!(ALL.len(), EFFECTS.len());
        let ids: std::collections::BTreeSet<&str> = ALL.iter().map(|signature| signature.id()).collect();
        assert_eq!(ids.len(), ALL.len(), "each once");
    }
}
