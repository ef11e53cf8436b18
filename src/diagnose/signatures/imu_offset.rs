//! Signature: an accelerometer away from the centre of mass.

use crate::diagnose::picture::{Over, Picture};
use crate::diagnose::recorded::Need;
use crate::diagnose::signature::{EffectTerm, Naming, Signature};
use crate::diagnose::trace::Trace;
use crate::diagnose::usual_size::UsualSize;
use crate::diagnose::wording::{Size, Words};
use crate::physics::effects::ImuOffset;

/// Distance of the inertial unit from the centre of mass that ordinary vehicles have, m. Set by judgement: with less,
/// ordinary vehicles would have it.
const ORDINARY_M: f64 = 0.005;

/// Distance up to which the forces may be told from the flight path as if it were none, m. Rotation makes it feel less than the
/// accelerometer's noise there: 0.15 m/s^2 at 5 rad/s^2.
const NEAR_M: f64 = 0.03;

/// Whether a term is an accelerometer so near to the centre of mass that the forces are told without it.
pub(in crate::diagnose) fn is_near(term: &EffectTerm) -> bool {
    term.is(&SIGNATURE) && term.values[..3].iter().map(|along| along * along).sum::<f64>().sqrt() < NEAR_M
}

/// An accelerometer away from the centre of mass.
pub static SIGNATURE: Signature = Signature {
    // of rates that are logged seldom, vibration that the samples fold into slow motion looks the same
    needs: &[Need::Accelerometer, Need::Torques],
    // against the kinematics alone
    forms: |recorded| {
        let twice = recorded.all(Trace::reads_force_twice);
        twice.then(|| SIGNATURE.form(&[0.0; 3], &[0, 1, 2])).into_iter().collect()
    },
    naming: Naming { ordinary: Some(ORDINARY_M), ..Naming::PLAIN },
    picture: Picture::of(&[0, 1], Over::YawRate),
    sizes: &[("x", UsualSize::Of(0.05)), ("y", UsualSize::Of(-0.03)), ("z", UsualSize::Of(0.04))],
    ..Signature::of(
        &ImuOffset,
        &[0, 1, 2],
        Words {
            size: Size::Norm { factor: 1e3, unit: "mm" },
            ..Words::of("an accelerometer away from the centre of mass")
        },
    )
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn forces_are_told_beside_an_accelerometer_near_the_centre_of_mass() {
        let at = |place: [f64; 3]| is_near(&SIGNATURE.term(&place, &[0, 1, 2]));
        assert!(at([0.0, 0.012, 0.0]) && at([0.01, 0.02, 0.01]));
        assert!(!at([0.02, 0.02, 0.02]));
    }
}
