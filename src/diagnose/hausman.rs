//! Hausman's test (1978) of two estimates of one value: one is more precise while its assumptions hold, the other is consistent
//! in either case.

/// Normal deviate beyond which they differ. A chance of 1.2 % where both agree.
pub(super) const DEVIATE: f64 = 2.5;

/// Whether the difference of the values is more than the greater variance of the second allows. Both variances are in the
/// squared unit of the difference.
pub(super) fn differ(apart: f64, precise_variance: f64, robust_variance: f64) -> bool {
    apart.powi(2) > DEVIATE.powi(2) * (robust_variance - precise_variance)
}

/// Whether the second of two estimates holds, where the first is efficient but for an error of its own of variance `bias_variance`: the
/// second is the more certain one, or the difference is more than both errors allow.
pub(super) fn holds(apart: f64, precise_variance: f64, bias_variance: f64, robust_variance: f64) -> bool {
    robust_variance < precise_variance + bias_variance
        || apart.powi(2) > DEVIATE.powi(2) * (robust_variance - precise_variance + bias_variance)
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
        // 0.5^2 + 1^2: an error of its own excuses more, and yields to who is more certain
        assert!(holds(2.0, 1.0, 0.0, 1.5) && !holds(2.0, 1.0, 1.0, 2.5) && holds(0.1, 1.0, 2.0, 2.5));
        assert!(!contradict(0.1, 2.0, 1.0) && !contradict(3.0, 2.0, 1.0) && contradict(4.0, 2.0, 1.0));
    }
}
