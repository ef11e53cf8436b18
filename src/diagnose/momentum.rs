//! The change of the angular momentum in weak form, per entry of the inertia.

use crate::estimate::INERTIA_ENTRIES;
use crate::regression::{RATE_PAIRS, gyroscopic_from_products, momentum_regressor};
use nalgebra::{Matrix3, Vector3};
use std::borrow::Cow;

/// For each entry of the inertia (xx xy xz yy yz zz): torque rows about body x, y, z, per kg m^2.
pub(super) type MomentumRows = [[Vec<f64>; 3]; 6];

/// Measurements of force and momentum in weak form.
#[derive(Debug)]
pub(super) struct WeakMotion {
    /// m/s^2, body, for each available measurement, the accelerometer's first
    pub(super) specific_force: Vec<[Vec<f64>; 3]>,
    pub(super) momentum: Momentum,
}

/// The change of the angular momentum of a measured motion.
#[derive(Debug)]
pub(super) struct Momentum {
    /// of a rigid body
    all: MomentumRows,
    /// the gyroscopic part of it
    gyroscopic: MomentumRows,
}

impl Momentum {
    /// Of body rates, rad/s, by the weak form's derivatives of a series at its rows.
    pub(super) fn of(rates: &[Vector3<f64>], weak: impl Fn(usize, &[f64]) -> Vec<f64>) -> Self {
        let turning = [0, 1, 2].map(|axis| weak(1, &rates.iter().map(|w| w[axis]).collect::<Vec<_>>()));
        let products =
            RATE_PAIRS.map(|(i, j)| weak(0, &rates.iter().map(|w| w[i] * w[j]).collect::<Vec<f64>>()));
        let mut out = Self { all: Default::default(), gyroscopic: Default::default() };
        for row in 0..turning[0].len() {
            let turning = Vector3::from_fn(|axis, _| turning[axis][row]);
            let gyroscopic = gyroscopic_from_products(&std::array::from_fn(|k| products[k][row]));
            let all = momentum_regressor(0.0, &turning) + gyroscopic;
            for (to, phi) in [(&mut out.all, all), (&mut out.gyroscopic, gyroscopic)] {
                for (entry, axes) in to.iter_mut().enumerate() {
                    for (axis, values) in axes.iter_mut().enumerate() {
                        values.push(phi[(1 + axis, 1 + entry)]);
                    }
                }
            }
        }
        out
    }

    /// With each entry's rows as `of` makes them.
    pub(super) fn map(self, of: impl Fn([Vec<f64>; 3]) -> [Vec<f64>; 3]) -> Self {
        Self { all: self.all.map(&of), gyroscopic: self.gyroscopic.map(&of) }
    }

    /// Of a body on which this share of the gyroscopic torque acts.
    pub(super) fn with_share(&self, gyroscopic: f64) -> Cow<'_, MomentumRows> {
        if gyroscopic == 1.0 {
            return Cow::Borrowed(&self.all);
        }
        let mut out = self.all.clone();
        for (out, part) in out.iter_mut().flatten().zip(self.gyroscopic.iter().flatten()) {
            out.iter_mut().zip(part).for_each(|(all, part)| *all += (gyroscopic - 1.0) * part);
        }
        Cow::Owned(out)
    }

    /// The whole gyroscopic torque of an inertia, kg m^2: rows about body x, y, z, N m.
    pub(super) fn gyroscopic_nm(&self, inertia_kg_m2: &Matrix3<f64>) -> [Vec<f64>; 3] {
        let six = INERTIA_ENTRIES.map(|entry| inertia_kg_m2[entry]);
        let of = |axis: usize, row: usize| -> f64 {
            self.gyroscopic.iter().zip(six).map(|(axes, moment)| axes[axis][row] * moment).sum()
        };
        std::array::from_fn(|axis| (0..self.gyroscopic[0][axis].len()).map(|row| of(axis, row)).collect())
    }
}
