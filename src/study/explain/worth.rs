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
