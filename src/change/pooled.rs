//! One value of a parameter that several flights have in common.

/// Flights that the stated errors count as where their scatter is learned. With fewer, three flights that agree by
/// chance would narrow the error; with more, flights that scatter could not widen it.
pub(super) const PRIOR: f64 = 4.0;

/// Mean of the flights' values by their information, with its standard error: larger where they scatter by more than their errors. Of
/// each flight's standard error the part `common` goes the same way in all of them, and no number of flights lowers the least of it. A
/// flight without a value takes no part. `None` where no flight has one.
#[must_use]
pub fn pooled_mean(values: &[Option<(f64, f64)>], common: &[f64]) -> Option<(f64, f64)> {
    let usable = |(value, std): (f64, f64)| value.is_finite() && std > 0.0 && std.is_finite();
    let known = values.iter().zip(common).filter_map(|(value, common)| {
        value.filter(|value| usable(*value)).map(|(value, std)| (value, std, common.min(0.999 * std)))
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
    let scale = ((PRIOR + squares) / (PRIOR + known.len() as f64 - 1.0)).sqrt().max(1.0);
    Some((mean, (scale * information.sqrt().recip()).hypot(shared)))
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
        // what goes the same way in all of them stays
        let (_, left) = pooled_mean(&four, &[0.1; 5]).unwrap();
        assert!((left - (0.03_f64 / 4.0 + 0.01).sqrt()).abs() < 1e-12);
        assert!(wide > 0.2);
        assert!(pooled_mean(&[None, Some((f64::NAN, 1.0))], &[0.0; 2]).is_none());
    }
}
