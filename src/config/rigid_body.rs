//! Mass and inertia as a body has them.

use nalgebra::Matrix3;

use super::ConfigError;
use super::check::Check;
use super::vehicle_file::{BodyTable, InertiaTable};
use crate::vehicle::RigidBody;

/// The body of a vehicle file, read or to be written.
pub(super) fn rigid_body(check: &Check<'_>, table: &BodyTable) -> Result<RigidBody, ConfigError> {
    let inertia = &table.inertia;
    for (key, value) in [("xx", inertia.xx), ("yy", inertia.yy), ("zz", inertia.zz)] {
        check.positive(&format!("body.inertia.{key}"), value)?;
    }
    for (key, value) in [("xy", inertia.xy), ("xz", inertia.xz), ("yz", inertia.yz)] {
        check.finite(&format!("body.inertia.{key}"), value)?;
    }
    let tensor = inertia_tensor(inertia);
    let smallest = tensor.symmetric_eigenvalues().min();
    if smallest <= 0.0 {
        let came = format!("a smallest principal moment of {smallest:.3e} kg m^2");
        return Err(check.refuse("body.inertia", "a positive definite tensor", came));
    }
    Ok(RigidBody {
        mass_kg: check.positive("body.mass", table.mass)?,
        inertia_kg_m2: tensor,
        center_of_mass_m: check.finite_vector("body.center_of_mass", table.center_of_mass)?,
    })
}

fn inertia_tensor(table: &InertiaTable) -> Matrix3<f64> {
    Matrix3::new(
        table.xx, table.xy, table.xz, //
        table.xy, table.yy, table.yz, //
        table.xz, table.yz, table.zz,
    )
}
