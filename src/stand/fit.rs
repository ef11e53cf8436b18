//! Straight least squares on a few columns, with standard errors from what is left.

use nalgebra::{DMatrix, DVector};

/// A value and its standard error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measured {
    /// in the unit of what it is of
    pub value: f64,
    /// in the same unit
    pub std: f64,
}

/// Coefficients of columns.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Fit {
    pub values: DVector<f64>,
    pub covariance: DMatrix<f64>,
    /// share of the squares of what is fitted
    pub explained: f64,
    /// what is left, row by row
    pub left: DVector<f64>,
}

impl Fit {
    /// `columns` times values is `wanted`, in the mean; `None` where the columns do not tell.
    pub(super) fn of(columns: &[Vec<f64>], wanted: &[f64]) -> Option<Self> {
        let (rows, count) = (wanted.len(), columns.len());
        if rows <= count {
            return None;
        }
        let matrix = DMatrix::from_fn(rows, count, |row, column| columns[column][row]);
        let wanted = DVector::from_column_slice(wanted);
        let inverse = (matrix.transpose() * &matrix).try_inverse()?;
        let values = &inverse * matrix.transpose() * &wanted;
        let left = &wanted - &matrix * &values;
        let variance = left.norm_squared() / (rows - count) as f64;
        let all = wanted.norm_squared();
        let explained = if all > 0.0 { 1.0 - left.norm_squared() / all } else { 0.0 };
        let is_finite = values.iter().chain(inverse.iter()).all(|value| value.is_finite());
        is_finite.then(|| Self { values, covariance: inverse * variance, explained, left })
    }

    pub(super) fn measured(&self, index: usize) -> Measured {
        Measured { value: self.values[index], std: self.covariance[(index, index)].max(0.0).sqrt() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_found_with_the_error_that_its_scatter_gives() {
        let x: Vec<f64> = (1..=100).map(f64::from).collect();
        let y: Vec<f64> = x.iter().map(|x| 2.0 * x + if *x % 2.0 == 0.0 { 1.0 } else { -1.0 }).collect();
        let fit = Fit::of(&[x], &y).unwrap();
        let Measured { value, std } = fit.measured(0);
        // sum of x^2 is 338350
        assert!((value - 2.0).abs() < 2.0 * std && (std - 1.0 / 338_350.0_f64.sqrt()).abs() < 1e-4);
        assert!(fit.explained > 0.999);
        assert_eq!(Fit::of(&[vec![1.0, 1.0, 1.0], vec![1.0, 1.0, 1.0]], &[1.0, 2.0, 3.0]), None);
    }
}
