//! Signature: a change of mass in flight.

use crate::diagnose::picture::{Over, Picture};
use crate::diagnose::recorded::{Need, Recorded};
use crate::diagnose::signature::{EffectTerm, Form, GridScale, Joint, Naming, Refinement, Role, Signature};
use crate::diagnose::usual_size::UsualSize;
use crate::diagnose::wording::{Clause, Size, Words};
use crate::diagnose::words;
use crate::physics::effects::MassChange;
use crate::text::significant;

/// Step between the moments that are tried, s. A grid: the moment is refined afterwards.
const EVERY_S: f64 = 4.0;

/// A change of less than this share of the mass gets no name: slow errors of the accelerometer and of the thrust law
/// are as large.
pub(super) const LEAST_OF_MASS: f64 = 0.01;

/// A mass that changes at a moment of the flight.
pub static SIGNATURE: Signature = Signature {
    needs: &[Need::OneFlight],
    forms: |recorded| {
        terms(recorded).into_iter().map(|term| Form { term, instead_of_nuisance: false }).collect()
    },
    refinement: Refinement {
        // s
        grid: Some(GridScale::Even { slot: 0, step: 0.5, least: 0.03 }),
        ..Refinement::NONE
    },
    naming: Naming { extra_z: 1.0, least_of_mass: LEAST_OF_MASS, ..Naming::PLAIN },
    role: Role { moment: Some(0), by_motion: false, ..Role::NONE },
    joint: Joint { forms: Some(|recorded, _| terms(recorded)), ..Joint::PLAIN },
    picture: Picture::of(&[2], Over::Time),
    sizes: &[("time", UsualSize::Of(26.0)), ("delta", UsualSize::PerMass(-0.08))],
    ..Signature::of(
        &MassChange,
        &[1],
        Words {
            clause: Clause::Own(|named, vehicle| {
                format!(
                    "The mass changed in flight: {} kg ({} %) from {} s on",
                    named.said("delta", 1.0),
                    significant(100.0 * named.value("delta") / vehicle.body.mass_kg, 2),
                    named.said("time", 1.0)
                )
            }),
            size: Size::Own(
                |named| {
                    let delta = words::said(named, "delta", 1.0, "kg")?;
                    Some(format!("{delta} at {} s", significant(named.value("time"), 3)))
                },
                |named| named.get("delta").map(|delta| (delta.value, delta.std)),
            ),
            ..Words::of("a change of mass")
        },
    )
};

fn terms(recorded: &Recorded) -> Vec<EffectTerm> {
    let Some(trace) = recorded.flights.first() else { return Vec::new() };
    let (Some(first), Some(last)) = (trace.centers.first(), trace.centers.last()) else { return Vec::new() };
    let (first_s, last_s) = (trace.grid.time_s(*first), trace.grid.time_s(*last));
    let mut out = Vec::new();
    let mut time_s = first_s + EVERY_S;
    while time_s < last_s - 0.5 * EVERY_S {
        out.push(SIGNATURE.term(&[time_s, 0.0], &[1]));
        time_s += EVERY_S;
    }
    out
}
