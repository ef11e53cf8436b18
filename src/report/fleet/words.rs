//! The report of a fleet in words.

use crate::fleet::{FleetReport, Outlier, ReportedVehicle};
use crate::report::comparison::step_words;
use crate::report::number::{chance, significant, with_error};

/// `3 of 41 vehicles changed.`
pub(super) fn answer(report: &FleetReport) -> String {
    let (changed, all) = (report.changed().count(), report.vehicles.len());
    let vehicles = if all == 1 { "vehicle" } else { "vehicles" };
    format!("{changed} of {all} {vehicles} changed.")
}

/// How often an unchanged vehicle is called changed.
pub(super) fn alarms(report: &FleetReport) -> String {
    let alarms = &report.alarms;
    let needs = significant(alarms.least_sigmas, 2);
    match alarms.rate() {
        Some((rate, most)) => format!(
            "A change needs {needs} standard deviations. By that bound, {} of {} histories of these vehicles whose flights were shuffled \
             were called changed ({} %, at most {} % with 95 % confidence): so many unchanged vehicles are called changed over the whole \
             of a history of {} flights.",
            alarms.called,
            alarms.shuffled,
            significant(100.0 * rate, 2),
            significant(100.0 * most, 2),
            significant(alarms.flights, 2)
        ),
        None => format!(
            "A change needs {needs} standard deviations, as in a comparison. These vehicles have too few flights, or days with flights, to \
             shuffle them: the rate of false alarms of this fleet is not known."
        ),
    }
}

/// What changed of a vehicle, step by step, each with its first flight.
pub(super) fn changes(vehicle: &ReportedVehicle) -> Vec<String> {
    let study = &vehicle.history.study;
    let name = |place: usize| {
        let path = &study.flights[place].input.path;
        format!("flight {} of {} ({path})", place + 1, study.flights.len())
    };
    study.history.iter().map(|step| step_words(study, step, &name)).collect()
}

/// One sentence for a vehicle that changed.
pub(super) fn change_sentence(vehicle: &ReportedVehicle) -> String {
    format!("{} changed {}.", vehicle.history.name, changes(vehicle).join("; "))
}

/// One sentence for a vehicle that differs.
pub(super) fn differs(outlier: &Outlier) -> String {
    let unit = if outlier.unit == "1" { String::new() } else { format!(" {}", outlier.unit) };
    format!(
        "{}: {} is {}{unit}; of the others of type {} it is {}{unit} with a spread of {}{unit} ({}).",
        outlier.vehicle,
        outlier.quantity,
        with_error(outlier.value, outlier.std),
        outlier.kind,
        significant(outlier.others, 3),
        significant(outlier.spread, 2),
        chance(outlier.chance)
    )
}

/// What became of the logs.
pub(super) fn logs(report: &FleetReport) -> String {
    let of = |status: &str| report.logs.get(status).copied().unwrap_or(0);
    format!(
        "{} logs: {} with a flight, {} without one that can be used, {} not asked for flights, {} that could not be read.",
        report.logs.values().sum::<usize>(),
        of("flown"),
        of("no_flight"),
        of("inspected"),
        of("error")
    )
}
