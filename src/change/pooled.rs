//! One value of a parameter that several flights have in common.

use statrs::distribution::{ChiSquared, ContinuousCDF};

/// Flights that the stated errors count as where their scatter is learned. With fewer, three flights that agree by
/// chance would narrow the error; with more, flights that scatter could not widen it.
pub(super) const PRIOR: f64 = 4.0;
/// Level of the test that flights scatter by more than their errors (Cochran's Q). Flights that agree would otherwise have a wider error
/// in every second case.
const LEVEL: f64 = 0.05;

/// Values that were put together.
struct Pool {
    mean: f64,
    /// of the parts of the errors that are each flight's own
    information: f64,
    /// by which the flights scatter more than these parts say; 1 where a test does not find it
    scale: f64,
    /// least part of the errors that goes the same way in all flights
    shared: f64,
}

/// Whether a value takes part: it and its standard error are numbers.
fn is_usable((value, std): &(f64, f64)) -> bool {
    value.is_finite() && *std > 0.0 && std.is_finite()
}

impl Pool {
    fn of(values: &[Option<(f64, f64)>], common: &[f64]) -> Option<Self> {
        let known = values.iter().zip(common).filter_map(|(value, common)| {
            value.filter(is_usable).map(|(value, std)| (value, std, common.min(0.999 * std)))
        });
        let known: Vec<(f64, f64, f64)> = known.collect();
        let shared = known.iter().map(|(.., common)| *common).fold(f64::INFINITY, f64::min);
        if known.is_empty() {
            return None;
        }
        let weight = |std: f64| (std * std - shared * shared).recip();
        let information: f64 = known.iter().map(|(_, std, _)| weight(*std)).sum();
        let mean = known.iter().map(|(value, std, _)| value * weight(*std)).sum::<f64>() / information;
        let squares: f64 = known.iter().map(|(value, std, _)| (value - mean).powi(2) * weight(*std)).sum();
        let free = known.len() as f64 - 1.0;
        let scatters = ChiSquared::new(free).is_ok_and(|expected| expected.sf(squares) < LEVEL);
        let scale = if scatters { ((PRIOR + squares) / (PRIOR + free)).sqrt().max(1.0) } else { 1.0 };
        Some(Self { mean, information, scale, shared })
    }
}

/// Mean of the flights' values by their information, with its standard error: larger where a test finds that they scatter by more than
/// their errors. Of
/// each flight's standard error the part `common` goes the same way in all of them, and no number of flights lowers the least of it. A
/// flight without a value takes no part. `None` where no flight has one.
#[must_use]
pub fn pooled_mean(values: &[Option<(f64, f64)>], common: &[f64]) -> Option<(f64, f64)> {
    let Pool { mean, information, scale, shared } = Pool::of(values, common)?;
    Some((mean, (scale * information.sqrt().recip()).hypot(shared)))
}

/// Each flight's value with the standard error that the others leave it: larger where the flights scatter by more than their errors,
/// by the same factor as that of [`pooled_mean`]. What takes no part in that mean stays as it is.
#[must_use]
pub fn with_scatter(values: &[Option<(f64, f64)>], common: &[f64]) -> Vec<Option<(f64, f64)>> {
    let Some(Pool { scale, shared, .. }) = Pool::of(values, common) else { return values.to_vec() };
    let wider = |std: f64| {
        let own = (std * std - shared * shared).max(0.0).sqrt();
        (scale * own).hypot(shared.min(std))
    };
    let each = |of: (f64, f64)| if is_usable(&of) { (of.0, wider(of.1)) } else { of };
    values.iter().map(|value| value.map(each)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flights_that_agree_halve_the_error_of_four_and_flights_that_do_not_widen_it() {
        let four = [Some((1.0, 0.2)), None, Some((1.1, 0.2)), Some((0.9, 0.2)), Some((1.0, 0.2))];
        let (mean, std) = pooled_mean(&four, &[0.0; 5]).unwrap();
        assert!((mean - 1.0).abs() < 1e-12 && (std - 0.1).abs() < 1e-12);
        let (_, wide) =
            pooled_mean(&[Some((1.0, 0.1)), Some((2.0, 0.1)), Some((3.0, 0.1))], &[0.0; 3]).unwrap();
        // a flight is as certain as the scatter of all of them leaves it, and never more than all of them together
        let scattered = [Some((1.0, 0.1)), Some((2.0, 0.1)), Some((3.0, 0.2)), None];
        let [(_, first), (_, third)] =
            [0, 2].map(|flight| with_scatter(&scattered, &[0.05; 4])[flight].unwrap());
        let (_, all) = pooled_mean(&scattered, &[0.05; 4]).unwrap();
        assert!(first > 0.3 && third > first && all < first, "{first} {third} {all}");
        // and where they do not scatter, as certain as it says
        for (said, with) in four.iter().flatten().zip(with_scatter(&four, &[0.1; 5]).iter().flatten()) {
            assert!(said.0 == with.0 && (said.1 - with.1).abs() < 1e-12);
        }
        // what is not known does not become known by the others
        let unknown = [Some((1.0, 0.2)), Some((1.1, f64::NAN)), Some((1.2, f64::INFINITY))];
        let left = with_scatter(&unknown, &[0.1; 3]);
        assert!(left[1].unwrap().1.is_nan() && left[2].unwrap().1.is_infinite());
        // what goes the same way in all of them stays
        let (_, left) = pooled_mean(&four, &[0.1; 5]).unwrap();
        assert!((left - (0.03_f64 / 4.0 + 0.01).sqrt()).abs() < 1e-12);
        assert!(wide > 0.2);
        assert!(pooled_mean(&[None, Some((f64::NAN, 1.0))], &[0.0; 2]).is_none());
    }
}
