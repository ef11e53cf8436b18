//! The slope of the force over the commanded thrust, if both have noise.
//!
//! Commands that react to noise hardly move the vehicle. The slope by least squares is then too small, which looks like a bent
//! thrust curve. The slope of the reverse regression is too large. The true slope lies between both (Frisch 1934).

use super::fit::Fitted;
use super::trace::Trace;
use crate::physics::Airframe;

/// Whether the noise of commands and accelerometer alone may have bent the thrust curve: the slope of the stated law lies between those
/// of both regressions, or as near to one as its standard error allows.
pub(super) fn may_be_noise(flights: &[Trace], fitted: &Fitted) -> bool {
    let Ok(airframe) = Airframe::new(&fitted.base.vehicle) else { return false };
    let mut pairs: Vec<(f64, f64)> = Vec::new();
    for trace in flights {
        let mass_kg = fitted.base.vehicle.body.mass_kg + trace.own.payload_kg;
        let thrust = trace.felt_n(&airframe, fitted.base.latency);
        let thrust: Vec<f64> = thrust.each().map(|rotors| rotors.iter().sum()).collect();
        let Some([.., force]) = trace.weak_specific_force().first() else { return false };
        let measured = force.iter().map(|force| mass_kg * force).collect();
        pairs.extend(about_mean(trace.weak(0, &thrust)).into_iter().zip(about_mean(measured)));
    }
    // where the force does not even grow with the thrust, nothing tells the slope
    let Some(((least, greatest), (least_std, greatest_std))) = slopes(&pairs).zip(errors(&pairs)) else {
        return true;
    };
    (least - SIGMAS * least_std..=greatest + SIGMAS * greatest_std).contains(&1.0)
}

/// Standard errors by which each slope may be wrong. The usual two.
const SIGMAS: f64 = 2.0;
/// Parts of the flights that are left out in turn. They are longer than the weak form's window, over which rows are alike.
const PARTS: usize = 10;

/// Standard errors of both slopes, by leaving each part of the rows out in turn (jackknife, Quenouille 1956); `None` where the rest does
/// not grow together.
fn errors(pairs: &[(f64, f64)]) -> Option<(f64, f64)> {
    let length = pairs.len().div_ceil(PARTS).max(1);
    let without = |part: usize| {
        let (from, to) = (part * length, ((part + 1) * length).min(pairs.len()));
        slopes(&[&pairs[..from.min(to)], &pairs[to..]].concat())
    };
    let each: Vec<(f64, f64)> = (0..pairs.len().div_ceil(length)).map(without).collect::<Option<_>>()?;
    let count = each.len().max(1) as f64;
    let error = |of: fn(&(f64, f64)) -> f64| {
        let mean = each.iter().map(of).sum::<f64>() / count;
        ((count - 1.0) / count * each.iter().map(|one| (of(one) - mean).powi(2)).sum::<f64>()).sqrt()
    };
    Some((error(|(least, _)| *least), error(|(_, greatest)| *greatest)))
}

/// Slopes of the second on the first of each pair, and of the first on the second turned around; `None` where they do not grow together.
fn slopes(pairs: &[(f64, f64)]) -> Option<(f64, f64)> {
    let sum = |of: fn(&(f64, f64)) -> f64| pairs.iter().map(of).sum::<f64>();
    let (first, second, both) = (sum(|(x, _)| x * x), sum(|(_, y)| y * y), sum(|(x, y)| x * y));
    (both > 0.0).then(|| (both / first, second / both))
}

fn about_mean(mut values: Vec<f64>) -> Vec<f64> {
    let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
    values.iter_mut().for_each(|value| *value -= mean);
    values
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A slope of 1 with noise in both, by hand: sums of squares 10 and 10, of products 8.
    #[test]
    fn the_slope_lies_between_both_regressions() {
        let noisy = [(2.0, 1.0), (1.0, 2.0), (-2.0, -1.0), (-1.0, -2.0)];
        assert_eq!(slopes(&noisy), Some((0.8, 1.25)));
        let exact = [(1.0, 0.8), (-1.0, -0.8)];
        let (least, greatest) = slopes(&exact).unwrap();
        assert!((least - 0.8).abs() < 1e-12 && (greatest - 0.8).abs() < 1e-12);
        assert_eq!(slopes(&[(1.0, -1.0), (-1.0, 1.0)]), None);
    }

    /// Of rows that all have one slope nothing is uncertain; of two groups with slopes 0.8 and 1.2 the mean is 1.0 +- about 0.06 by ten parts
    /// that alternate.
    #[test]
    fn the_scatter_of_the_parts_is_the_error() {
        let of = |slope: fn(usize) -> f64| -> Vec<(f64, f64)> {
            let sign = |row: usize| if row.is_multiple_of(2) { 1.0 } else { -1.0 };
            (0..100).map(|row| (sign(row), slope(row / 10) * sign(row))).collect()
        };
        assert!(errors(&of(|_| 0.8)).unwrap().0 < 1e-12);
        let (least_std, _) = errors(&of(|part| if part.is_multiple_of(2) { 0.8 } else { 1.2 })).unwrap();
        // the standard error of the mean of ten values that are 0.2 off
        assert!((least_std - 0.2 / 3.0).abs() < 1e-9, "{least_std}");
    }
}
