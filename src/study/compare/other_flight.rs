//! Whether flights that are compared are different flights.

use crate::signals::clock_offset;
use crate::study::StudyError;
use crate::study::flight::Flight;
use crate::study::flights::shared;

/// A flight before and after is the same flight where one holds a part of the other, or where the vehicle logged the one and the
/// ground station the other of one flight. Two flights of one trajectory are alike, and are no such thing.
pub(super) fn refuse_same_flight(before: &[Vec<Flight>], after: &[Vec<Flight>]) -> Result<(), StudyError> {
    for later in after.iter().flatten() {
        for earlier in before.iter().flatten() {
            let is_same = shared(&later.recording, &earlier.recording).is_some()
                || earlier.logged_by != later.logged_by
                    && clock_offset(&earlier.recording, &later.recording).is_some();
            if is_same {
                let why = format!(
                    "expected another flight, but {} is another log of the flight of {}",
                    later.input.path, earlier.input.path
                );
                return Err(StudyError::Setting { name: "with", why });
            }
        }
    }
    Ok(())
}
