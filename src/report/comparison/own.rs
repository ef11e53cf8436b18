//! What is the flights' own, and what speaks against one vehicle, in words.

use super::flight_name::{flight_name, with_names};
use crate::report::number::significant;
use crate::study::{CompareStudy, LiftsApart, LiftsOf};

/// That full thrust over weight moved, which is each flight's own and may hide what is the vehicle's, as sentences behind a space; empty
/// where it did not, or where the answer says it already.
pub(super) fn scale(study: &CompareStudy) -> String {
    let is_said = study.compared.as_ref().is_some_and(|compared| compared.other_vehicle.is_some());
    let Some(moved) = study.scale.filter(|_| !is_said) else { return String::new() };
    let path = |flight: usize| format!(" in {}", flight_name(study, flight));
    let [first, last] = moved.flights.map_or_else(Default::default, |flights| flights.map(path));
    format!(
        " The thrust for a command over the weight went from {}{first} to {}{last}: a payload, another battery or air density. These are \
         each flight's own. Rotors that give another thrust for a command do the same, one of them by its share: weigh the vehicle to \
         tell them from a payload.",
        significant(moved.before.0, 3),
        significant(moved.after.0, 3)
    )
}

/// Why the flights may be those of two vehicles, in a sentence or two; `None`: nothing says so.
pub(super) fn doubt(study: &CompareStudy) -> Option<String> {
    let serials = study.serials_apart.as_ref().map(|note| {
        format!("It is doubtful that this is one vehicle. {}.", with_names(study, &note.sentence()))
    });
    let all: Vec<String> =
        study.lifts_apart.iter().map(|lifts| two_vehicles(study, lifts)).chain(serials).collect();
    (!all.is_empty()).then(|| all.join(" "))
}

/// Flights of another thrust over weight that are listed by name; of more their number is told.
const LISTED: usize = 4;

/// That full thrust over weight makes two vehicles of the flights, which nothing else tells.
fn two_vehicles(study: &CompareStudy, lifts: &LiftsApart) -> String {
    let [before, after] = [lifts.before, lifts.after].map(|lift| significant(lift, 3));
    let path = |place: usize| flight_name(study, place);
    let of = match &lifts.of {
        LiftsOf::Groups => format!("{before} before and {after} after"),
        LiftsOf::From(from) => format!("{before} before {} and {after} from it on", path(*from)),
        LiftsOf::Odd(flights) if flights.len() > LISTED => {
            format!("{before} in most flights and as far from it as {after} in {} others", flights.len())
        }
        LiftsOf::Odd(flights) => {
            let lift = |place: usize| study.balance.flights[place].lift.map_or(lifts.after, |(lift, _)| lift);
            let of = |place: &usize| format!("{} in {}", significant(lift(*place), 3), path(*place));
            format!(
                "{} and {before} in the other flights",
                flights.iter().map(of).collect::<Vec<_>>().join(", ")
            )
        }
    };
    let told = if lifts.moved {
        "a parameter of the motion moved by more than chance as well"
    } else {
        "no parameter was compared that could tell"
    };
    format!(
        "It is doubtful that this is one vehicle: full thrust over weight is {of}, more than a battery or a load changes it, and {told}."
    )
}
