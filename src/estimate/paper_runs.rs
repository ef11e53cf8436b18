//! The paper's four methods on the flights: LS and GD on samples, FMLS and FMGD on filtered samples.

use super::method::Method;
use super::nominal::Nominal;
use super::recursive::{History, PaperEstimate, gradient_descent, least_squares};
use super::result::{Estimated, MethodResult};
use super::theta::ThetaCovariance;
use crate::regression::{Phi, SampledModel, ZeroPhase, paper_models};
use crate::signals::Signals;
use crate::vehicle::Vehicle;

/// The paper's four methods.
pub(super) struct PaperRuns {
    /// `Gamma' Gamma` of the standard model as flown, without a sample zero
    gram: ThetaCovariance,
    runs: Vec<(Method, PaperEstimate)>,
    nominal: Nominal,
}

impl PaperRuns {
    pub(super) fn from(flights: &[Signals], vehicle: &Vehicle, filter: &ZeroPhase, sigma: f64) -> Self {
        let nominal = Nominal::of(vehicle);
        let (mut standard, mut filtered) = (SampledModel::default(), SampledModel::default());
        for signals in flights {
            if let Some((one, other)) = paper_models(signals, vehicle.gravity_m_s2, filter) {
                standard.extend(one);
                filtered.extend(other);
            }
        }
        let mut gram = ThetaCovariance::zeros();
        for gamma in standard.gamma.iter().map(Phi::matrix) {
            gram += gamma.tr_mul(&gamma);
        }
        let mut runs = Vec::new();
        for (model, by_ls, by_gd) in
            [(&standard, Method::Ls, Method::Gd), (&filtered, Method::Fmls, Method::Fmgd)]
        {
            if model.time_s.is_empty() {
                continue;
            }
            runs.extend(least_squares(model).map(|estimate| (by_ls, estimate)));
            runs.push((by_gd, gradient_descent(model, &nominal.theta, sigma)));
        }
        runs.sort_by_key(|(method, _)| *method);
        Self { gram, runs, nominal }
    }

    /// No method had a sample to run on.
    pub(super) fn is_empty(&self) -> bool {
        self.runs.is_empty()
    }

    /// Their results; what the flights cannot tell by `weak`, they cannot tell by these methods either.
    pub(super) fn results(&self, weak: &Estimated) -> Vec<MethodResult> {
        self.runs
            .iter()
            .map(|(method, run)| {
                let estimated = Estimated {
                    theta: run.theta,
                    covariance: run.covariance,
                    explained: weak.explained,
                    by_wider_window: weak.by_wider_window,
                    by_guessed_curve: weak.by_guessed_curve,
                    torque_exponent: weak.torque_exponent,
                };
                MethodResult::new(*method, &estimated, &self.nominal)
            })
            .collect()
    }

    pub(super) fn histories(&self) -> Vec<(Method, History)> {
        self.runs.iter().map(|(method, run)| (*method, run.history.clone())).collect()
    }

    /// cond(W) of (20) as flown.
    pub(super) fn condition_number(&self) -> Option<f64> {
        let values = self.gram.symmetric_eigenvalues();
        (values.min() > 0.0).then(|| (values.max() / values.min()).sqrt())
    }
}
