//! Mass and inertia as a body has them.

use nalgebra::{Matrix3, Vector3};

use super::check::Check;
use super::faults::Faults;
use super::vehicle_file::{BodyTable, InertiaTable};
use crate::vehicle::RigidBody;

/// Largest principal moment over the sum of the other two, from which on no body is meant. Measured moments of flat vehicles exceed the
/// sum by their errors. Set by judgement.
const MOST_OF_OTHERS: f64 = 1.5;

/// The body of a vehicle file, read or to be written.
pub(super) fn rigid_body(check: &Check<'_>, table: &BodyTable, faults: &mut Faults) -> RigidBody {
    let mass_kg = faults.number(check.positive("body.mass", table.mass));
    let center = check.finite_vector("body.center_of_mass", table.center_of_mass);
    let center_of_mass_m = faults.take(center, Vector3::zeros());
    let (inertia, before) = (&table.inertia, faults.count());
    for (key, value) in [("xx", inertia.xx), ("yy", inertia.yy), ("zz", inertia.zz)] {
        faults.number(check.positive(&format!("body.inertia.{key}"), value));
    }
    for (key, value) in [("xy", inertia.xy), ("xz", inertia.xz), ("yz", inertia.yz)] {
        faults.number(check.finite(&format!("body.inertia.{key}"), value));
    }
    let tensor = inertia_tensor(inertia);
    // factorisations of infinities and of NaN do not end
    if faults.count() == before && tensor.iter().all(|entry| entry.is_finite()) {
        let moments = tensor.symmetric_eigenvalues();
        let (smallest, largest) = (moments.min(), moments.max());
        let others = moments.sum() - largest;
        if smallest <= 0.0 {
            let came = format!("a smallest principal moment of {smallest:.3e} kg m^2");
            faults.check(Err(check.refuse("body.inertia", "a positive definite tensor", came)));
        } else if largest > MOST_OF_OTHERS * others {
            let expected = format!(
                "a largest principal moment of at most the sum of the other two, {others:.3e} kg m^2"
            );
            faults.check(Err(check.refuse("body.inertia", expected, format!("{largest:.3e} kg m^2"))));
        }
    }
    let gyroscopic = faults.number(check.share("body.gyroscopic", table.gyroscopic.unwrap_or(1.0)));
    RigidBody { mass_kg, inertia_kg_m2: tensor, center_of_mass_m, gyroscopic }
}

fn inertia_tensor(table: &InertiaTable) -> Matrix3<f64> {
    Matrix3::new(
        table.xx, table.xy, table.xz, //
        table.xy, table.yy, table.yz, //
        table.xz, table.yz, table.zz,
    )
}
