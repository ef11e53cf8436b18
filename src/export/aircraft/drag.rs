//! Drag as the autopilots' estimators of wind take it.
//!
//! EKF2 of PX4 (`fuseDrag`) and EKF3 of ArduPilot (`FuseDragForces`) expect along the body's x and y axes the acceleration
//! `-v_i M sqrt(rho / rho_0) - rho / 2 |v| v_i / B_i`: M is EKF2_MCOEF or EK3_DRAG_MCOEF (1/s), B_i is EKF2_BCOEF_X/Y or
//! EK3_DRAG_BCOEF_X/Y (kg/m^2), and a coefficient of 0 switches its part off. With the model's linear drag d and quadratic
//! drag c, `M = d / m` and `B = rho_0 m / (2 c)` in air of the density rho_0.

use super::determined::Determined;
use super::parameter::{AircraftParameter, ParameterStyle};
use crate::export::source::Source;
use crate::text::with_error;

/// Air at sea level in the standard atmosphere, kg/m^3.
const DENSITY_KG_M3: f64 = 1.225;
/// Largest coefficient of momentum drag that both autopilots document, 1/s.
const MOST_MOMENTUM: f64 = 1.0;
/// A bluff body is told from none where its drag is so many standard errors from none. Chosen: the usual 95 %.
const TOLD: f64 = 2.0;

/// Names of the parameters, and the largest ballistic coefficient that the autopilot documents, kg/m^2.
struct Names {
    control: Option<&'static str>,
    momentum: &'static str,
    ballistic: [&'static str; 2],
    most_ballistic: f64,
}

const fn names(style: ParameterStyle) -> Names {
    match style {
        ParameterStyle::Px4 => Names {
            control: Some("EKF2_DRAG_CTRL"),
            momentum: "EKF2_MCOEF",
            ballistic: ["EKF2_BCOEF_X", "EKF2_BCOEF_Y"],
            most_ballistic: 200.0,
        },
        ParameterStyle::ArduPilot => Names {
            control: None,
            momentum: "EK3_DRAG_MCOEF",
            ballistic: ["EK3_DRAG_BCOEF_X", "EK3_DRAG_BCOEF_Y"],
            most_ballistic: 1000.0,
        },
    }
}

/// The estimator's drag, if one was identified.
pub(super) fn drag(
    source: &mut Source<'_>,
    determined: &Determined<'_>,
    style: ParameterStyle,
) -> Vec<AircraftParameter> {
    let names = names(style);
    let momentum = momentum(source, determined, names.momentum);
    let bluff = bluff(source, determined, &names);
    if momentum.is_none() && bluff.iter().all(Option::is_none) {
        source.note(format!(
            "{} and {}/{} do not follow from this model: no drag with a standard error is in it",
            names.momentum, names.ballistic[0], names.ballistic[1]
        ));
        return Vec::new();
    }
    let off = |name: &str, what: &str| {
        AircraftParameter::switch(name, 0.0, false, format!("no {what} was found, and 0 switches it off"))
    };
    let mut parameters: Vec<AircraftParameter> = names
        .control
        .map(|name| AircraftParameter::switch(name, 1.0, true, "the estimator takes drag to find the wind"))
        .into_iter()
        .collect();
    parameters.push(momentum.unwrap_or_else(|| off(names.momentum, "drag in proportion to the airspeed")));
    for (name, found) in names.ballistic.into_iter().zip(bluff) {
        parameters
            .push(found.unwrap_or_else(|| off(name, "drag with the square of the airspeed along this axis")));
    }
    parameters
}

/// From the drag in proportion to the airspeed.
fn momentum(source: &mut Source<'_>, determined: &Determined<'_>, name: &str) -> Option<AircraftParameter> {
    let std = |axis| determined.std("linear_drag", axis);
    let (std_x, std_y) = (std("dx")?, std("dy")?);
    let (dx, dy) = (source.take("linear_drag", "dx"), source.take("linear_drag", "dy"));
    let (mass_kg, mass_std) = mass(source, determined);
    let mean = f64::midpoint(dx, dy);
    if (dx - dy).abs() > 2.0 * std_x.hypot(std_y) {
        source.note(format!(
            "{name} is the same along x and y: from the mean of {} and {} N per m/s",
            with_error(dx, std_x),
            with_error(dy, std_y)
        ));
    }
    let value = mean / mass_kg;
    if value > MOST_MOMENTUM {
        source.note(format!(
            "{name} is left out: it would be {value:.3} 1/s, more than the {MOST_MOMENTUM} that the autopilot documents"
        ));
        return None;
    }
    // what x and y have in common is not known: as if it were all
    let std = (f64::midpoint(std_x, std_y) / mass_kg).hypot(value * mass_std);
    let why = format!(
        "drag at hover of {} N per m/s over the mass of {mass_kg:.4} kg, taken as in air of {DENSITY_KG_M3} kg/m^3; wind was \
         estimated with it where there was one",
        with_error(mean, f64::midpoint(std_x, std_y))
    );
    Some(AircraftParameter::number(name, (value, std), "1/s", why))
}

/// From the drag with the square of the airspeed, along x and y.
fn bluff(
    source: &mut Source<'_>,
    determined: &Determined<'_>,
    names: &Names,
) -> [Option<AircraftParameter>; 2] {
    let (mass_kg, mass_std) = mass(source, determined);
    [("cx", names.ballistic[0]), ("cy", names.ballistic[1])].map(|(axis, name)| {
        let std = determined.std("quadratic_drag", axis)?;
        let drag = source.take("quadratic_drag", axis);
        if drag < TOLD * std {
            return None;
        }
        let value = 0.5 * DENSITY_KG_M3 * mass_kg / drag;
        if value > names.most_ballistic {
            return None;
        }
        let why = format!(
            "drag of {} N per (m/s)^2 at the mass of {mass_kg:.4} kg, taken as in air of {DENSITY_KG_M3} kg/m^3",
            with_error(drag, std)
        );
        Some(AircraftParameter::number(name, (value, value * (std / drag).hypot(mass_std)), "kg/m^2", why))
    })
}

/// kg, and its relative standard error; none where it was given.
fn mass(source: &Source<'_>, determined: &Determined<'_>) -> (f64, f64) {
    let mass_kg = source.vehicle.body.mass_kg;
    (mass_kg, determined.own("mass").map_or(0.0, |(value, std)| std / value))
}
