//! `W^T D W` of the stacked regressor (20), and its slope by the unknowns, through the 7 x 7 matrix.
//!
//! The integrand is periodic and smooth, so the mean over equal steps converges geometrically: 64
//! samples a period stand for the 5000 of a 2 ms grid to about ten digits (a test holds them together).

use super::sensitivity::{
    kinematics_of, motion_of, path_slope, regressor_inputs, regressor_slopes, sensitive_motion_of,
};
use super::space::{PathRows, SeriesSpace};
use crate::regression::standard_regressor;
use crate::trajectory::FourierTrajectory;
use nalgebra::{DVector, SMatrix, Vector4};

/// The 7 x 7 matrices of `Theta`.
pub type Matrix7 = SMatrix<f64, 7, 7>;

/// Entries of the upper triangle.
const ENTRIES: usize = 28;

/// The mean of `Phi^T D Phi` over a period.
#[derive(Debug, Clone)]
pub struct GramSampler {
    samples: Vec<PathRows>,
    row_weights: Vector4<f64>,
    gravity_m_s2: f64,
}

/// A Gram matrix with its slope by each unknown.
#[derive(Debug, Clone)]
pub struct SlopedGram {
    /// mean of `Phi^T D Phi`
    pub matrix: Matrix7,
    /// one for each unknown
    pub slopes: Vec<Matrix7>,
}

impl GramSampler {
    /// `count` equal steps over one period; `row_weights` is the diagonal of `D`.
    #[must_use]
    pub fn new(space: &SeriesSpace, count: u32, row_weights: Vector4<f64>, gravity_m_s2: f64) -> Self {
        let step_s = space.period_s() / f64::from(count.max(1));
        let samples = (0..count).map(|k| space.rows(f64::from(k) * step_s)).collect();
        Self { samples, row_weights, gravity_m_s2 }
    }

    /// The mean for a given series, by `count` samples of one period.
    #[must_use]
    pub fn of_series(
        series: &FourierTrajectory,
        count: u32,
        row_weights: Vector4<f64>,
        gravity_m_s2: f64,
    ) -> Matrix7 {
        let step_s = series.period_s / f64::from(count.max(1));
        let mut sum = Matrix7::zeros();
        for k in 0..count {
            let motion = motion_of(&series.derivatives(f64::from(k) * step_s), gravity_m_s2);
            sum += weighted_square(&standard_regressor(&kinematics_of(&motion)), &row_weights);
        }
        sum / f64::from(count.max(1))
    }

    /// The matrix without slopes.
    #[must_use]
    pub fn matrix(&self, unknowns: &DVector<f64>) -> Matrix7 {
        let mut sum = Matrix7::zeros();
        for sample in &self.samples {
            let motion = motion_of(&sample.path(unknowns), self.gravity_m_s2);
            sum += weighted_square(&standard_regressor(&kinematics_of(&motion)), &self.row_weights);
        }
        sum * self.mean_factor()
    }

    /// The matrix and its slopes.
    #[must_use]
    pub fn sloped(&self, unknowns: &DVector<f64>) -> SlopedGram {
        let mut matrix = Matrix7::zeros();
        let width = unknowns.len();
        let mut by_entry = vec![0.0; ENTRIES * width];
        for sample in &self.samples {
            let motion = sensitive_motion_of(&sample.path(unknowns), self.gravity_m_s2);
            let inputs = regressor_inputs(&motion);
            let values = inputs.map(|input| input.value);
            let slopes = regressor_slopes(&values);
            // Phi has no constant part and is of second degree: one more evaluation gives its value
            let plain = motion_of(&sample.path(unknowns), self.gravity_m_s2);
            let phi = standard_regressor(&kinematics_of(&plain));
            matrix += weighted_square(&phi, &self.row_weights);
            let weighted = SMatrix::<f64, 4, 4>::from_diagonal(&self.row_weights) * phi;
            let by_regressor_input = slopes.map(|slope| {
                let half = weighted.tr_mul(&slope);
                half + half.transpose()
            });
            for (entry, (row, column)) in upper_entries().enumerate() {
                let mut gradient = [0.0; super::sensitivity::INPUTS];
                for (slope, input) in by_regressor_input.iter().zip(&inputs) {
                    let share = slope[(row, column)];
                    for (out, value) in gradient.iter_mut().zip(&input.gradient) {
                        *out += share * value;
                    }
                }
                let out = &mut by_entry[entry * width..(entry + 1) * width];
                sample.pull_back(&path_slope(&gradient), out);
            }
        }
        let factor = self.mean_factor();
        let mut slopes = vec![Matrix7::zeros(); width];
        for (entry, (row, column)) in upper_entries().enumerate() {
            for (unknown, slope) in slopes.iter_mut().enumerate() {
                let value = by_entry[entry * width + unknown] * factor;
                slope[(row, column)] = value;
                slope[(column, row)] = value;
            }
        }
        SlopedGram { matrix: matrix * factor, slopes }
    }

    fn mean_factor(&self) -> f64 {
        1.0 / self.samples.len() as f64
    }
}

/// `Phi^T diag(weights) Phi`
#[must_use]
pub fn weighted_square(phi: &SMatrix<f64, 4, 7>, weights: &Vector4<f64>) -> Matrix7 {
    phi.tr_mul(&(SMatrix::<f64, 4, 4>::from_diagonal(weights) * phi))
}

fn upper_entries() -> impl Iterator<Item = (usize, usize)> {
    (0..7).flat_map(|row| (row..7).map(move |column| (row, column)))
}

#[cfg(test)]
mod tests {
    use super::super::space::AxisStart;
    use super::*;

    fn space_and_point() -> (SeriesSpace, DVector<f64>) {
        let start = [AxisStart::At(0.0), AxisStart::At(0.0), AxisStart::Near(1.0), AxisStart::At(0.0)];
        let space = SeriesSpace::new(10.0, 5, start);
        let mut value = 0.4;
        let point = DVector::from_fn(space.dimension(), |_, _| {
            value = (value * 5.1_f64).sin();
            0.15 * value
        });
        (space, point)
    }

    #[test]
    fn slopes_agree_with_differences() {
        let (space, point) = space_and_point();
        let sampler = GramSampler::new(&space, 40, Vector4::new(1.0, 2.0, 3.0, 4.0), 9.81);
        let sloped = sampler.sloped(&point);
        assert!((sloped.matrix - sampler.matrix(&point)).norm() < 1e-10);
        let h = 1e-5;
        for unknown in 0..space.dimension() {
            let mut step = DVector::zeros(space.dimension());
            step[unknown] = h;
            let numeric = (sampler.matrix(&(&point + &step)) - sampler.matrix(&(&point - &step))) / (2.0 * h);
            let error = (numeric - sloped.slopes[unknown]).norm();
            assert!(error < 1e-6 * (1.0 + numeric.norm()), "unknown {unknown}: {error}");
        }
    }

    #[test]
    fn few_samples_stand_for_many() {
        let (space, point) = space_and_point();
        let few = GramSampler::new(&space, 65, Vector4::repeat(1.0), 9.81).matrix(&point);
        let many = GramSampler::of_series(&space.trajectory(&point), 5000, Vector4::repeat(1.0), 9.81);
        assert!((few - many).norm() < 1e-9 * many.norm());
    }
}
