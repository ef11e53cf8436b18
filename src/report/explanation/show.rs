//! The better model on flights that were not used.

use super::prediction::{Predicted, ShownOn};
use super::story::Story;
use crate::diagnose::Empirical;
use crate::diagnose::holdout::{HeldOut, HoldoutError, HoldoutSettings, on_holdout, on_identification};

impl Story {
    /// Errors before and after on the flights that were explained.
    ///
    /// # Errors
    /// [`HoldoutError`] where a flight cannot be played back.
    pub fn show_identification(
        &mut self,
        flights: &[HeldOut],
        empirical: Option<&Empirical>,
    ) -> Result<(), HoldoutError> {
        let of = (&self.explanation, empirical);
        let (open_loop, improvement_percent) =
            on_identification(of, flights, &self.given.vehicle, &HoldoutSettings::default())?;
        self.identify = Some(Predicted { open_loop, improvement_percent });
        Ok(())
    }

    /// Errors before and after on flights that were not used.
    ///
    /// # Errors
    /// [`HoldoutError`] where a flight cannot be played back.
    pub fn show_holdout(
        &mut self,
        flights: &[HeldOut],
        empirical: Option<&Empirical>,
        shown_on: ShownOn,
    ) -> Result<(), HoldoutError> {
        let same_flight = matches!(shown_on, ShownOn::HeldBack { .. });
        let settings = HoldoutSettings { same_flight, ..HoldoutSettings::default() };
        let shown = on_holdout((&self.explanation, empirical), flights, &self.given.vehicle, &settings)?;
        self.given.warnings.extend(shown.other_vehicle.as_ref().map(|other| other.reason.clone()));
        self.holdout = Some(Predicted::from(&shown));
        self.shown = Some(shown);
        self.shown_on = shown_on;
        Ok(())
    }
}
