//! Verdicts against answers.

use serde::Serialize;

use super::answers::{Answer, Size, UNEXPLAINED};
use super::case::{CaseEffect, CaseVerdict};

/// One case scored.
#[derive(Debug, Clone, Serialize)]
pub struct ScoredCase {
    /// name of its folder
    pub case: String,
    /// identifiers by the answer
    pub expected: Vec<String>,
    /// in one word
    pub verdict: String,
    /// identifiers that were named
    pub named: Vec<String>,
    /// the verdict and all names are as expected
    pub right: bool,
    /// names that are neither expected nor in the stated set of one that is
    pub false_names: Vec<String>,
    /// expected, and neither named nor in the stated set of a named one
    pub missed: Vec<String>,
    /// of parameters whose truth is known
    pub sizes: Vec<SizeError>,
    /// of the hold-out, %
    pub improvement_percent: Option<f64>,
    /// interval that holds 95 of 100 resamplings
    pub improvement_range: Option<(f64, f64)>,
    /// why it could not be explained
    pub error: Option<String>,
    /// wall clock
    pub seconds: f64,
}

/// A size against the truth.
#[derive(Debug, Clone, Serialize)]
pub struct SizeError {
    /// identifier of the effect
    pub effect: String,
    /// name of the parameter
    pub parameter: String,
    /// SI
    pub unit: String,
    /// by the answer
    pub truth: f64,
    /// as found
    pub value: f64,
    /// standard error
    pub std: f64,
    /// of the greatest true size among the effect's parameters of this unit
    pub error_percent: f64,
    /// difference in standard errors; `None` where none was given
    pub sigmas: Option<f64>,
}

/// Counts over all cases.
#[derive(Debug, Clone, Serialize, Default)]
pub struct ProofSummary {
    /// with an answer
    pub cases: usize,
    /// verdict and all names as expected
    pub right: usize,
    /// names that nothing accounts for
    pub false_names: usize,
    /// cases in which nothing is missing and something was named
    pub false_names_where_nothing_is: usize,
    /// effects that were expected and not named
    pub missed: usize,
    /// values whose truth is known
    pub sizes: usize,
    /// of these
    pub sizes_within_10_percent: usize,
    /// the largest error among them
    pub worst_size_error_percent: Option<f64>,
    /// of these
    pub sizes_within_2_sigma: usize,
    /// cases with a hold-out that could be predicted
    pub holdouts: usize,
    /// of these, those that the better model predicts better
    pub holdouts_improved: usize,
    /// cases that could not be explained
    pub errors: usize,
    /// the longest wall clock
    pub slowest_s: f64,
}

/// Scores one verdict.
pub(super) fn scored(verdict: &CaseVerdict, answer: &Answer) -> ScoredCase {
    let named: Vec<String> = verdict.effects.iter().map(|effect| effect.id.clone()).collect();
    let outside = answer.expect.iter().any(|id| id == UNEXPLAINED);
    let wanted: Vec<&String> = answer.expect.iter().filter(|id| *id != UNEXPLAINED).collect();
    let stands_for = |effect: &CaseEffect, id: &str| {
        effect.id == id || effect.confusable_with.iter().any(|other| other == id)
    };
    let false_names: Vec<String> = verdict
        .effects
        .iter()
        .filter(|effect| !wanted.iter().any(|id| stands_for(effect, id)))
        .map(|effect| effect.id.clone())
        .collect();
    let missed: Vec<String> = wanted
        .iter()
        .filter(|id| !verdict.effects.iter().any(|effect| stands_for(effect, id)))
        .map(|id| (*id).clone())
        .collect();
    let word = match (outside, wanted.is_empty()) {
        (true, _) => ["unexplained", "partly_explained"].contains(&verdict.verdict.as_str()),
        (false, true) => verdict.verdict == "nothing_missing",
        (false, false) => ["explained", "partly_explained"].contains(&verdict.verdict.as_str()),
    };
    ScoredCase {
        case: verdict.case.clone(),
        expected: answer.expect.clone(),
        verdict: verdict.verdict.clone(),
        right: word && false_names.is_empty() && missed.is_empty(),
        named,
        false_names,
        missed,
        sizes: verdict.effects.iter().flat_map(|effect| sizes(effect, answer)).collect(),
        improvement_percent: verdict.holdout.as_ref().and_then(|gain| gain.improvement_percent),
        improvement_range: verdict.holdout.as_ref().and_then(|gain| gain.improvement_range),
        error: verdict.error.clone(),
        seconds: verdict.seconds,
    }
}

/// Parameters whose truth is known.
fn sizes(effect: &CaseEffect, answer: &Answer) -> Vec<SizeError> {
    let Some(size) = answer.sizes.get(&effect.id) else { return Vec::new() };
    let truth_of = |index: usize, name: &str| match size {
        // one number for an effect with several estimated parameters is each one's of that unit
        Size::One(value) if index == 0 => Some(*value),
        Size::One(value) => {
            let [first, this] = [0, index].map(|place| effect.parameters[place].unit.as_str());
            (this == first && this != "-").then_some(*value)
        }
        Size::List(values) => values.get(index).copied(),
        Size::Named(values) => values.get(name).copied(),
    };
    let known: Vec<(usize, f64)> = effect
        .parameters
        .iter()
        .enumerate()
        .filter_map(|(index, parameter)| Some((index, truth_of(index, &parameter.name)?)))
        .collect();
    known
        .iter()
        .map(|&(index, truth)| {
            let parameter = &effect.parameters[index];
            let scale = known
                .iter()
                .filter(|(other, _)| effect.parameters[*other].unit == parameter.unit)
                .fold(0.0_f64, |most, (_, truth)| most.max(truth.abs()));
            SizeError {
                effect: effect.id.clone(),
                parameter: parameter.name.clone(),
                unit: parameter.unit.clone(),
                truth,
                value: parameter.value,
                std: parameter.std,
                error_percent: 100.0 * (parameter.value - truth) / scale.max(f64::MIN_POSITIVE),
                sigmas: (parameter.std > 0.0).then(|| (parameter.value - truth) / parameter.std),
            }
        })
        .collect()
}

/// Counts.
pub(super) fn summary(scored: &[ScoredCase]) -> ProofSummary {
    let count = |of: &dyn Fn(&&ScoredCase) -> bool| scored.iter().filter(of).count();
    let sizes: Vec<&SizeError> = scored.iter().flat_map(|case| &case.sizes).collect();
    let errors = sizes.iter().map(|size| size.error_percent.abs());
    ProofSummary {
        cases: scored.len(),
        right: count(&|case| case.right),
        false_names: scored.iter().map(|case| case.false_names.len()).sum(),
        false_names_where_nothing_is: count(&|case| case.expected.is_empty() && !case.named.is_empty()),
        missed: scored.iter().map(|case| case.missed.len()).sum(),
        sizes: sizes.len(),
        sizes_within_10_percent: sizes.iter().filter(|size| size.error_percent.abs() <= 10.0 + 1e-9).count(),
        worst_size_error_percent: errors.max_by(f64::total_cmp),
        sizes_within_2_sigma: sizes.iter().filter(|size| size.sigmas.is_some_and(|s| s.abs() <= 2.0)).count(),
        holdouts: count(&|case| case.improvement_percent.is_some()),
        holdouts_improved: count(&|case| case.improvement_percent.is_some_and(|percent| percent > 0.0)),
        errors: count(&|case| case.error.is_some()),
        slowest_s: scored.iter().fold(0.0, |most, case| most.max(case.seconds)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::prove::case::CaseParameter;
    use std::collections::BTreeMap;

    type Reported<'a> = (&'a str, &'a [(&'a str, f64)], &'a [&'a str]);

    fn verdict(word: &str, effects: &[Reported<'_>]) -> CaseVerdict {
        let effects = effects.iter().map(|(id, parameters, confusable)| CaseEffect {
            id: (*id).to_owned(),
            parameters: parameters
                .iter()
                .map(|(name, value)| CaseParameter {
                    name: (*name).to_owned(),
                    value: *value,
                    std: 0.01,
                    unit: if name.starts_with('d') { "N/(m/s)" } else { "-" }.to_owned(),
                })
                .collect(),
            confusable_with: confusable.iter().map(|id| (*id).to_owned()).collect(),
        });
        CaseVerdict {
            schema: 1,
            case: "c".to_owned(),
            verdict: word.to_owned(),
            effects: effects.collect(),
            closest: Vec::new(),
            empirical: None,
            holdout: None,
            error: None,
            sha256: Vec::new(),
            seconds: 0.0,
        }
    }

    fn answer(expect: &[&str], sizes: &[(&str, Size)]) -> Answer {
        Answer {
            expect: expect.iter().map(|id| (*id).to_owned()).collect(),
            sizes: sizes.iter().map(|(id, size)| ((*id).to_owned(), size.clone())).collect(),
        }
    }

    #[test]
    fn names_sets_and_verdicts_are_scored() {
        let drag = ("linear_drag", &[("dx", 0.33), ("dy", 0.29), ("at_hubs", 1.0)][..], &[][..]);
        let right = scored(
            &verdict("explained", &[drag]),
            &answer(&["linear_drag"], &[("linear_drag", Size::One(0.3))]),
        );
        assert!(right.right && right.sizes.len() == 2);
        assert!((right.sizes[0].error_percent - 10.0).abs() < 1e-9);
        assert!((right.sizes[0].sigmas.unwrap() - 3.0).abs() < 1e-9);
        let extra = scored(&verdict("explained", &[drag]), &answer(&[], &[]));
        assert!(!extra.right && extra.false_names == ["linear_drag"]);
        let outside = answer(&["unexplained"], &[]);
        assert!(scored(&verdict("unexplained", &[]), &outside).right);
        assert!(!scored(&verdict("nothing_missing", &[]), &outside).right);
        let set = ("motor_lag", &[][..], &["transport_delay"][..]);
        assert!(scored(&verdict("explained", &[set]), &answer(&["transport_delay"], &[])).right);
        let summary = summary(&[right, extra]);
        assert_eq!((summary.cases, summary.right, summary.false_names_where_nothing_is), (2, 1, 1));
        assert_eq!(summary.sizes_within_10_percent, 2);
    }

    #[test]
    fn sizes_by_name_and_in_order() {
        let change = ("mass_change", &[("time", 24.2), ("delta", -0.25)][..], &[][..]);
        let named = BTreeMap::from([("time".to_owned(), 24.0), ("delta".to_owned(), -0.25)]);
        let by_name = scored(
            &verdict("explained", &[change]),
            &answer(&["mass_change"], &[("mass_change", Size::Named(named))]),
        );
        assert_eq!(by_name.sizes.len(), 2);
        let offset = ("com_offset", &[("x", -0.009), ("y", 0.0)][..], &[][..]);
        let list = answer(&["com_offset"], &[("com_offset", Size::List(vec![-0.009, 0.011, 0.0]))]);
        let in_order = scored(&verdict("explained", &[offset]), &list);
        assert!((in_order.sizes[1].error_percent + 100.0).abs() < 1e-9);
    }
}
