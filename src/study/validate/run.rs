//! Opens models and logs, and compares each flight with all models.

use super::flight::{CUTOFF_HZ, flight};
use super::model::{contenders, drafted};
use super::request::ValidateRequest;
use super::result::{ValidateStudy, ValidatedFlight};
use crate::study::flight::Flight;
use crate::study::flights::{VALIDATED, load_all, ready};
use crate::study::one_vehicle::refuse_other_builds;
use crate::study::same_flight::refuse_same_flight;
use crate::study::unflown::unflown_first;
use crate::study::{Progress, Stage, StudyError};
use rayon::prelude::*;

/// Compares models with recorded flights: flown again in closed loop, by the output of the regression models, and
/// played back in open loop.
///
/// # Errors
/// [`StudyError`] where a file or a setting cannot be used, or a log holds nothing to compare with.
pub fn validate(request: &ValidateRequest, progress: &dyn Progress) -> Result<ValidateStudy, StudyError> {
    request.check()?;
    let (mut models, mut notes) = contenders(&request.models, progress)?;
    progress.stage(Stage::Reading);
    let logs = load_all(&request.logs, &request.read, &VALIDATED)?;
    if let Some(given) = request.drafted {
        let or_unflown = |error| unflown_first(error, &request.logs, &request.read);
        let (drafted, of_draft) = drafted(given, &logs).map_err(or_unflown)?;
        of_draft.iter().for_each(|note| progress.note(note));
        notes.splice(0..0, of_draft);
        models.insert(0, drafted);
    }
    refuse_same_flight(logs.iter())?;
    refuse_other_builds(logs.iter().flatten())?;
    progress.stage(Stage::Predicting);
    progress.steps(logs.iter().map(Vec::len).sum::<usize>() as u64);
    let compared = |of: &Flight| {
        let compared = flight(of, &models, request.transient_s);
        progress.step();
        compared
    };
    let one = |log| ready(log, compared);
    let done: Vec<_> = logs.into_par_iter().map(one).collect();
    let mut flights = Vec::new();
    for log in done {
        // what is to be said of flights that were left out stands with the first that was not
        flights
            .extend(log?.into_iter().map(|(of, compared)| ValidatedFlight { input: of.input, ..compared }));
    }
    let models = models.into_iter().map(|model| model.of).collect();
    Ok(ValidateStudy { models, flights, transient_s: request.transient_s, cutoff_hz: CUTOFF_HZ, notes })
}
