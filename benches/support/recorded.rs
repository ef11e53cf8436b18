//! Answers of the library as they are stored.

use mavid::fleet::FalseAlarms;
use mavid::study::{Changed, CompareStudy, Compared};

use super::comparison::{Answer, FoundChange};
use super::digits::short;
use super::fleet::Alarms;

/// What a comparison of these flights answered.
pub fn answer(study: &CompareStudy, compared: &Compared, (earlier, later): (&[&str], &[&str])) -> Answer {
    let names = |flights: &[&str]| flights.iter().map(|name| (*name).to_owned()).collect();
    let least = compared.balance.least.rotors.iter().copied().fold(0.0, f64::max);
    Answer {
        earlier: names(earlier),
        later: names(later),
        changes: changes(study, compared),
        least_rotor_percent: short(100.0 * least),
    }
}

/// The changes of a comparison, the strongest first.
pub fn changes(study: &CompareStudy, compared: &Compared) -> Vec<FoundChange> {
    let change = |change: &mavid::study::Change| FoundChange {
        what: match change.what {
            Changed::Rotor(_) => "rotor".to_owned(),
            Changed::CentreOfMass(_) => "centre of mass".to_owned(),
            Changed::YawTorque => "torque about the vertical".to_owned(),
            Changed::Balance => "balance".to_owned(),
            Changed::Parameter(place) => study.tracks[place].name.clone(),
        },
        motor: match change.what {
            Changed::Rotor(rotor) => Some(rotor + 1),
            _ => None,
        },
        after: change.moved.map(|moved| short(moved.after.0)),
        std: change.moved.map(|moved| short(moved.by.1)),
        sigmas: short(change.sigmas),
        rivals: change.rivals.len(),
    };
    compared.changes.iter().map(change).collect()
}

/// The bound of a report.
pub fn alarms(alarms: &FalseAlarms) -> Alarms {
    Alarms {
        least_sigmas: short(alarms.least_sigmas),
        shuffled: alarms.shuffled,
        called: alarms.called,
        greatest_rate_percent: alarms.rate().map_or(100.0, |(_, greatest)| short(100.0 * greatest)),
    }
}
