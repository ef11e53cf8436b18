//! Measures what each effect of the model is worth.

use super::result::ExplainStudy;
use super::worth::Worth;
use crate::diagnose::holdout::{HeldOut, HoldoutSettings, without_each};

impl ExplainStudy {
    /// Measures it on these flights; nothing where they cannot be played back, of which the prediction has told.
    pub(super) fn measure_worth(&mut self, flights: &[HeldOut], used: bool, settings: &HoldoutSettings) {
        let effects = self.terms_of_model();
        if effects.is_empty() {
            return;
        }
        let vehicle = &self.given.vehicle;
        let measured = without_each(self.explained(), &effects, (flights, used), (vehicle, settings));
        self.worth = measured.ok().map(|each| Worth { each, on_explained: used });
    }

    /// The effects of the model file, each with the terms of the fit that it is made of: one isotropic drag stands for two.
    fn terms_of_model(&self) -> Vec<(&'static str, Vec<&'static str>)> {
        let ids: Vec<&'static str> =
            self.effects_of_model().iter().map(|active| active.effect().id()).collect();
        let terms = &self.explanation.search.after.base.effects;
        let part_of = |id: &'static str| {
            let parts = terms
                .iter()
                .filter(move |term| term.signature.role.axial_part_of.is_some_and(|whole| whole.id() == id));
            parts.map(|term| term.id()).filter(|part| !ids.contains(part)).collect::<Vec<_>>()
        };
        let mut told: Vec<(&'static str, Vec<&'static str>)> = Vec::new();
        for &id in &ids {
            if told.iter().all(|(known, _)| *known != id) {
                told.push((id, std::iter::once(id).chain(part_of(id)).collect()));
            }
        }
        told
    }
}
