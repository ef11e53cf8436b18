//! Tails of distributions, and chances so small that only their logarithms can be handled.

use statrs::distribution::{ChiSquared, ContinuousCDF, FisherSnedecor};
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

/// Chance that an F of `free` degrees of freedom (numerator, denominator) exceeds `f` where nothing is there; 1 where
/// there is no such distribution, or `f` is not a number.
#[must_use]
pub fn f_tail(f: f64, free: (f64, f64)) -> f64 {
    if f.is_nan() {
        return 1.0;
    }
    FisherSnedecor::new(free.0, free.1).map_or(1.0, |law| law.sf(f))
}

/// Fisher's method: the chance that independent `chances` are as small together where nothing is there; 1 of none.
/// One that is not a number counts as 1.
#[must_use]
pub fn joint_chance(chances: impl IntoIterator<Item = f64>) -> f64 {
    let (mut statistic, mut count) = (0.0, 0_usize);
    for chance in chances {
        // `max` would make the least chance of one that is not a number
        let chance = if chance.is_nan() { 1.0 } else { chance };
        statistic -= 2.0 * chance.max(LEAST_CHANCE).ln();
        count += 1;
    }
    // with no degree of freedom there is nothing to be improbable
    let freedom = 2.0 * count.max(1) as f64;
    ChiSquared::new(freedom).map_or(1.0, |law| law.sf(statistic))
}

/// A chance that underflowed counts as this: its logarithm stays finite.
const LEAST_CHANCE: f64 = 1e-300;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_deviate_has_the_chance_of_its_statistic() {
        assert_eq!(normal_deviate(9.0, 1), 3.0);
        assert_eq!(normal_deviate(-1.0, 2), 0.0);
        // chi square of two degrees of freedom exceeds x with exp(-x/2); P(|Z| > 1.959964) is 0.05
        assert!((normal_deviate(-2.0 * 0.05_f64.ln(), 2) - 1.959_964).abs() < 1e-6);
        // far out, where no chance can be written as a number: ln P(|Z| > z) is about -z^2/2 - ln(z sqrt(pi/2))
        let z = normal_deviate(1e4, 2);
        let ln_chance = -0.5 * z * z - (z * std::f64::consts::FRAC_PI_2.sqrt()).ln();
        assert!((ln_chance / -5e3 - 1.0).abs() < 1e-6, "{z}");
    }

    #[test]
    fn tails_are_those_of_the_tables() {
        // 5 % point of F(2, 10)
        assert!((f_tail(4.102_821, (2.0, 10.0)) - 0.05).abs() < 1e-6);
        assert_eq!(f_tail(1.0, (0.0, 1.0)), 1.0);
        // one chance alone stays itself
        assert!((joint_chance([0.03]) - 0.03).abs() < 1e-9);
        // the product of two uniform numbers lies below p with p (1 - ln p)
        let p: f64 = 0.1 * 0.2;
        assert!((joint_chance([0.1, 0.2]) - p * (1.0 - p.ln())).abs() < 1e-9);
        assert_eq!(joint_chance([]), 1.0);
    }

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
