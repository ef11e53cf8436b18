//! Signature: drag in proportion to the airspeed.

use crate::diagnose::named::Named;
use crate::diagnose::picture::{Over, Picture};
use crate::diagnose::recorded::Need;
use crate::diagnose::signature::{Joint, Naming, OfTheVehicle, Role, Signature, Whence};
use crate::diagnose::usual_size::UsualSize;
use crate::diagnose::wording::{Clause, Size, Words};
use crate::diagnose::words::across;
use crate::physics::effects::LinearDrag;
use crate::text::significant;

use super::angular_damping;

/// Slot of the drag along body z.
const DZ: usize = 2;
/// Slot of the share that grows with the rotors' speed.
const WITH_SPEED: usize = 4;

/// Drag in proportion to the airspeed.
pub static SIGNATURE: Signature = Signature {
    needs: &[Need::Velocity],
    forms: |recorded| {
        // of the rotors, at their hubs, or of the body, at its centre
        let at = |at_hubs: f64| {
            let values = [0.0, 0.0, 0.0, at_hubs];
            [SIGNATURE.form(&values, &[0, 1]), SIGNATURE.form(&values, &[0, 1, 2])]
        };
        recorded.shares_at_hubs().iter().copied().flat_map(at).collect()
    },
    naming: Naming {
        // 1/s: forces scale with the mass
        usual: |parameter, vehicle| {
            ["dx", "dy", "dz"].contains(&parameter).then_some(0.3 * vehicle.body.mass_kg)
        },
        ..Naming::PLAIN
    },
    role: Role {
        of_air: true,
        lateral_slope: Some(|_| 1.0),
        with_speed: Some((WITH_SPEED, &[1.0, 1.0])),
        axial: Some(DZ),
        vertical: Some(DZ),
        of_the_vehicle: Some(OfTheVehicle::of(&[0, 1, DZ])),
        damped_by: Some(|| angular_damping::SIGNATURE.whole()),
        like_latency: Some(|| SIGNATURE.term(&[0.0; 4], &[0, 1, 2])),
        ..Role::NONE
    },
    joint: Joint {
        forms: Some(|recorded, asked| {
            // an effect along body z is the same term as the drag's z
            let free: &[usize] = if has_axial_part(asked) { &[0, 1, 3] } else { &[0, 1, 2, 3] };
            let at = |at_hubs: &f64| SIGNATURE.term(&[0.0, 0.0, 0.0, *at_hubs], free);
            recorded.shares_at_hubs().iter().map(at).collect()
        }),
        whence: |_, slot, _, asked| {
            let elsewhere = slot == DZ && has_axial_part(asked);
            elsewhere.then(|| Whence::Given("is the inflow's kz".to_owned()))
        },
        ..Joint::PLAIN
    },
    picture: Picture::of(&[0, 1, 2], Over::Airspeed),
    sizes: &[("dx", UsualSize::PerMass(0.3)), ("dy", UsualSize::PerMass(0.3)), ("dz", UsualSize::Of(0.0))],
    ..Signature::of(
        &LinearDrag,
        &[0, 1, 2],
        Words {
            clause: Clause::Own(|named, vehicle| {
                format!(
                    "Drag was left out: {} ({} 1/s), throughout the flight, growing with airspeed",
                    across(named, ["dx", "dy", "dz"], "N per m/s"),
                    significant(mean(named) / vehicle.body.mass_kg, 2)
                )
            }),
            size: Size::Across(["dx", "dy", "dz"]),
            told_if_absent: Some(0),
            expected_in_motion: Some(0),
            ..Words::of("drag")
        },
    )
};

fn has_axial_part(asked: &[&'static Signature]) -> bool {
    asked.iter().any(|other| other.role.axial_part_of.is_some_and(|of| of.id() == SIGNATURE.id()))
}

/// Mean of the estimated drag along body x and y, N/(m/s).
fn mean(named: &Named) -> f64 {
    let found: Vec<f64> =
        ["dx", "dy"].iter().map(|name| named.value(name)).filter(|value| *value != 0.0).collect();
    found.iter().sum::<f64>() / found.len().max(1) as f64
}
