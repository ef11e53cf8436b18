//! Signature: drag with the square of the airspeed.

use crate::diagnose::picture::{Over, Picture};
use crate::diagnose::recorded::Need;
use crate::diagnose::signature::{Joint, Naming, Role, Signature};
use crate::diagnose::usual_size::UsualSize;
use crate::diagnose::wording::{Clause, Size, Words};
use crate::diagnose::words::across;
use crate::physics::effects::QuadraticDrag;

/// Drag with the square of the airspeed.
pub static SIGNATURE: Signature = Signature {
    needs: &[Need::Velocity],
    forms: |_| {
        // of a round body, or of flat faces
        let of = |by_face: f64| {
            let values = [0.0, 0.0, 0.0, by_face];
            [SIGNATURE.form(&values, &[0, 1]), SIGNATURE.form(&values, &[0, 1, 2])]
        };
        [0.0, 1.0].into_iter().flat_map(of).collect()
    },
    // 1/m: forces scale with the mass
    naming: Naming { usual: |_, vehicle| Some(0.12 * vehicle.body.mass_kg), ..Naming::PLAIN },
    role: Role {
        of_air: true,
        // mean of along and across the motion
        lateral_slope: Some(|mean_m_s| 1.5 * mean_m_s),
        vertical: Some(2),
        like_latency: Some(|| SIGNATURE.term(&[0.0; 3], &[0, 1, 2])),
        ..Role::NONE
    },
    joint: Joint {
        forms: Some(|_, _| {
            [1.0, 0.0].map(|by_face| SIGNATURE.term(&[0.0, 0.0, 0.0, by_face], &[0, 1, 2, 3])).to_vec()
        }),
        ..Joint::PLAIN
    },
    picture: Picture::of(&[0, 1, 2], Over::Airspeed),
    sizes: &[
        ("cx", UsualSize::PerMass(0.12)),
        ("cy", UsualSize::PerMass(0.12)),
        ("cz", UsualSize::PerMass(0.12)),
    ],
    ..Signature::of(
        &QuadraticDrag,
        &[0, 1, 2],
        Words {
            clause: Clause::Own(|named, _| {
                format!(
                    "Drag that grows with the square of the airspeed was left out: {}",
                    across(named, ["cx", "cy", "cz"], "N per (m/s)^2")
                )
            }),
            size: Size::Across(["cx", "cy", "cz"]),
            ..Words::of("drag with the square of the airspeed")
        },
    )
};
