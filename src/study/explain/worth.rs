//! What each effect of the model is worth in prediction: whoever has to leave one out knows what that costs.

use crate::diagnose::holdout::{HALF_SECOND, SquaredErrors, Without};
use statrs::distribution::{ContinuousCDF, StudentsT};

/// Errors of prediction with the whole model and without each of its effects.
#[derive(Debug, Clone, PartialEq)]
pub struct Worth {
    /// the whole model first, then one for each effect
    pub each: Vec<Without>,
    /// the flights were explained too: there were no others
    pub on_explained: bool,
}

/// Fewest blocks that are compared: with two, one degree of freedom tells nothing.
const LEAST_BLOCKS: usize = 3;

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

    /// Chance of errors over 0.5 s that are smaller without an effect by as much in the mean of the blocks, where it is worth nothing: a
    /// paired t test of the squared errors, block by block, on one side. `None` where it is not in the model, or there are too few
    /// blocks.
    pub(super) fn chance_of_better_without(&self, id: &str) -> Option<f64> {
        let of = |wanted: Option<&str>| self.each.iter().find(|without| without.id == wanted);
        let (with, without) = (of(None)?, of(Some(id))?);
        let scale: [f64; 4] =
            std::array::from_fn(|quantity| with.blocks.iter().map(|block| block[quantity].0).sum());
        // every quantity counts alike, by its own error with the whole model
        let better = |(with, without): (&SquaredErrors, &SquaredErrors)| -> f64 {
            let each = with.iter().zip(without).zip(&scale).filter(|(_, scale)| **scale > 0.0);
            each.map(|((with, without), scale)| (with.0 - without.0) / scale).sum()
        };
        let each: Vec<f64> = with.blocks.iter().zip(&without.blocks).map(better).collect();
        let count = each.len() as f64;
        if each.len() < LEAST_BLOCKS {
            return None;
        }
        let mean = each.iter().sum::<f64>() / count;
        let variance = each.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / (count - 1.0);
        if variance.is_nan() || variance <= 0.0 {
            return None;
        }
        Some(StudentsT::new(0.0, 1.0, count - 1.0).ok()?.sf(mean / (variance / count).sqrt()))
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
            blocks: Vec::new(),
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

    #[test]
    fn errors_that_are_smaller_by_chance_are_told_from_those_that_always_are() {
        let of = |id, squares: &[f64]| Without {
            id,
            errors: Vec::new(),
            blocks: squares.iter().map(|square| [(*square, 10), (0.0, 0), (0.0, 0), (0.0, 0)]).collect(),
        };
        let each = vec![
            of(None, &[1.0, 1.2, 0.9, 1.1, 1.0]),
            of(Some("always"), &[0.9, 1.1, 0.82, 0.99, 0.91]),
            // the mean is smaller by one block alone
            of(Some("once"), &[1.05, 1.22, 0.92, 0.6, 1.04]),
            of(Some("worse"), &[1.5, 1.6, 1.3, 1.4, 1.7]),
        ];
        let worth = Worth { each, on_explained: false };
        assert!(worth.chance_of_better_without("always").unwrap() < 0.01);
        assert!((0.2..0.5).contains(&worth.chance_of_better_without("once").unwrap()));
        assert!(worth.chance_of_better_without("worse").unwrap() > 0.99);
        assert_eq!(worth.chance_of_better_without("tether"), None);
        let few = vec![of(None, &[1.0, 1.2]), of(Some("always"), &[0.9, 1.1])];
        assert_eq!(Worth { each: few, on_explained: false }.chance_of_better_without("always"), None);
    }
}
