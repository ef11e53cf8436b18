//! Views of the study of `plan`: text for the terminal, JSON.

use crate::plan::Criterion;
use crate::study::{FlightExtremes, PlanStudy};
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt::Write;

/// The JSON document of `plan`.
#[derive(Debug, Clone, Serialize)]
pub struct PlanDocument {
    schema: u32,
    criterion: Criterion,
    criterion_value: Option<f64>,
    condition_number: f64,
    scaled_condition_number: f64,
    /// relative standard errors that the flight will have; none if it does not determine all seven parameters
    standard_errors: Option<BTreeMap<&'static str, f64>>,
    flight_s: f64,
    /// distance to each bound at samples of 2 ms, SI
    margins: BTreeMap<String, f64>,
    first_violation: Option<String>,
    /// share of the rotor commands at a rotor's bound in a simulated flight; none if it cannot be flown
    share_at_rotor_bound: Option<f64>,
    /// from takeoff to the series and back; none if no transition keeps the limits
    transitions: Option<Transitions>,
    /// extremes of the whole flight from takeoff to landing; none if no transition keeps the limits
    flown: Option<FlightExtremes>,
}

/// Transitions before and after the series.
#[derive(Debug, Clone, Copy, Serialize)]
struct Transitions {
    /// x, y, z (m), yaw (rad)
    takeoff: [f64; 4],
    /// the same before landing
    landing: [f64; 4],
    to_start_s: f64,
    to_landing_s: f64,
}

impl PlanDocument {
    /// The document of a study.
    #[must_use]
    pub fn new(study: &PlanStudy) -> Self {
        let worth = &study.assessment;
        Self {
            schema: 1,
            criterion: study.criterion,
            criterion_value: study.criterion_value,
            condition_number: worth.condition_number,
            scaled_condition_number: worth.scaled_condition_number,
            standard_errors: study.standard_errors().map(|errors| errors.into_iter().collect()),
            flight_s: worth.flight_s,
            margins: study.margins().collect(),
            first_violation: study.first_violation.clone(),
            share_at_rotor_bound: worth.share_at_bound,
            transitions: study.transitions.map(|around| Transitions {
                takeoff: around.takeoff,
                landing: around.landing,
                to_start_s: around.to_start_s,
                to_landing_s: around.to_landing_s,
            }),
            flown: study.flown,
        }
    }
}

/// Which of the standard errors of one number a plan states: the view of a flight and a model have others.
pub const EXPECTED_ERRORS: &str = "expected before the flight (rigid body alone, usual noise)";

/// The page for the terminal.
#[must_use]
pub fn plan_text(study: &PlanStudy) -> String {
    let worth = &study.assessment;
    let mut page = format!(
        "cond(W) {:.3}, with scaled columns {:.3}\n",
        worth.condition_number, worth.scaled_condition_number
    );
    // writing to a String cannot fail
    match study.standard_errors() {
        None => {
            let _ = writeln!(page, "this flight does not determine all seven parameters");
        }
        Some(errors) => {
            let _ =
                writeln!(page, "standard errors {EXPECTED_ERRORS}, after {} s of trajectory", worth.flight_s);
            for (name, share) in errors {
                let _ = writeln!(page, "  {name:<5} {:.2} %{}", 100.0 * share, of_what(name));
            }
        }
    }
    let _ = writeln!(page, "left to each bound on 2 ms samples");
    for margin in &worth.check.margins {
        let side = if margin.upper { "at most" } else { "at least" };
        let bound = format!("{}, {side}", margin.quantity.words());
        let _ = writeln!(page, "  {bound:<52} {}", margin.quantity.amount(margin.spare()));
    }
    if let Some(FlightExtremes { low_m, high_m, horizontal_speed_m_s, vertical_speed_m_s, tilt_deg }) =
        study.flown
    {
        let _ = writeln!(
            page,
            "flown: north {:.2} to {:.2} m, west {:.2} to {:.2} m, up {:.2} to {:.2} m; at most {horizontal_speed_m_s:.2} m/s along the ground, {vertical_speed_m_s:.2} m/s up or down, {tilt_deg:.1} degrees of tilt",
            low_m[0], high_m[0], low_m[1], high_m[1], low_m[2], high_m[2],
        );
    }
    let _ = match worth.share_at_bound {
        Some(share) => {
            writeln!(
                page,
                "flown in simulation, {:.1} % of the rotors' commands are at a bound",
                100.0 * share
            )
        }
        None => writeln!(page, "the simulated controller cannot fly it"),
    };
    if let Some(around) = &study.transitions {
        // no minus zero
        let shown = |place: [f64; 4]| place.map(|value| if value.abs() < 0.005 { 0.0 } else { value });
        let [x, y, z, _] = shown(around.takeoff);
        let (to_start_s, to_landing_s) = (around.to_start_s, around.to_landing_s);
        let _ = writeln!(page, "from hover at ({x:.2}, {y:.2}, {z:.2}) m to the start in {to_start_s:.2} s");
        let [x, y, z, _] = shown(around.landing);
        let _ = writeln!(page, "from the end to hover at ({x:.2}, {y:.2}, {z:.2}) m in {to_landing_s:.2} s");
        let whole_s = study.hover_to_hover_s().unwrap_or(worth.flight_s);
        let _ = writeln!(
            page,
            "the flight takes {whole_s:.0} s from hover to hover, {} s of them on the trajectory, and takeoff and landing beside it",
            worth.flight_s
        );
    }
    match &study.first_violation {
        Some(violation) => {
            let _ = write!(page, "first violation: {violation}");
        }
        None => {
            let _ = write!(page, "every bound is kept");
        }
    }
    page
}

/// The reference of a relative error: products of inertia are compared with the moments that they couple.
fn of_what(name: &str) -> &'static str {
    match name {
        "ixy" => " of sqrt(ixx iyy)",
        "ixz" => " of sqrt(ixx izz)",
        "iyz" => " of sqrt(iyy izz)",
        _ => "",
    }
}
