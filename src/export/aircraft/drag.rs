//! Drag as the autopilots' estimators of wind take it.
//!
//! EKF2 of PX4 (`fuseDrag`) and EKF3 of ArduPilot (`FuseDragForces`) expect along the body's x and y axes the acceleration
//! `-v_i M sqrt(rho / rho_0) - rho / 2 s v_i / B_i`: M is EKF2_MCOEF or EK3_DRAG_MCOEF (1/s), B_i is EKF2_BCOEF_X/Y or
//! EK3_DRAG_BCOEF_X/Y (kg/m^2), and a coefficient of 0 switches its part off. The speed s is the whole airspeed in PX4, which
//! takes between both axes an elliptic mean of B, and `|v_i|` in ArduPilot. With the model's linear drag d and quadratic drag c,
//! `M = d / m` and `B = rho_0 m / (2 c)` in air of the density rho_0.

use super::determined::Determined;
use super::parameter::AircraftParameter;
use super::table::{DragNames, Table};
use crate::export::source::Source;
use crate::text::{significant, with_error};
use crate::units::{AIR_DENSITY_KG_M3, air_density_ratio};

/// The effects that the estimator's drag holds.
const EFFECTS: [&str; 2] = ["linear_drag", "quadratic_drag"];
/// Largest coefficient of momentum drag that both autopilots document, 1/s.
const MOST_MOMENTUM: f64 = 1.0;
/// Smallest coefficients that both take for more than none: of momentum drag, 1/s, and of a bluff body, kg/m^2.
const LEAST_MOMENTUM: f64 = 0.001;
const LEAST_BALLISTIC: f64 = 1.0;
/// A drag is told from none where it is so many standard errors from none. It is the usual 95 %.
const TOLD: f64 = 2.0;

/// A coefficient of the estimator.
enum Coefficient {
    Found(AircraftParameter),
    /// the model has no such drag that is told from none: 0 says so
    Absent,
    /// there is one, and the parameter cannot hold it
    Beyond,
}

/// The estimator's drag, if one was identified.
pub(super) fn drag(
    source: &mut Source<'_>,
    determined: &Determined<'_>,
    table: &Table,
) -> Vec<AircraftParameter> {
    let names = &table.drag;
    let all = [
        (names.momentum, momentum(source, determined, names.momentum)),
        (names.ballistic[0], bluff(source, determined, names, 0)),
        (names.ballistic[1], bluff(source, determined, names, 1)),
    ];
    if all.iter().any(|(_, found)| matches!(found, Coefficient::Beyond)) {
        source.note("the drag of the estimator is left out as a whole: with a part of it alone the wind would come out wrong");
        EFFECTS.into_iter().for_each(|id| source.refuse(id));
        return Vec::new();
    }
    if all.iter().all(|(_, found)| matches!(found, Coefficient::Absent)) {
        source.note(format!(
            "{} and {}/{} are not written: the model contains no significant drag",
            names.momentum, names.ballistic[0], names.ballistic[1]
        ));
        EFFECTS.into_iter().for_each(|id| source.refuse(id));
        return Vec::new();
    }
    let found = |found: &Coefficient| matches!(found, Coefficient::Found(_));
    let [(_, linear), quadratic @ ..] = &all;
    let held = [found(linear), quadratic.iter().any(|(_, of_axis)| found(of_axis))];
    EFFECTS.into_iter().zip(held).filter(|(_, is_held)| !is_held).for_each(|(id, _)| source.refuse(id));
    tell_form(source, table);
    let control = names
        .control
        .map(|name| AircraftParameter::switch(name, 1.0, true, "the estimator takes drag to find the wind"));
    let each = all.into_iter().map(|(name, found)| match found {
        Coefficient::Found(parameter) => parameter,
        _ => AircraftParameter::switch(name, 0.0, false, "no such drag was found, and 0 switches it off"),
    });
    control.into_iter().chain(each).collect()
}

/// From the drag in proportion to the airspeed.
fn momentum(source: &mut Source<'_>, determined: &Determined<'_>, name: &str) -> Coefficient {
    let std = |axis| determined.std("linear_drag", axis);
    let (Some(std_x), Some(std_y)) = (std("dx"), std("dy")) else { return Coefficient::Absent };
    let (dx, dy) = (source.take("linear_drag", "dx"), source.take("linear_drag", "dy"));
    let (mass_kg, mass_std) = mass(source, determined);
    let differ = (dx - dy).abs() > TOLD * std_x.hypot(std_y);
    // the better known axis says more of one coefficient, but of two it is not more
    let share_x = if differ { 0.5 } else { std_y * std_y / (std_x * std_x + std_y * std_y) };
    // what errors along x and y have in common is not known: as if it were all
    let mean = share_x * dx + (1.0 - share_x) * dy;
    let mean_std = share_x * std_x + (1.0 - share_x) * std_y;
    let (air_ratio, air) = air(source);
    let value = mean / mass_kg / air_ratio.sqrt();
    if mean < TOLD * mean_std || value < LEAST_MOMENTUM {
        return Coefficient::Absent;
    }
    if differ {
        source.note(format!(
            "{name} is the same along x and y: from the mean of {} and {} N per m/s",
            with_error(dx, std_x),
            with_error(dy, std_y)
        ));
    }
    if value > MOST_MOMENTUM {
        source.note(format!(
            "{name} would be {value:.3} 1/s, more than the {MOST_MOMENTUM} that the autopilot documents"
        ));
        return Coefficient::Beyond;
    }
    let of = format!("{} along x and {} along y of the body", with_error(dx, std_x), with_error(dy, std_y));
    // the answer has one figure for all axes that agree, also z, which the estimator does not take
    let z = if determined.std("linear_drag", "dz").is_some() { ", without the report's z" } else { "" };
    let why = format!(
        "drag at hover of {} N per m/s ({of}{z}) over the mass of {mass_kg:.4} kg, {air}; wind was estimated with it where \
         there was one",
        with_error(mean, mean_std)
    );
    let std = value * (mean_std / mean).hypot(mass_std);
    Coefficient::Found(AircraftParameter::number(name, (value, std), "1/s", why))
}

/// From the drag with the square of the airspeed, along x or y.
fn bluff(
    source: &mut Source<'_>,
    determined: &Determined<'_>,
    names: &DragNames,
    along: usize,
) -> Coefficient {
    let (axis, name) = (["cx", "cy"][along], names.ballistic[along]);
    let (mass_kg, mass_std) = mass(source, determined);
    let Some(std) = determined.std("quadratic_drag", axis) else { return Coefficient::Absent };
    let drag = source.take("quadratic_drag", axis);
    let (air_ratio, air) = air(source);
    let value = 0.5 * AIR_DENSITY_KG_M3 * air_ratio * mass_kg / drag;
    // so slight that the autopilot has no number for it
    if drag < TOLD * std || value > names.most_ballistic {
        return Coefficient::Absent;
    }
    if value <= LEAST_BALLISTIC {
        source.note(format!(
            "{name} would be {value:.3} kg/m^2, and the autopilot takes {LEAST_BALLISTIC} and less for none"
        ));
        return Coefficient::Beyond;
    }
    let why =
        format!("drag of {} N per (m/s)^2 at the mass of {mass_kg:.4} kg, {air}", with_error(drag, std));
    Coefficient::Found(AircraftParameter::number(
        name,
        (value, value * (std / drag).hypot(mass_std)),
        "kg/m^2",
        why,
    ))
}

/// Density of the air of the flight over that at sea level, and what is said of it.
fn air(source: &Source<'_>) -> (f64, String) {
    let ratio = source.altitude_m.map(air_density_ratio);
    let density = AIR_DENSITY_KG_M3 * ratio.unwrap_or(1.0);
    let taken = if ratio.is_some() { "in" } else { "taken as in" };
    (ratio.unwrap_or(1.0), format!("{taken} air of {} kg/m^3", significant(density, 4)))
}

/// Tells where the autopilot's law of the quadratic drag is not the model's.
fn tell_form(source: &mut Source<'_>, table: &Table) {
    let Some(by_face) =
        source.value("quadratic_drag", "by_face").or_else(|| source.has("quadratic_drag").then_some(0.0))
    else {
        return;
    };
    if (by_face - table.drag.by_face).abs() > 0.5 || table.is_px4() {
        source.note(format!(
            "the estimator's quadratic drag along an axis goes with {}: it is the model's in flight along an axis, and differs across",
            table.drag.law
        ));
    }
}

/// kg, and its relative standard error; none where it was given.
fn mass(source: &Source<'_>, determined: &Determined<'_>) -> (f64, f64) {
    let mass_kg = source.vehicle.body.mass_kg;
    (mass_kg, determined.own("mass").map_or(0.0, |(value, std)| std / value))
}
