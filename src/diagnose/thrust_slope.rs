//! The slope of the force over the commanded thrust, if both have noise.
//!
//! Commands that react to noise hardly move the vehicle. The slope by least squares is then too small, which looks like a bent
//! thrust curve. The slope of the reverse regression is too large. The true slope lies between both (Frisch 1934).

use super::fit::Fitted;
use super::trace::Trace;
use crate::physics::Airframe;

/// Whether the noise of commands and accelerometer alone may have bent the thrust curve: the slope of the stated law lies between those
/// of both regressions.
pub(super) fn may_be_noise(flights: &[Trace], fitted: &Fitted) -> bool {
    let Ok(airframe) = Airframe::new(&fitted.base.vehicle) else { return false };
    let mass_kg = fitted.base.vehicle.body.mass_kg;
    let mut pairs: Vec<(f64, f64)> = Vec::new();
    for trace in flights {
        let thrust = trace.felt_n(&airframe, fitted.base.latency);
        let thrust: Vec<f64> = thrust.each().map(|rotors| rotors.iter().sum()).collect();
        let Some([.., force]) = trace.weak_specific_force().first() else { return false };
        let measured = force.iter().map(|force| mass_kg * force).collect();
        pairs.extend(about_mean(trace.weak(0, &thrust)).into_iter().zip(about_mean(measured)));
    }
    slopes(&pairs).is_some_and(|(least, greatest)| (least..=greatest).contains(&1.0))
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
}
