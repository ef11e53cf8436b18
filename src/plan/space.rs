//! The free part of the series (18): start conditions are eliminated, not penalised.
//!
//! The series is periodic, so what holds at the start holds at the end. Position, velocity and
//! acceleration at `t = 0` are linear in the coefficients `[a_1..a_N b_1..b_N c]`; each axis is written
//! `origin + Z x` with `Z` an orthonormal basis of the coefficients that leave the three at zero.

use crate::trajectory::{FourierAxis, FourierTrajectory};
use nalgebra::{DMatrix, DVector};

/// Path of one instant: x, y, z, psi, each with its first four derivatives.
pub type Path = [[f64; 5]; 4];

/// Start and end of an axis. It is at rest there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum AxisStart {
    /// at this value (m, rad)
    At(f64),
    /// at this value, which is a bound: the axis also has no jerk there, because a path at rest with jerk crosses its
    /// position
    OnBound(f64),
    /// anywhere; the value is a first guess
    Near(f64),
}

impl AxisStart {
    fn value(self) -> f64 {
        match self {
            Self::At(value) | Self::OnBound(value) | Self::Near(value) => value,
        }
    }

    /// Which derivatives vanish at the start, counted from the value itself.
    fn conditions(self) -> std::ops::RangeInclusive<usize> {
        match self {
            Self::At(_) => 0..=2,
            Self::OnBound(_) => 0..=3,
            Self::Near(_) => 1..=2,
        }
    }
}

/// All series of one period and order that start and end at rest at one place.
#[derive(Debug, Clone)]
pub struct SeriesSpace {
    period_s: f64,
    harmonics: usize,
    start: [f64; 4],
    /// (2N+1) x free, one an axis
    bases: [DMatrix<f64>; 4],
    /// first unknown of each axis, and one past the last
    offsets: [usize; 5],
}

/// Dependence of the path of one instant on the unknowns.
#[derive(Debug, Clone)]
pub struct PathRows {
    /// d q^(order) / d x, one row an order, `dimension` wide
    orders: [Vec<f64>; 5],
    start: [f64; 4],
    offsets: [usize; 5],
}

impl SeriesSpace {
    /// `start` is that of x, y, z (m) and psi (rad). Four harmonics leave every kind of start some freedom.
    #[must_use]
    pub fn new(period_s: f64, harmonics: u32, start: [AxisStart; 4]) -> Self {
        let harmonics = (0..harmonics).count();
        let bases = start.map(|start| free_basis(harmonics, start.conditions()));
        let start = start.map(AxisStart::value);
        let mut offsets = [0; 5];
        for (axis, basis) in bases.iter().enumerate() {
            offsets[axis + 1] = offsets[axis] + basis.ncols();
        }
        Self { period_s, harmonics, start, bases, offsets }
    }

    /// Number of unknowns.
    #[must_use]
    pub fn dimension(&self) -> usize {
        self.offsets[4]
    }

    /// The unknowns that belong to one axis.
    #[must_use]
    pub fn unknowns_of(&self, axis: usize) -> std::ops::Range<usize> {
        self.offsets[axis]..self.offsets[axis + 1]
    }

    /// The period, s.
    #[must_use]
    pub fn period_s(&self) -> f64 {
        self.period_s
    }

    /// The series of these unknowns.
    #[must_use]
    pub fn trajectory(&self, unknowns: &DVector<f64>) -> FourierTrajectory {
        let axes = std::array::from_fn(|axis| {
            let free = self.unknowns_of(axis);
            let coefficients = &self.bases[axis] * unknowns.rows(free.start, free.len());
            let n = self.harmonics;
            // velocities a, b are free of the fundamental; the offset carries 1/w_f
            FourierAxis {
                a: coefficients.rows(0, n).iter().copied().collect(),
                b: coefficients.rows(n, n).iter().copied().collect(),
                c: self.start[axis] + coefficients[2 * n] / self.fundamental_rad_s(),
            }
        });
        FourierTrajectory { period_s: self.period_s, axes }
    }

    /// The unknowns that come nearest to a series (least squares over its coefficients).
    #[must_use]
    pub fn unknowns(&self, trajectory: &FourierTrajectory) -> DVector<f64> {
        let mut unknowns = DVector::zeros(self.dimension());
        for (axis, series) in trajectory.axes.iter().enumerate() {
            let offset = (series.c - self.start[axis]) * self.fundamental_rad_s();
            let values = series.a.iter().chain(&series.b).copied().chain([offset]);
            let coefficients = DVector::from_iterator(2 * self.harmonics + 1, values);
            let free = self.unknowns_of(axis);
            unknowns.rows_mut(free.start, free.len()).copy_from(&self.bases[axis].tr_mul(&coefficients));
        }
        unknowns
    }

    /// The dependence at `t_s`.
    #[must_use]
    pub fn rows(&self, t_s: f64) -> PathRows {
        let (n, w) = (self.harmonics, self.fundamental_rad_s());
        let mut raw = vec![[0.0; 5]; 2 * n + 1];
        raw[2 * n][0] = 1.0 / w;
        let mut harmonic = 0.0;
        for l in 0..n {
            harmonic += 1.0;
            let wl = w * harmonic;
            let (s, c) = (wl * t_s).sin_cos();
            raw[l] = [s / wl, c, -wl * s, -wl * wl * c, wl * wl * wl * s];
            raw[n + l] = [-c / wl, s, wl * c, -wl * wl * s, -wl * wl * wl * c];
        }
        let orders = std::array::from_fn(|order| {
            let mut row = Vec::with_capacity(self.dimension());
            for basis in &self.bases {
                let dots = basis
                    .column_iter()
                    .map(|column| column.iter().zip(&raw).map(|(z, r)| z * r[order]).sum::<f64>());
                row.extend(dots);
            }
            row
        });
        PathRows { orders, start: self.start, offsets: self.offsets }
    }

    fn fundamental_rad_s(&self) -> f64 {
        std::f64::consts::TAU / self.period_s
    }
}

impl PathRows {
    /// The path for these unknowns.
    #[must_use]
    pub fn path(&self, unknowns: &DVector<f64>) -> Path {
        std::array::from_fn(|axis| {
            let free = self.offsets[axis]..self.offsets[axis + 1];
            let x = &unknowns.as_slice()[free.clone()];
            std::array::from_fn(|order| {
                let row = &self.orders[order][free.clone()];
                let change: f64 = row.iter().zip(x).map(|(r, x)| r * x).sum();
                if order == 0 { self.start[axis] + change } else { change }
            })
        })
    }

    /// Adds to `gradient` the derivative, by each unknown, of a function with this slope by path entry.
    pub fn pull_back(&self, slope: &Path, gradient: &mut [f64]) {
        for (axis, by_order) in slope.iter().enumerate() {
            let free = self.offsets[axis]..self.offsets[axis + 1];
            for (order, share) in by_order.iter().enumerate().filter(|(_, share)| **share != 0.0) {
                let row = &self.orders[order][free.clone()];
                for (out, value) in gradient[free.clone()].iter_mut().zip(row) {
                    *out += share * value;
                }
            }
        }
    }
}

/// Orthonormal basis of the coefficients `[a b c w_f]` for which these derivatives vanish at `t = 0`.
fn free_basis(harmonics: usize, conditions: std::ops::RangeInclusive<usize>) -> DMatrix<f64> {
    let width = 2 * harmonics + 1;
    let mut rows = DMatrix::zeros(width, 4);
    let mut harmonic = 0.0;
    for l in 0..harmonics {
        harmonic += 1.0;
        rows[(harmonics + l, 0)] = -1.0 / harmonic;
        rows[(l, 1)] = 1.0;
        rows[(harmonics + l, 2)] = harmonic;
        rows[(l, 3)] = harmonic * harmonic;
    }
    rows[(2 * harmonics, 0)] = 1.0;
    let count = conditions.clone().count();
    let across = rows.columns(*conditions.start(), count).into_owned().qr().q();
    let mut basis: Vec<DVector<f64>> = Vec::new();
    for unit in 0..width {
        let mut candidate = DVector::zeros(width);
        candidate[unit] = 1.0;
        // twice: the second pass takes out what rounding left
        for _ in 0..2 {
            let inside = &across * across.tr_mul(&candidate);
            candidate -= inside;
            for other in &basis {
                let share = other.dot(&candidate);
                candidate.axpy(-share, other, 1.0);
            }
        }
        if candidate.norm() > 1e-6 && basis.len() + count < width {
            basis.push(candidate.normalize());
        }
    }
    if basis.is_empty() { DMatrix::zeros(width, 0) } else { DMatrix::from_columns(&basis) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn space() -> SeriesSpace {
        SeriesSpace::new(
            8.0,
            5,
            [AxisStart::At(0.1), AxisStart::At(-0.2), AxisStart::OnBound(0.7), AxisStart::At(0.3)],
        )
    }

    fn some_unknowns(space: &SeriesSpace) -> DVector<f64> {
        let mut value = 0.3;
        DVector::from_fn(space.dimension(), |_, _| {
            value = (value * 7.3_f64).sin();
            value
        })
    }

    #[test]
    fn every_member_starts_at_rest_at_the_start() {
        let space = space();
        assert_eq!(space.dimension(), 31);
        let trajectory = space.trajectory(&some_unknowns(&space));
        for t in [0.0, 8.0] {
            let path = trajectory.derivatives(t);
            for (axis, start) in [0.1, -0.2, 0.7, 0.3].into_iter().enumerate() {
                assert!((path[axis][0] - start).abs() < 1e-12);
                assert!(path[axis][1].abs() < 1e-12 && path[axis][2].abs() < 1e-12);
            }
            assert!(path[2][3].abs() < 1e-11 && path[0][3].abs() > 1e-3);
        }
    }

    #[test]
    fn a_free_start_is_at_rest_anywhere() {
        let start = [AxisStart::Near(1.0); 4];
        let space = SeriesSpace::new(8.0, 4, start);
        assert_eq!(space.dimension(), 28);
        let path = space.trajectory(&some_unknowns(&space)).derivatives(0.0);
        assert!(path.iter().all(|axis| axis[1].abs() < 1e-12 && axis[2].abs() < 1e-12));
        assert!((path[2][0] - 1.0).abs() > 1e-3);
    }

    #[test]
    fn rows_and_series_agree_and_invert() {
        let space = space();
        let unknowns = some_unknowns(&space);
        let trajectory = space.trajectory(&unknowns);
        for t in [0.0, 0.9, 3.3, 7.1] {
            let (direct, by_rows) = (trajectory.derivatives(t), space.rows(t).path(&unknowns));
            for axis in 0..4 {
                for order in 0..5 {
                    assert!((direct[axis][order] - by_rows[axis][order]).abs() < 1e-11);
                }
            }
        }
        assert!((space.unknowns(&trajectory) - unknowns).norm() < 1e-12);
    }
}
