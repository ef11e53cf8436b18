//! Signature: the rotors' hub moment.

use crate::diagnose::picture::{Over, Picture};
use crate::diagnose::recorded::Need;
use crate::diagnose::signature::{EffectTerm, Naming, Role, Signature};
use crate::diagnose::usual_size::UsualSize;
use crate::diagnose::wording::{Clause, Words};
use crate::physics::effects::BladeFlapping;

/// Height over the centre of mass at which an ordinary drag may act, m: nobody knows a vehicle's centre of mass
/// better.
const ORDINARY_HEIGHT_M: f64 = 0.003;

/// Airspeed at which a drag is taken, m/s.
const ABOUT_M_S: f64 = 1.0;

/// A moment at the rotors' hubs by the airspeed across their axes.
pub static SIGNATURE: Signature = Signature {
    needs: &[Need::Velocity, Need::Torques],
    forms: |_| vec![SIGNATURE.form(&[0.0], &[0])],
    naming: Naming { is_ordinary, ..Naming::PLAIN },
    role: Role { of_air: true, ..Role::NONE },
    picture: Picture::of(&[3, 4], Over::AirspeedAcross),
    sizes: &[("k", UsualSize::PerInertia(0.5))],
    ..Signature::of(
        &BladeFlapping,
        &[0],
        Words {
            clause: Clause::OneNumber {
                parameter: "k",
                factor: 1.0,
                before: "The rotors' hub moment was left out:",
                after: "N m per m/s of airspeed across the rotor axis",
            },
            ..Words::of("the rotors' hub moment")
        },
    )
};

/// A moment that the drag of the model makes a little above or below the centre of mass.
fn is_ordinary(term: &EffectTerm, all: &[EffectTerm]) -> bool {
    let drag_n_s_m = |of: &EffectTerm| {
        let slope = of.signature.role.lateral_slope?;
        Some(slope(ABOUT_M_S) * of.values[0].max(of.values[1]))
    };
    let drag_n_s_m: f64 = all.iter().filter_map(drag_n_s_m).sum();
    term.values[0].abs() < ORDINARY_HEIGHT_M * drag_n_s_m
}
