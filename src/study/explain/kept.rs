//! Moments of inertia that no flight determines.

use super::result::ExplainStudy;
use crate::diagnose::Explanation;
use crate::diagnose::holdout::{Explained, HoldoutSettings, OpenLoop, without_law};
use crate::estimate::{MOMENTS, Nominal, is_physical, theta_of};
use crate::study::flights::Prepared;

/// Place of the moment about z in mass and inertia.
const ABOUT_Z: usize = 6;
/// A moment about z is at most this share of the sum of the others: a body is no plate without thickness.
const PLATE: f64 = 0.98;

impl ExplainStudy {
    /// Moments of inertia that the flights do not determine stay as the vehicle file has them, unless the fitted ones predict body rates
    /// better over 0.5 s: where only the torque is a guess, a fitted moment goes with that torque. Both models have the same ones, so
    /// what is predicted is predicted with the model that is written. Where the stated moment about z is more than a body with the other
    /// moments can have, and the rotors' torque is a guess, both are lowered alike.
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
        if kept.is_empty() {
            return;
        }
        let is_guess = Nominal::of(&self.given.vehicle).guessed(ABOUT_Z) > 0.0;
        let most = PLATE * (theta[1] + theta[4]);
        let lowered = if is_guess && theta[ABOUT_Z] > most { most / theta[ABOUT_Z] } else { 1.0 };
        theta[ABOUT_Z] *= lowered;
        if !is_physical(&theta) {
            return;
        }
        // the value may be off by as much as the fitted one is away
        let value = |(index, _): &(usize, String)| {
            let of = &body[*index];
            (of.name, (theta[*index], (of.after.value - theta[*index]).hypot(of.after.std)))
        };
        let values: Vec<_> = kept.iter().map(value).collect();
        let mut stated = self.explanation.with_values(&values, &values);
        for fitted in [&mut stated.search.before, &mut stated.search.after] {
            fitted.base.vehicle.propulsion.torque_per_thrust_m *= lowered;
        }
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
