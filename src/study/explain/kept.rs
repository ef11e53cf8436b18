//! Moments of inertia that no flight determines.

use super::result::ExplainStudy;
use crate::diagnose::Explanation;
use crate::diagnose::holdout::{Explained, HoldoutSettings, OpenLoop, without_law};
use crate::estimate::{MOMENTS, is_physical, theta_of};
use crate::study::flights::Prepared;

impl ExplainStudy {
    /// Moments of inertia that the flights do not determine stay as the vehicle file has them, unless the fitted ones predict body rates
    /// better over 0.5 s: where only the torque is a guess, a fitted moment goes with that torque. Both models have the same ones, so
    /// what is predicted is predicted with the model that is written.
    pub(super) fn keep_stated_moments(&mut self, flights: &Prepared) {
        let body = self.body();
        let mut theta = theta_of(&self.vehicle().body);
        let mut kept = Vec::new();
        for index in MOMENTS {
            if let Some(why) = body.get(index).and_then(|of| of.not_determined.clone()) {
                theta[index] = body[index].nominal;
                kept.push((index, format!("{why}; the model has the vehicle file's value")));
            }
        }
        // moments of two sources can be those of no body
        if kept.is_empty() || !is_physical(&theta) {
            return;
        }
        // their standard errors stay: what is no number changes nothing
        let value = |(index, _): &(usize, String)| (body[*index].name, (body[*index].nominal, f64::NAN));
        let values: Vec<_> = kept.iter().map(value).collect();
        let stated = self.explanation.with_values(&values, &values);
        let [fitted, by_stated] = [&self.explanation, &stated].map(|of| self.rates_rad_s(of, flights));
        if fitted.zip(by_stated).is_none_or(|(fitted, by_stated)| by_stated <= fitted) {
            self.explanation = stated;
            self.kept = kept;
        }
    }

    /// Root mean square error of the body rates over 0.5 s by the model of an explanation, as it is written; `None` where they are not
    /// predicted.
    fn rates_rad_s(&self, explanation: &Explanation, flights: &Prepared) -> Option<f64> {
        let explained = Explained::of(explanation);
        let settings = HoldoutSettings::default();
        let shown = without_law(explained, &flights.held_out(), &self.given.vehicle, &settings).ok()?;
        Some(OpenLoop::half_second(&shown)?.rates_rad_s?.after.value)
    }
}
