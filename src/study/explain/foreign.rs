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
    /// Explains a flight as a short one, because its hold-outs are of another vehicle, and shows the model on them all the same. The `first`
    /// study stays where hold-outs refuted or took back a name of it, and where they are of this vehicle by the other model.
    pub(super) fn judged_as_short(
        &self,
        (first, notes): (ExplainStudy, Vec<Note>),
        flights: &Prepared,
        (held, shown_on): (&Prepared, ValidationData),
    ) -> Result<(ExplainStudy, Vec<Note>), StudyError> {
        let told_short = |first| ExplainStudy { short: self.short.clone(), ..first };
        if first.refuted.is_some() || !first.withdrawn.is_empty() {
            return Ok((told_short(first), notes));
        }
        self.progress.stage(Stage::ExplainingAgain);
        let nothing = ValidationData::Nothing { reason: OF_ANOTHER_VEHICLE.to_owned() };
        let (alone, notes_alone) = self.explained(flights, (&Prepared::default(), None, nothing))?;
        let short = alone.short.clone();
        let (given, explanation) = alone.into_found();
        let mut on_held = self.evaluated(given, explanation, flights, (held, None, shown_on));
        if on_held.other_vehicle().is_none() {
            // a rotor that was changed is none of this model's
            let rotor = first.shown.as_ref().and_then(|shown| shown.other_vehicle.clone());
            let Some(rotor) = rotor.filter(|_| first.is_rotor_apart()) else {
                return Ok((told_short(first), notes));
            };
            on_held.take_rotor_apart(rotor);
        }
        Ok((ExplainStudy { short, ..on_held }, notes_alone))
    }
}
