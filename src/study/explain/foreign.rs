//! A short flight with hold-outs of another vehicle.

use super::prepared::Task;
use super::result::ExplainStudy;
use super::validation_data::ValidationData;
use crate::note::Note;
use crate::study::flights::Prepared;
use crate::study::{Stage, StudyError};

/// Why nothing is held out.
const OF_ANOTHER_VEHICLE: &str = "the hold-out is of another vehicle";

impl Task<'_> {
    /// Explains the flights as without these hold-outs, which are of another vehicle, and shows the model on them all the same.
    pub(super) fn explained_without(
        &self,
        held: &Prepared,
        flights: &Prepared,
        shown_on: ValidationData,
    ) -> Result<(ExplainStudy, Vec<Note>), StudyError> {
        self.progress.stage(Stage::ExplainingAgain);
        let nothing = ValidationData::Nothing { reason: OF_ANOTHER_VEHICLE.to_owned() };
        let (found, refused) = self.explained(flights, (&Prepared::default(), None, nothing))?;
        let (short, withdrawn) = (found.short.clone(), found.withdrawn.clone());
        let (given, explanation) = found.into_found();
        let on_held = self.evaluated(given, explanation, flights, (held, None, shown_on));
        Ok((ExplainStudy { short, withdrawn, ..on_held }, refused))
    }
}
