//! Signature: an offset of the centre of mass.

use crate::diagnose::named::Named;
use crate::diagnose::picture::{Over, Picture};
use crate::diagnose::signature::{Naming, OfTheVehicle, Role, Signature};
use crate::diagnose::usual_size::UsualSize;
use crate::diagnose::wording::{Clause, Size, Words};
use crate::physics::effects::ComOffset;
use crate::text::{significant, with_error};

/// Least standard error of the centre of mass, m. A position is not defined better on a vehicle.
const NUISANCE_M: f64 = 0.000_15;
/// Offset that is ordinary, as a share of the mean arm: four rotors that differ by 2 % each turn the vehicle as much, and rotors do. It has no
/// name, and is in the model where it is certain and no rotor is weak: without it, what else turns the vehicle would be biased.
const ORDINARY: f64 = 0.01;
/// Largest change of the centre of mass by a battery pack that was put back in another place, m. Set by judgement:
/// with more another vehicle would pass for a battery that was put back, with less each battery would be another
/// vehicle. Flights of one Crazyflie, whose battery was changed, differ by 2.3 mm.
pub(in crate::diagnose) const REPACKED_M: f64 = 0.003;

/// A centre of mass that is not where the vehicle file has it.
pub static SIGNATURE: Signature = Signature {
    forms: |_| vec![SIGNATURE.form(&[0.0; 3], &[0, 1])],
    naming: Naming { least: NUISANCE_M, least_of_arm: ORDINARY, ..Naming::PLAIN },
    role: Role {
        of_the_loading: true,
        of_the_vehicle: Some(OfTheVehicle { slots: &[0, 1, 2], least_difference: REPACKED_M }),
        ..Role::NONE
    },
    picture: Picture::of(&[3, 4], Over::Thrust),
    sizes: &[("x", UsualSize::Of(0.005)), ("y", UsualSize::Of(-0.004)), ("z", UsualSize::Of(0.0))],
    ..Signature::of(
        &ComOffset,
        &[0, 1, 2],
        Words {
            clause: Clause::Own(|named, _| clause(named)),
            size: Size::Norm { factor: 1e3, unit: "mm" },
            limit: Some(|limit| format!("a centre of mass {} mm off", significant(1e3 * limit, 2))),
            told_if_absent: Some(1),
            ..Words::of("a centre of mass that is off")
        },
    )
};

/// A clause with sides in place of signs, without values that were not estimated.
fn clause(named: &Named) -> String {
    let side = |name: &str, plus: &str, minus: &str| {
        let p = named.get(name).filter(|p| p.std > 0.0)?;
        let side = if p.value < 0.0 { minus } else { plus };
        Some(format!("{} mm {side}", with_error(1e3 * p.value.abs(), 1e3 * p.std)))
    };
    let sides: Vec<String> =
        [side("x", "forward", "aft"), side("y", "to the left", "to the right"), side("z", "above", "below")]
            .into_iter()
            .flatten()
            .collect();
    format!(
        "The centre of mass is {} of where the vehicle file has it: thrust turns the vehicle about it",
        sides.join(" and ")
    )
}
