//! Fits of a power spectrum.

use nalgebra::{DMatrix, DVector};

/// A spectrum as a sum of shapes, fitted by Whittle's likelihood.
#[derive(Debug, Clone)]
pub struct Whittle {
    /// of each shape, not negative
    pub coefficients: Vec<f64>,
    /// of the whole at each ordinate
    pub spectrum: Vec<f64>,
    /// `sum ln S + I/S`
    pub deviance: f64,
}

/// Fits `power` (one an ordinate) by `shapes` (each one value an ordinate); `None` where nothing fits.
#[must_use]
pub fn whittle(power: &[f64], shapes: &[&[f64]]) -> Option<Whittle> {
    let count = power.len();
    if count < shapes.len() + 2 {
        return None;
    }
    let mean = power.iter().sum::<f64>() / count as f64;
    if mean.is_nan() || mean <= 0.0 {
        return None;
    }
    let mut spectrum = vec![mean; count];
    let mut coefficients = vec![0.0; shapes.len()];
    for _ in 0..25 {
        let next = weighted_fit(power, shapes, &spectrum)?;
        let moved = next.iter().zip(&coefficients).any(|(a, b)| (a - b).abs() > 1e-5 * a.abs().max(b.abs()));
        coefficients = next;
        spectrum = (0..count)
            .map(|i| shapes.iter().zip(&coefficients).map(|(s, c)| s[i] * c).sum::<f64>().max(1e-9 * mean))
            .collect();
        if !moved {
            break;
        }
    }
    let deviance = power.iter().zip(&spectrum).map(|(i, s)| s.ln() + i / s).sum();
    Some(Whittle { coefficients, spectrum, deviance })
}

/// Least squares weighted by the inverse square of `spectrum`, negative shapes left out.
fn weighted_fit(power: &[f64], shapes: &[&[f64]], spectrum: &[f64]) -> Option<Vec<f64>> {
    let mut used: Vec<usize> = (0..shapes.len()).collect();
    while !used.is_empty() {
        let size = used.len();
        let mut normal = DMatrix::<f64>::zeros(size, size);
        let mut right = DVector::<f64>::zeros(size);
        for (row, (power, spectrum)) in power.iter().zip(spectrum).enumerate() {
            let weight = spectrum.powi(-2);
            for (a, &i) in used.iter().enumerate() {
                right[a] += weight * shapes[i][row] * power;
                for (b, &j) in used.iter().enumerate() {
                    normal[(a, b)] += weight * shapes[i][row] * shapes[j][row];
                }
            }
        }
        let scale = normal.diagonal().map(|d| if d > 0.0 { d.sqrt().recip() } else { 0.0 });
        let scaled = DMatrix::from_fn(size, size, |i, j| normal[(i, j)] * scale[i] * scale[j]);
        let solved = scaled.cholesky()?.solve(&right.component_mul(&scale)).component_mul(&scale);
        let least = (0..size).min_by(|&a, &b| (solved[a] / scale[a]).total_cmp(&(solved[b] / scale[b])))?;
        if solved[least] >= 0.0 {
            let mut out = vec![0.0; shapes.len()];
            used.iter().zip(solved.iter()).for_each(|(&place, value)| out[place] = *value);
            return Some(out);
        }
        used.remove(least);
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sum_of_shapes_is_found_and_none_is_negative() {
        let shapes: [Vec<f64>; 2] = [
            (0..200).map(|i| 1.0 + f64::from(i)).collect(),
            (0..200).map(|i| 300.0 / (1.0 + f64::from(i))).collect(),
        ];
        let power: Vec<f64> = (0..200).map(|i| 2.0 * shapes[0][i] + 5.0 * shapes[1][i]).collect();
        let fit = whittle(&power, &[&shapes[0], &shapes[1]]).unwrap();
        assert!((fit.coefficients[0] - 2.0).abs() < 1e-3 && (fit.coefficients[1] - 5.0).abs() < 1e-3);
        let only = whittle(&shapes[0], &[&shapes[0], &shapes[1]]).unwrap();
        assert!(only.coefficients.iter().all(|c| *c >= 0.0));
    }
}
