//! The change of the angular momentum in weak form, per entry of the inertia.

use crate::regression::{RATE_PAIRS, gyroscopic_from_products, momentum_regressor};
use nalgebra::Vector3;

/// For each entry of the inertia (xx xy xz yy yz zz): torque rows per kg m^2, of body rates, rad/s, by the weak form's derivatives of
/// a series at its rows.
pub(super) fn momentum_rows(
    rates: &[Vector3<f64>],
    weak: impl Fn(usize, &[f64]) -> Vec<f64>,
) -> [[Vec<f64>; 3]; 6] {
    let turning = [0, 1, 2].map(|axis| weak(1, &rates.iter().map(|w| w[axis]).collect::<Vec<_>>()));
    let products = RATE_PAIRS.map(|(i, j)| weak(0, &rates.iter().map(|w| w[i] * w[j]).collect::<Vec<f64>>()));
    let mut out: [[Vec<f64>; 3]; 6] = Default::default();
    for row in 0..turning[0].len() {
        let turning = Vector3::from_fn(|axis, _| turning[axis][row]);
        let phi = momentum_regressor(0.0, &turning)
            + gyroscopic_from_products(&std::array::from_fn(|k| products[k][row]));
        for (entry, axes) in out.iter_mut().enumerate() {
            for (axis, values) in axes.iter_mut().enumerate() {
                values.push(phi[(1 + axis, 1 + entry)]);
            }
        }
    }
    out
}
