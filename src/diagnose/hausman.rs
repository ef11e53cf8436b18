//! Hausman's test (1978) of two estimates of one value: one that is the more precise while its assumptions hold, and one that
//! holds in either case.

/// Normal deviate beyond which they differ. Chosen; not measured.
pub(super) const DEVIATE: f64 = 2.5;

/// Whether the difference of the values is more than the greater variance of the second allows. Both variances are in the
/// squared unit of the difference.
pub(super) fn differ(apart: f64, precise_variance: f64, robust_variance: f64) -> bool {
    apart.powi(2) > DEVIATE.powi(2) * (robust_variance - precise_variance)
}

/// Whether they differ by more than the greater one of their variances allows: a contradiction whichever is the more precise.
pub(super) fn contradict(apart: f64, one_variance: f64, other_variance: f64) -> bool {
    apart.powi(2) > DEVIATE.powi(2) * one_variance.max(other_variance)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_additional_variance_excuses_a_difference() {
        assert!(!differ(2.0, 1.0, 2.0));
        assert!(differ(3.0, 1.0, 2.0));
        assert!(differ(0.1, 2.0, 1.0), "the second is the more precise one");
        assert!(!contradict(0.1, 2.0, 1.0) && !contradict(3.0, 2.0, 1.0) && contradict(4.0, 2.0, 1.0));
    }
}
