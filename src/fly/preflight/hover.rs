//! Check whether the vehicle file is that of this vehicle, by the autopilot's hover command and its rotor positions.

use super::Situation;
use crate::fly::finding::{Finding, Level};
use crate::fly::lift::apart;
use crate::fly::parameters::Parameters;
use crate::recording::Recording;
use crate::signals::{ARM_NOTABLE, Differing, RotorDifference, propulsion_from_log, rotor_difference};
use crate::vehicle::{Actuator, Propulsion, ThrustLaw, Vehicle};

/// Subject of the check of the thrust.
pub(crate) const HOVER: &str = "hover thrust";
/// Subject of the check of number and positions of the rotors.
pub(crate) const ROTORS: &str = "rotors";

/// Ratio from which the check of the hover thrust warns. An autopilot that never hovered has its default for the
/// hover thrust, which is wrong for many vehicles. Nominal files are off by up to 1.4; the rest is the autopilot's
/// default. Only a warning depends on it.
const HOVER_NOTABLE: f64 = 1.8;
/// Ratio from which the check of the hover thrust refuses. A file that is off by as much is taken for another
/// vehicle's; a smaller one would refuse where the autopilot has its default.
const HOVER_GROSS: f64 = 3.0;
/// Ratio of arm lengths from which the check of the rotors refuses. A file with that error is of another vehicle, or
/// in another unit.
const ARM_GROSS: f64 = 4.0;
/// PX4's rotor positions beyond this distance, m, may be ratios: 1 and -1, or -0.5 and 0.433.
const RATIOS_FROM: f64 = 0.5;

pub(super) fn findings(situation: &Situation<'_>) -> Vec<Finding> {
    let Situation { vehicle, parameters, .. } = *situation;
    let layout = layout(vehicle, parameters);
    // the number is not refused twice
    let rotors = match &layout {
        Some(refusal) if refusal.level == Level::Refusal => None,
        _ => rotors(vehicle, parameters),
    };
    hover(vehicle, parameters).into_iter().chain(layout).chain(rotors).collect()
}

/// Beyond `gross` a refusal, beyond `notable` a warning.
fn judged(
    subject: &'static str,
    (expected, came, remedy): (String, String, &'static str),
    (apart, notable, gross): (f64, f64, f64),
) -> Finding {
    if apart > gross {
        Finding::refusal(subject, expected, came, remedy)
    } else if apart > notable {
        Finding::warning(subject, expected, came, remedy)
    } else {
        Finding::ok(subject, expected, came)
    }
}

/// Thrust of all rotors of the file at the command with which the autopilot expects to hover, against the weight.
fn hover(vehicle: &Vehicle, parameters: &Parameters) -> Option<Finding> {
    let outputs = &parameters.autopilot.stack()?.outputs;
    let name = outputs.hover;
    let expo = parameters.get(outputs.expo).or_else(|| outputs.linear_without_expo.then_some(0.0))?;
    let share = parameters.get(name).filter(|share| *share > 0.0)?;
    // the autopilot's own curve, from its share of the full thrust to the command
    let curve = Propulsion {
        actuator: Actuator::Thrust,
        law: ThrustLaw::Curve { thrust_max_n: 1.0, expo },
        ..vehicle.propulsion
    };
    let recording = Recording {
        parameters: parameters.values.clone(),
        autopilot: parameters.autopilot,
        ..Recording::default()
    };
    let (propulsion, _) = propulsion_from_log(&recording, &vehicle.propulsion);
    let rotors = vehicle.rotors.len() as f64;
    let lifted_n = rotors * propulsion.thrust_from_command_n(curve.command_from_thrust(share));
    let weight_n = vehicle.body.mass_kg * vehicle.gravity_m_s2;
    let words = (
        format!("the vehicle file's weight, {weight_n:.3} N"),
        format!("{lifted_n:.3} N by the file's thrust at {name} = {share:.3}"),
        "see that the vehicle file is this vehicle's and its thrust right, or set the parameter to what it hovers on \
         (--accept hover-thrust flies all the same)",
    );
    Some(judged(HOVER, words, (apart(lifted_n, weight_n), HOVER_NOTABLE, HOVER_GROSS)))
}

/// Order, places and turning directions of the rotors: the flight does not need them, and what is identified from it does.
fn layout(vehicle: &Vehicle, parameters: &Parameters) -> Option<Finding> {
    let RotorDifference { of, file, stated } =
        rotor_difference(parameters.autopilot, &parameters.values, vehicle)?;
    match of {
        Differing::Count => {
            let expected = format!("{file}, as the vehicle file has");
            Some(Finding::refusal(ROTORS, expected, stated, OTHER_FILE))
        }
        Differing::Order | Differing::Place | Differing::Spin => {
            let expected = format!("the rotors as the vehicle file has them, {file}");
            let remedy = "what is identified from the flight needs the file's rotors in the order of the motors, at their places \
                          and turning their way";
            Some(Finding::warning(ROTORS, expected, stated, remedy))
        }
        Differing::Arms(_) => None,
    }
}

/// What to do where the file is another vehicle's.
const OTHER_FILE: &str = "see that the vehicle file is this vehicle's (--accept rotors flies all the same)";

/// Number of rotors and their distance from the middle, as PX4 has them.
fn rotors(vehicle: &Vehicle, parameters: &Parameters) -> Option<Finding> {
    let remedy = OTHER_FILE;
    let wanted = vehicle.rotors.len();
    let count = parameters.get("CA_ROTOR_COUNT").filter(|count| *count > 0.0)?;
    if (count - wanted as f64).abs() > 0.5 {
        let expected = format!("{wanted}, as the vehicle file has");
        return Some(Finding::refusal(ROTORS, expected, format!("CA_ROTOR_COUNT = {count:.0}"), remedy));
    }
    let entry = |rotor: usize, end: &str| parameters.get(&format!("CA_ROTOR{rotor}_{end}"));
    let places: Option<Vec<[f64; 2]>> =
        (0..wanted).map(|rotor| Some([entry(rotor, "PX")?, entry(rotor, "PY")?])).collect();
    let places = places?;
    if places.iter().flatten().any(|coordinate| coordinate.abs() >= RATIOS_FROM) {
        return None;
    }
    let mean = |sum_m: f64| sum_m / wanted as f64;
    let came_m = mean(places.iter().map(|[x, y]| x.hypot(*y)).sum());
    let expected_m = mean(vehicle.rotors.iter().map(|rotor| rotor.position_m.xy().norm()).sum());
    let words = (
        format!("{expected_m:.3} m from the middle, as the vehicle file has"),
        format!("{came_m:.3} m (CA_ROTOR0_PX, CA_ROTOR0_PY and on)"),
        remedy,
    );
    Some(judged(ROTORS, words, (apart(came_m, expected_m), ARM_NOTABLE, ARM_GROSS)))
}
