//! What each effect of the model is worth in prediction: whoever has to leave one out knows what that costs.

use crate::diagnose::holdout::Without;

/// Errors of prediction with the whole model and without each of its effects.
#[derive(Debug, Clone, PartialEq)]
pub struct Worth {
    /// the whole model first, then one for each effect
    pub each: Vec<Without>,
    /// the flights were explained too: there were no others
    pub on_explained: bool,
}

/// Place of the window of half a second in `WINDOWS_S`.
const HALF_SECOND: usize = 1;

impl Worth {
    /// By how much errors over 0.5 s are smaller without an effect, mean over the quantities, %; `None` where it is not in the model.
    pub(super) fn better_without_percent(&self, id: &str) -> Option<f64> {
        let of = |wanted: Option<&str>| {
            self.each.iter().find(|without| without.id == wanted)?.errors.get(HALF_SECOND)
        };
        let (with, without) = (of(None)?, of(Some(id))?);
        let each: Vec<f64> = with
            .iter()
            .zip(without)
            .filter_map(|(with, without)| Some(100.0 * (1.0 - (*without)? / (*with)?)))
            .filter(|percent| percent.is_finite())
            .collect();
        (!each.is_empty()).then(|| each.iter().sum::<f64>() / each.len() as f64)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test ends where it fails")]
    use super::*;

    #[test]
    fn an_effect_without_which_errors_are_smaller_is_told_by_the_mean_over_what_is_recorded() {
        let without = |id, errors: [Option<f64>; 4]| Without {
            id,
            errors: vec![[Some(9.0); 4], errors, [Some(9.0); 4]],
        };
        let each = vec![
            without(None, [Some(2.0), Some(1.0), Some(0.5), None]),
            without(Some("inflow"), [Some(1.8), Some(0.8), Some(0.5), None]),
            without(Some("linear_drag"), [Some(4.0), Some(2.0), Some(0.5), None]),
        ];
        let worth = Worth { each, on_explained: false };
        assert!((worth.better_without_percent("inflow").unwrap() - 10.0).abs() < 1e-9);
        assert!((worth.better_without_percent("linear_drag").unwrap() + 200.0 / 3.0).abs() < 1e-9);
        assert_eq!(worth.better_without_percent("tether"), None);
    }
}
