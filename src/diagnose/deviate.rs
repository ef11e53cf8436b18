//! Chances so small that only their logarithms can be handled.

use statrs::function::gamma::ln_gamma;

/// The normal deviate that is exceeded (on both sides) as seldom as `wald` by a chi square of `size`
/// degrees of freedom; by logarithms, so that nothing underflows.
#[must_use]
pub fn normal_deviate(wald: f64, size: usize) -> f64 {
    if wald.is_nan() || wald <= 0.0 {
        return 0.0;
    }
    if size == 1 {
        return wald.sqrt();
    }
    let target = ln_chi_square_sf(wald, size as f64);
    // ln P(|Z| > z)
    let two_sided = |z: f64| ln_chi_square_sf(z * z, 1.0);
    let (mut low, mut high) = (0.0, wald.sqrt());
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if two_sided(middle) > target { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// Logarithm of the chance that a chi square of `k` degrees of freedom exceeds `x`.
fn ln_chi_square_sf(x: f64, k: f64) -> f64 {
    let (a, h) = (0.5 * k, 0.5 * x);
    if h < a + 30.0 {
        let upper = statrs::function::gamma::checked_gamma_ur(a, h).unwrap_or(0.0);
        return upper.max(f64::MIN_POSITIVE).ln();
    }
    // continued fraction of the upper incomplete gamma function, by Lentz's method
    let mut b = h + 1.0 - a;
    let mut c = f64::MAX.sqrt();
    let mut d = 1.0 / b;
    let mut fraction = d;
    for i in 1..200 {
        let n = f64::from(i);
        let term = -n * (n - a);
        b += 2.0;
        d = 1.0 / (term * d + b);
        c = b + term / c;
        let factor = d * c;
        fraction *= factor;
        if (factor - 1.0).abs() < 1e-12 {
            break;
        }
    }
    a * h.ln() - h - ln_gamma(a) + fraction.ln()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// SciPy: `scipy.stats.norm.isf(scipy.stats.chi2.sf(wald, size) / 2)`; beyond where that underflows mpmath, the root z
    /// of `log(erfc(z / sqrt(2))) - log(gammainc(size / 2, wald / 2, inf, regularized=True))`
    #[test]
    fn deviates_are_those_of_the_same_chance() {
        let known = [
            (0.5, 4, 0.033_217_705_659_310_68),
            (4.0, 2, 1.493_389_410_657_259_4),
            (9.0, 3, 2.179_549_299_204_780_2),
            (30.0, 6, 4.111_507_277_726_657),
            (50.0, 2, 6.759_070_886_879_882),
            (70.0, 2, 8.083_273_181_647_408),
            (100.0, 3, 9.531_239_772_341_49),
            (2000.0, 3, 44.551_137_095_970_08),
            (30_000.0, 6, 173.066_934_448_649_86),
        ];
        for (wald, size, z) in known {
            let found = normal_deviate(wald, size);
            assert!((found / z - 1.0).abs() < 1e-9, "{wald} {size}: {found}, not {z}");
        }
    }

    #[test]
    fn one_coefficient_has_the_root_and_nothing_has_none() {
        assert_eq!(normal_deviate(16.0, 1), 4.0);
        assert_eq!([0.0, -1.0, f64::NAN].map(|wald| normal_deviate(wald, 3)), [0.0; 3]);
    }
}
