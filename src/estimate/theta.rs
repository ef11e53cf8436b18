//! The paper's parameter vector `Theta = [m Ixx Ixy Ixz Iyy Iyz Izz]`.

use crate::vehicle::RigidBody;
use nalgebra::{Matrix3, SMatrix, SVector};

/// Number of rigid-body parameters.
pub const THETA: usize = 7;

/// `[m Ixx Ixy Ixz Iyy Iyz Izz]`, kg and kg m^2; the products are entries of the symmetric tensor.
pub type Theta = SVector<f64, THETA>;
/// Covariance of [`Theta`].
pub type ThetaCovariance = SMatrix<f64, THETA, THETA>;

/// Names as in files and JSON, in `Theta`'s order.
pub const NAMES: [&str; THETA] = ["mass", "ixx", "ixy", "ixz", "iyy", "iyz", "izz"];
/// Units in `Theta`'s order.
pub const UNITS: [&str; THETA] = ["kg", "kg m^2", "kg m^2", "kg m^2", "kg m^2", "kg m^2", "kg m^2"];

/// Places of the moments of inertia in `Theta`.
pub const MOMENTS: [usize; 3] = [1, 4, 6];
/// Row and column of each entry of the inertia, in `Theta`'s order from its second on.
pub const INERTIA_ENTRIES: [(usize, usize); THETA - 1] = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)];

/// `Theta` of a rigid body.
#[must_use]
pub fn theta_of(body: &RigidBody) -> Theta {
    let j = &body.inertia_kg_m2;
    SVector::from([body.mass_kg, j[(0, 0)], j[(0, 1)], j[(0, 2)], j[(1, 1)], j[(1, 2)], j[(2, 2)]])
}

/// The inertia tensor of `Theta`.
#[must_use]
pub fn inertia_of(theta: &Theta) -> Matrix3<f64> {
    let (xx, xy, xz, yy, yz, zz) = (theta[1], theta[2], theta[3], theta[4], theta[5], theta[6]);
    Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)
}

/// The size to which a parameter's error is compared: the parameter itself for mass and moments, `sqrt(Iii Ijj)` for
/// products of inertia.
#[must_use]
pub fn scale_of(theta: &Theta, index: usize) -> f64 {
    let (xx, yy, zz) = (theta[1].abs(), theta[4].abs(), theta[6].abs());
    match index {
        2 => (xx * yy).sqrt(),
        3 => (xx * zz).sqrt(),
        5 => (yy * zz).sqrt(),
        _ => theta[index].abs(),
    }
}
