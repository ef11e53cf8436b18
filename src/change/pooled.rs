//! One value of a parameter that several flights have in common.

use statrs::distribution::{ChiSquared, ContinuousCDF};

/// Flights that the stated errors count as where their scatter is learned. With fewer, three flights that agree by
/// chance would narrow the error; with more, flights that scatter could not widen it.
pub(super) const PRIOR: f64 = 4.0;
/// Level of the test that flights scatter by more than their errors (Cochran's Q). Flights that agree would otherwise have a wider error
/// in every second case.
const LEVEL: f64 = 0.05;

/// Halvings that find the common part of the error by the scatter: to a millionth of it.
const HALVINGS: usize = 20;

/// Values that were put together.
struct Pool {
    mean: f64,
    /// of the parts of the errors that are each flight's own
    information: f64,
    /// by which the flights scatter more than the parts that are their own say; 1 where a test does not find it
    scale: f64,
    /// part of the errors that goes the same way in all flights
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
        let least = known.iter().map(|(.., common)| *common).fold(f64::INFINITY, f64::min);
        if known.is_empty() {
            return None;
        }
        let free = known.len() as f64 - 1.0;
        let is_beyond = |squares: f64| ChiSquared::new(free).is_ok_and(|of| of.sf(squares) < LEVEL);
        let (pool, squares) = Self::sharing(&known, least);
        if !is_beyond(squares) {
            return Some(pool);
        }
        // what was taken for common to all flights is not, as far as they scatter
        let widened = |(pool, squares): (Self, f64)| Self {
            scale: ((PRIOR + squares) / (PRIOR + free)).sqrt().max(1.0),
            ..pool
        };
        let without = Self::sharing(&known, 0.0);
        if is_beyond(without.1) {
            return Some(widened(without));
        }
        let (mut scattered, mut agreeing) = (least, 0.0);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (scattered + agreeing);
            let is_too_much = is_beyond(Self::sharing(&known, middle).1);
            *(if is_too_much { &mut scattered } else { &mut agreeing }) = middle;
        }
        Some(widened(Self::sharing(&known, agreeing)))
    }

    /// The values where this part of their errors goes the same way in all flights, with the sum of the squares of their distances from the
    /// mean over the rest of their errors (Cochran's Q).
    fn sharing(known: &[(f64, f64, f64)], shared: f64) -> (Self, f64) {
        let weight = |std: f64| (std * std - shared * shared).recip();
        let information: f64 = known.iter().map(|(_, std, _)| weight(*std)).sum();
        let mean = known.iter().map(|(value, std, _)| value * weight(*std)).sum::<f64>() / information;
        let squares = known.iter().map(|(value, std, _)| (value - mean).powi(2) * weight(*std)).sum();
        (Self { mean, information, scale: 1.0, shared }, squares)
    }
}

/// Mean of the flights' values by their information, with its standard error.
///
/// Of each flight's standard error the part `common` is expected to go the same way in all of them, and no number of flights lowers the
/// least of it. Where a test finds that the flights scatter by more than the rest of their errors, so much of that part counts as each
/// flight's own that the test no longer does: what goes the same way in all flights cannot make them scatter. The
/// rest is widened by what they scatter more than it says, as where they scatter by more than their whole errors.
///
/// A flight without a value takes no part. `None` where no flight has one.
#[must_use]
pub fn pooled_mean(values: &[Option<(f64, f64)>], common: &[f64]) -> Option<(f64, f64)> {
    let Pool { mean, information, scale, shared } = Pool::of(values, common)?;
    Some((mean, (scale * information.sqrt().recip()).hypot(shared)))
}

/// Each flight's value with the standard error that the others leave it: the part that is the flight's own is larger where the flights
/// scatter by more than it says, by the same factor as that of [`pooled_mean`]. What takes no part in that mean stays as it is.
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
        // what was expected to be common and scatters is not: six flights of 1 +- 0.1, of which 0.09 was taken for common
        let apart = [0.9, 1.1, 0.95, 1.05, 0.88, 1.12].map(|value| Some((value, 0.1)));
        let (mean, std) = pooled_mean(&apart, &[0.09; 6]).unwrap();
        // the test allows a sum of squares of 11.07: s^2 = 0.01 - 0.0538 / 11.07 stays common; the rest is lowered by the number of
        // flights, and its square widened by 15.07 / 9
        assert!(
            (mean - 1.0).abs() < 1e-12 && (std * std - (0.005_14 + 1.674 * 0.004_86 / 6.0)).abs() < 1e-5,
            "{std}"
        );
        let closer = [0.92, 1.08, 0.95, 1.05, 0.93, 1.07].map(|value| Some((value, 0.1)));
        let (_, std) = pooled_mean(&closer, &[0.09; 6]).unwrap();
        assert!((std * std - (0.007_507 + 1.674 * 0.002_493 / 6.0)).abs() < 1e-5, "{std}");
        let (value, alone) = with_scatter(&closer, &[0.09; 6])[0].unwrap();
        assert!(value == 0.92 && (alone * alone - (0.007_507 + 1.674 * 0.002_493)).abs() < 1e-5);
        assert!(pooled_mean(&[None, Some((f64::NAN, 1.0))], &[0.0; 2]).is_none());
    }
}
