//! By how much an error fell.

/// `P_imp` of section IV-B: by how much an error fell, in percent of `before`. 0 where both are 0.
#[must_use]
pub fn improvement_percent(before: f64, after: f64) -> f64 {
    if before == after { 0.0 } else { 100.0 * (before - after) / before }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn improvement_is_the_papers() {
        // Table 4, e_x with LS and e_psi with FMLS
        assert!((improvement_percent(0.06187, 0.05888) - 4.84).abs() < 0.01);
        assert!((improvement_percent(0.98831, 1.16907) + 18.29).abs() < 0.01);
        assert_eq!(improvement_percent(0.0, 0.0), 0.0);
    }
}
