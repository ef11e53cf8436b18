//! One value of a parameter that several flights have in common.

/// Flights that the stated errors count as where their scatter is learned.
const PRIOR: f64 = 4.0;

/// Mean of the flights' values by their information, with its standard error: larger where they scatter by more than their errors. A
/// flight without a value takes no part. `None` where no flight has one.
#[must_use]
pub fn together(values: &[Option<(f64, f64)>]) -> Option<(f64, f64)> {
    let usable = |(value, std): &(f64, f64)| value.is_finite() && *std > 0.0 && std.is_finite();
    let known: Vec<(f64, f64)> = values.iter().flatten().copied().filter(usable).collect();
    if known.is_empty() {
        return None;
    }
    let information: f64 = known.iter().map(|(_, std)| std.powi(-2)).sum();
    let mean = known.iter().map(|(value, std)| value * std.powi(-2)).sum::<f64>() / information;
    let squares: f64 = known.iter().map(|(value, std)| ((value - mean) / std).powi(2)).sum();
    let scale = ((PRIOR + squares) / (PRIOR + known.len() as f64 - 1.0)).sqrt().max(1.0);
    Some((mean, scale * information.sqrt().recip()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flights_that_agree_halve_the_error_of_four_and_flights_that_do_not_widen_it() {
        let (mean, std) =
            together(&[Some((1.0, 0.2)), None, Some((1.1, 0.2)), Some((0.9, 0.2)), Some((1.0, 0.2))])
                .unwrap();
        assert!((mean - 1.0).abs() < 1e-12 && (std - 0.1).abs() < 1e-12);
        let (_, wide) = together(&[Some((1.0, 0.1)), Some((2.0, 0.1)), Some((3.0, 0.1))]).unwrap();
        assert!(wide > 0.2);
        assert!(together(&[None, Some((f64::NAN, 1.0))]).is_none());
    }
}
