//! Drag as the autopilots' estimators of wind take it.
//!
//! EKF2 of PX4 (`fuseDrag`) and EKF3 of ArduPilot (`FuseDragForces`) expect along the body's x and y axes the acceleration
//! `-v_i M sqrt(rho / rho_0) - rho / 2 s v_i / B_i`: M is EKF2_MCOEF or EK3_DRAG_MCOEF (1/s), B_i is EKF2_BCOEF_X/Y or
//! EK3_DRAG_BCOEF_X/Y (kg/m^2), and a coefficient of 0 switches its part off. The speed s is the whole airspeed in PX4, which
//! takes between both axes an elliptic mean of B, and `|v_i|` in ArduPilot. With the model's linear drag d and quadratic drag c,
//! `M = d / m` and `B = rho_0 m / (2 c)` in air of the density rho_0.
//!
//! A flight shows force per mass. The scale of the thrust is in the errors of d, of c and of m, and it is not in those of their ratios.

use super::determined::Determined;
use super::parameter::{AircraftParameter, within};
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
/// A drag helps the estimator if its value is so many standard errors: its error is at most half of it.
const HELPS: f64 = 2.0;
/// Two axes differ if their drags are so many standard errors apart. It is the usual 95 %.
const TOLD: f64 = 2.0;

/// A coefficient of the estimator.
enum Coefficient {
    Found(AircraftParameter),
    /// the model has no such drag: 0 says so
    Absent,
    /// the model has one, and this is why no parameter follows from it
    Unsure(String),
    /// there is one, and the parameter cannot hold it
    Beyond,
}

impl Coefficient {
    fn is_found(&self) -> bool {
        matches!(self, Self::Found(_))
    }

    /// Why a drag of the model has no coefficient.
    fn unsure(&self) -> Option<&str> {
        if let Self::Unsure(why) = self { Some(why) } else { None }
    }
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
    if !all.iter().any(|(_, found)| found.is_found()) {
        let reasons: Vec<&str> = all.iter().filter_map(|(_, found)| found.unsure()).collect();
        let why =
            if reasons.is_empty() { "the model contains no drag".to_owned() } else { reasons.join("; ") };
        source.note(format!(
            "{} and {}/{} are not written: {why}",
            names.momentum, names.ballistic[0], names.ballistic[1]
        ));
        return Vec::new();
    }
    tell_form(source, table);
    let control = names
        .control
        .map(|name| AircraftParameter::switch(name, 1.0, true, "the estimator takes drag to find the wind"));
    let each = all.into_iter().map(|(name, found)| match found {
        Coefficient::Found(parameter) => parameter,
        Coefficient::Unsure(why) => {
            AircraftParameter::switch(name, 0.0, false, format!("0 switches it off: {why}"))
        }
        Coefficient::Absent | Coefficient::Beyond => {
            AircraftParameter::switch(name, 0.0, false, "no such drag was found, and 0 switches it off")
        }
    });
    control.into_iter().chain(each).collect()
}

/// Why a drag without a standard error has no coefficient.
fn without_error(drag: &str) -> Coefficient {
    Coefficient::Unsure(format!("the model's file holds no standard error of {drag}"))
}

/// Why a drag whose error is above half of it has no coefficient; `unit` is that of both.
fn hardly_known(drag: &str, value: f64, std: f64, unit: &str) -> Coefficient {
    let [value, std] = [value, std].map(|number| significant(number, 2));
    Coefficient::Unsure(format!("{drag} is known to {value} +- {std} {unit} only; fly again"))
}

/// Standard error of a drag over the mass, relative to it, by the scale of the thrust: zero where both do not hold it. A flight tells
/// `d / m`, and a bent thrust curve moves the mass and with it d. It is then nearly all of the error of the mass.
fn scale_std(determined: &Determined<'_>) -> f64 {
    let mass = determined.std("thrust_curve", "curvature").and(determined.own("mass"));
    mass.map_or(0.0, |(value, std)| std / value)
}

/// Standard error of a drag without what it has in common with that of the mass (`scale_std`, relative); all of it where it is not
/// larger than that, because it then does not hold it.
fn over_mass(drag: f64, std: f64, scale_std: f64) -> f64 {
    let rest = std * std - (scale_std * drag).powi(2);
    if rest > 0.0 { rest.sqrt() } else { std }
}

/// Drag along x and y of the body, N/(m/s), each with its standard error at one mass.
struct Across {
    x: (f64, f64),
    y: (f64, f64),
    /// of both errors (-1 to 1)
    correlation: f64,
}

impl Across {
    /// From drags along x and y with their standard errors, of which `correlation` (-1 to 1) is; `scale_std` is that of the mass which
    /// both hold.
    fn at_one_mass([x, y]: [(f64, f64); 2], correlation: f64, scale_std: f64) -> Self {
        let free = |(drag, std): (f64, f64)| (drag, over_mass(drag, std, scale_std));
        let at_one_mass = Self { x: free(x), y: free(y), correlation };
        let together = correlation * x.1 * y.1 / (at_one_mass.x.1 * at_one_mass.y.1);
        Self { correlation: together.clamp(-1.0, 1.0), ..at_one_mass }
    }

    /// Whether one coefficient cannot stand for both axes.
    fn differs(&self) -> bool {
        (self.x.0 - self.y.0).abs() > TOLD * self.x.1.hypot(self.y.1)
    }

    /// N/(m/s), the mean and its standard error. The better known axis says more of one coefficient, but of two it is not more.
    fn mean(&self) -> (f64, f64) {
        let ((x, std_x), (y, std_y)) = (self.x, self.y);
        let share_x = if self.differs() { 0.5 } else { std_y * std_y / (std_x * std_x + std_y * std_y) };
        let (part_x, part_y) = (share_x * std_x, (1.0 - share_x) * std_y);
        let variance = part_x * part_x + part_y * part_y + 2.0 * self.correlation * part_x * part_y;
        (share_x * x + (1.0 - share_x) * y, variance.max(0.0).sqrt())
    }
}

/// From the drag in proportion to the airspeed.
fn momentum(source: &mut Source<'_>, determined: &Determined<'_>, name: &str) -> Coefficient {
    if !source.has("linear_drag") {
        return Coefficient::Absent;
    }
    let std = |axis| determined.std("linear_drag", axis);
    let (dx, dy) = (source.take("linear_drag", "dx"), source.take("linear_drag", "dy"));
    let (Some(std_x), Some(std_y)) = (std("dx"), std("dy")) else { return without_error("the drag") };
    // without a word of it, as if the errors along x and y were all the same
    let correlation = determined.correlation("linear_drag", ["dx", "dy"]).unwrap_or(1.0);
    let scale_std = scale_std(determined);
    let across = Across::at_one_mass([(dx, std_x), (dy, std_y)], correlation, scale_std);
    let (mean, mean_std) = across.mean();
    // as the report has it
    let of_mean = with_error(mean, mean_std.hypot(scale_std * mean));
    let mass_kg = source.vehicle.body.mass_kg;
    let (air_ratio, air) = air(source);
    let value = mean / mass_kg / air_ratio.sqrt();
    if mean < HELPS * mean_std {
        return hardly_known("the drag", mean, mean_std, "N/(m/s)");
    }
    if value < LEAST_MOMENTUM {
        return Coefficient::Unsure(format!(
            "the drag would be {} 1/s, and the autopilot takes less than {LEAST_MOMENTUM} for none",
            significant(value, 2)
        ));
    }
    let [x, y] = [(dx, std_x), (dy, std_y)].map(|(drag, std)| with_error(drag, std));
    if across.differs() {
        source.note(format!("{name} is the same along x and y: from the mean of {x} and {y} N per m/s"));
    }
    let std = value * mean_std / mean;
    let Some((held, limited)) = within((value, std), (0.0, MOST_MOMENTUM)) else {
        source.note(format!(
            "{name} would be {value:.3} 1/s, more than the {MOST_MOMENTUM} that the autopilot documents"
        ));
        return Coefficient::Beyond;
    };
    // the answer has one figure for all axes that agree, also z, which the estimator does not take
    let has_z = determined.std("linear_drag", "dz").is_some();
    let z = if has_z {
        ", without the report's z: its one figure for x, y and z has a smaller error, as if those of the axes were independent"
    } else {
        ""
    };
    let why = format!(
        "{limited}drag at hover of {of_mean} N per m/s ({x} along x and {y} along y of the body{z}) over the mass of {mass_kg:.4} kg, {air}; \
         wind was estimated with it where there was one"
    );
    Coefficient::Found(AircraftParameter::number(name, (held, std), "1/s", why))
}

/// From the drag with the square of the airspeed, along x or y.
fn bluff(
    source: &mut Source<'_>,
    determined: &Determined<'_>,
    names: &DragNames,
    along: usize,
) -> Coefficient {
    let (axis, name) = (["cx", "cy"][along], names.ballistic[along]);
    if !source.has("quadratic_drag") {
        return Coefficient::Absent;
    }
    let said = format!("the drag with the square of the airspeed along {}", ["x", "y"][along]);
    let mass_kg = source.vehicle.body.mass_kg;
    let drag = source.take("quadratic_drag", axis);
    let Some(std) = determined.std("quadratic_drag", axis) else { return without_error(&said) };
    let (air_ratio, air) = air(source);
    let value = 0.5 * AIR_DENSITY_KG_M3 * air_ratio * mass_kg / drag;
    let drag_std = over_mass(drag, std, scale_std(determined));
    if drag < HELPS * drag_std {
        return hardly_known(&said, drag, drag_std, "N/(m/s)^2");
    }
    if value > names.most_ballistic {
        return Coefficient::Unsure(format!(
            "{said} is so slight that it would need {value:.0} kg/m^2, and the autopilot documents up to {}",
            names.most_ballistic
        ));
    }
    if value <= LEAST_BALLISTIC {
        source.note(format!(
            "{name} would be {value:.3} kg/m^2, and the autopilot takes {LEAST_BALLISTIC} and less for none"
        ));
        return Coefficient::Beyond;
    }
    let why =
        format!("drag of {} N per (m/s)^2 at the mass of {mass_kg:.4} kg, {air}", with_error(drag, std));
    Coefficient::Found(AircraftParameter::number(name, (value, value * drag_std / drag), "kg/m^2", why))
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_error_of_a_mean_is_that_of_its_axes_and_of_how_they_go_together() {
        let of = |correlation| Across { x: (0.3, 0.04), y: (0.4, 0.04), correlation }.mean();
        // (0.04^2 + 0.04^2) / 4 is 0.0283^2, and two errors that are the same stay 0.04
        for (correlation, std) in [(0.0, 0.028_284), (1.0, 0.04), (-1.0, 0.0)] {
            assert!((of(correlation).0 - 0.35).abs() < 1e-12, "{correlation}");
            assert!((of(correlation).1 - std).abs() < 1e-6, "{correlation}: {}", of(correlation).1);
        }
        // axes that differ count alike: 0.3 and 0.9 by 0.01 and 0.03
        let apart = Across { x: (0.3, 0.01), y: (0.9, 0.03), correlation: 1.0 };
        assert!(apart.differs() && (apart.mean().0 - 0.6).abs() < 1e-12);
        assert!((apart.mean().1 - 0.02).abs() < 1e-12);
    }

    /// The scale of the thrust moves drag and mass alike.
    #[test]
    fn the_error_of_the_thrusts_scale_is_none_of_a_drag_over_the_mass() {
        // 27 % by the scale and 3 % along each axis, which are independent
        let (scale, own) = (0.27_f64, 0.03_f64);
        let whole = scale.hypot(own);
        let across = Across::at_one_mass([(0.5, 0.5 * whole), (0.5, 0.5 * whole)], 0.0, scale);
        assert!((across.x.1 - 0.5 * own).abs() < 1e-12 && (across.y.1 - 0.5 * own).abs() < 1e-12);
        assert!((across.mean().1 - 0.5 * own / 2.0_f64.sqrt()).abs() < 1e-12);
        // a drag that is known better than the scale does not hold its error, and nothing is taken from a mass that was given
        assert_eq!([over_mass(0.5, 0.01, 0.27), over_mass(0.5, 0.01, 0.0)], [0.01, 0.01]);
    }
}
