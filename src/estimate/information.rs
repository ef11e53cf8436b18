//! Combined information of windows of a flight that are evaluated one by one and then released.

use super::result::Estimated;
use super::theta::{THETA, Theta, ThetaCovariance};
use super::weak::{WeakEstimate, priors};
use nalgebra::{DMatrix, DVector};

/// Information (inverse covariance) of one or several windows of one vehicle about all parameters of the weak form. The
/// nuisances are common: latency, trim and damping are the same in all windows.
#[derive(Debug, Clone, PartialEq)]
pub struct WeakInformation {
    matrix: DMatrix<f64>,
    /// matrix times estimate
    weighted: DVector<f64>,
    windows: usize,
    /// nuisances with the standard deviations of their priors
    priors: Vec<(usize, f64)>,
    /// best share of each torque's variance that the rigid body explains in a window
    explained: Option<[f64; 3]>,
}

impl WeakInformation {
    /// Information of one window.
    #[must_use]
    pub fn of(estimate: &WeakEstimate) -> Self {
        let covariance = &estimate.solution.covariance;
        let count = covariance.nrows();
        let deviation = DVector::from_fn(count, |i, _| covariance[(i, i)].max(0.0).sqrt());
        let used: Vec<usize> =
            (0..count).filter(|&i| deviation[i] > 0.0 && estimate.solution.theta[i].is_finite()).collect();
        let correlation = DMatrix::from_fn(used.len(), used.len(), |i, j| {
            covariance[(used[i], used[j])] / (deviation[used[i]] * deviation[used[j]])
        });
        // a sandwich that is not positive definite speaks for its diagonal alone
        let inverse = correlation
            .cholesky()
            .map_or_else(|| DMatrix::identity(used.len(), used.len()), |factor| factor.inverse());
        let mut matrix = DMatrix::zeros(count, count);
        for (i, &row) in used.iter().enumerate() {
            for (j, &column) in used.iter().enumerate() {
                matrix[(row, column)] = inverse[(i, j)] / (deviation[row] * deviation[column]);
            }
        }
        let theta = estimate.solution.theta.map(|value| if value.is_finite() { value } else { 0.0 });
        let priors = priors(theta[0]);
        let explained = Estimated::of(estimate).explained;
        Self { weighted: &matrix * theta, matrix, windows: 1, priors, explained }
    }

    /// Adds the information of another window.
    pub fn add(&mut self, other: &Self) {
        self.matrix += &other.matrix;
        self.weighted += &other.weighted;
        self.windows += other.windows;
        // the liveliest window says whether a rigid body moves so
        self.explained = match (self.explained, other.explained) {
            (Some(a), Some(b)) => Some(std::array::from_fn(|axis| a[axis].max(b[axis]))),
            (a, b) => a.or(b),
        };
    }

    /// The common estimate of the windows and its covariance; NaN for parameters without information.
    #[must_use]
    pub fn combined(&self) -> Estimated {
        let mut matrix = self.matrix.clone();
        let used: Vec<usize> = (0..matrix.nrows()).filter(|&i| matrix[(i, i)] > 0.0).collect();
        for &(parameter, deviation) in &self.priors {
            if let Some(at) = used.iter().position(|&i| i == parameter) {
                matrix[(parameter, parameter)] = self.without_repeats(&used, at, deviation.powi(-2));
            }
        }
        let scale: Vec<f64> = used.iter().map(|&i| matrix[(i, i)].sqrt()).collect();
        let scaled = DMatrix::from_fn(used.len(), used.len(), |i, j| {
            matrix[(used[i], used[j])] / (scale[i] * scale[j])
        });
        let inverse = scaled.cholesky().map(|factor| factor.inverse());
        let mut estimated = Estimated {
            theta: Theta::from_element(f64::NAN),
            covariance: ThetaCovariance::from_element(f64::NAN),
            explained: self.explained,
            by_wider_window: None,
            by_guessed_curve: None,
            torque_exponent: None,
        };
        let Some(inverse) = inverse else { return estimated };
        let of_theta = used.iter().enumerate().filter(|(_, parameter)| **parameter < THETA);
        for (i, &row) in of_theta.clone() {
            let terms = used.iter().enumerate();
            estimated.theta[row] =
                terms.map(|(j, &k)| inverse[(i, j)] / (scale[i] * scale[j]) * self.weighted[k]).sum();
            for (j, &column) in of_theta.clone() {
                estimated.covariance[(row, column)] = inverse[(i, j)] / (scale[i] * scale[j]);
            }
        }
        estimated
    }

    /// Information about a nuisance with its prior counted once, although each window contains it. At least the prior's
    /// information remains in addition to the part of the other parameters.
    fn without_repeats(&self, used: &[usize], at: usize, prior: f64) -> f64 {
        let parameter = used[at];
        let repeated = prior * self.windows.saturating_sub(1) as f64;
        let others: Vec<usize> = (0..used.len()).filter(|&i| i != at).map(|i| used[i]).collect();
        let scale: Vec<f64> = others.iter().map(|&i| self.matrix[(i, i)].sqrt()).collect();
        let rest = DMatrix::from_fn(others.len(), others.len(), |i, j| {
            self.matrix[(others[i], others[j])] / (scale[i] * scale[j])
        });
        let coupling = DVector::from_fn(others.len(), |i, _| self.matrix[(others[i], parameter)] / scale[i]);
        let taken = rest.cholesky().map_or(0.0, |factor| coupling.dot(&factor.solve(&coupling)));
        (self.matrix[(parameter, parameter)] - repeated).max(taken + prior)
    }
}
