//! Hover throttle, thrust curve and battery compensation.
//!
//! Both autopilots take the share of thrust `(1 - f) u + f u^2` for a command u of the motors, and invert it: f is
//! THR_MDL_FAC or MOT_THST_EXPO. MPC_THR_HOVER and MOT_THST_HOVER are shares of thrust behind that curve.

use super::determined::Determined;
use super::parameter::AircraftParameter;
use super::table::{Table, ThrustNames};
use crate::export::source::Source;
use crate::text::with_error;
use crate::units::{AIR_DENSITY_KG_M3, air_density_ratio};
use crate::vehicle::ThrustLaw;

/// A rotor's thrust about hover: its command there, and by how many per cent the thrust grows with one per cent of command.
#[derive(Debug, Clone, Copy)]
struct AtHover {
    command: f64,
    elasticity: f64,
}

impl AtHover {
    /// Factor f of the curve `(1 - f) u + f u^2` that has this elasticity at this command.
    fn factor(self) -> f64 {
        let beyond_linear = self.elasticity - 1.0;
        beyond_linear / (beyond_linear + self.command * (1.0 - beyond_linear))
    }
}

/// Share of full thrust by a curve of this factor.
fn share(factor: f64, command: f64) -> f64 {
    (1.0 - factor) * command + factor * command * command
}

/// Curve, hover and battery, as far as they were identified.
pub(super) fn thrust(
    source: &mut Source<'_>,
    determined: &Determined<'_>,
    table: &Table,
) -> Vec<AircraftParameter> {
    let names = &table.thrust;
    let propulsion = source.vehicle.propulsion;
    // one rotor that gives less needs more of the command
    let more = hover_commands(source);
    let command = propulsion.command_from_thrust(more * source.airframe.hover_thrust_n);
    let stated = match propulsion.law {
        ThrustLaw::Speed { .. } => 1.0,
        ThrustLaw::Curve { expo, .. } => expo,
    };
    let law = AtHover { command, elasticity: 1.0 + stated * command / ((1.0 - stated) + stated * command) };
    let mut parameters = Vec::new();
    let curve = curve(source, determined, law, names);
    let factor = curve.as_ref().map_or(stated, |curve| curve.value);
    let factor_std = curve.as_ref().and_then(|curve| curve.std).unwrap_or(0.0);
    parameters.extend(curve);
    parameters.extend(hover(source, determined, (factor, factor_std, command), names));
    parameters.extend(battery(source, determined, (factor, command), table));
    parameters
}

/// Mean over the rotors of what each must be commanded to carry its share, over what a sound one must.
fn hover_commands(source: &Source<'_>) -> f64 {
    let count = source.vehicle.rotors.len() as f64;
    let weak = source.value("weak_rotor", "factor").filter(|factor| *factor > 0.0);
    weak.map_or(1.0, |factor| (count - 1.0 + factor.recip()) / count)
}

fn curve(
    source: &mut Source<'_>,
    determined: &Determined<'_>,
    law: AtHover,
    names: &ThrustNames,
) -> Option<AircraftParameter> {
    let Some(std) = determined.std("thrust_curve", "curvature") else {
        source.note(format!(
            "{} does not follow from this model: no other thrust curve than the vehicle file's was identified",
            names.curve
        ));
        return None;
    };
    let curvature = source.take("thrust_curve", "curvature");
    let at = |curvature: f64| AtHover { elasticity: law.elasticity * (1.0 + curvature), ..law }.factor();
    let value = at(curvature);
    let (least, most) = names.curve_bounds;
    if !(least..=most).contains(&value) {
        source.refuse("thrust_curve");
        source.note(format!(
            "{} is left out: the curve that was identified would need {value:.3}, and the autopilot documents {least} to {most}",
            names.curve
        ));
        return None;
    }
    let value_std = 0.5 * (at(curvature + std) - at(curvature - std)).abs();
    let why = format!(
        "thrust curve about hover, bent by {} against that of the vehicle file",
        with_error(curvature, std)
    );
    Some(AircraftParameter::number(names.curve, (value, value_std), "-", why))
}

fn hover(
    source: &mut Source<'_>,
    determined: &Determined<'_>,
    (factor, factor_std, command): (f64, f64, f64),
    names: &ThrustNames,
) -> Option<AircraftParameter> {
    let Some(load_std) = determined.load_relative_std() else {
        source.note(format!(
            "{} does not follow from this model: neither mass nor thrust was identified with a standard error",
            names.hover
        ));
        return None;
    };
    let (air_ratio, air) = air(source.altitude_m, names.by_density);
    let value = air_ratio * share(factor, command);
    let (least, most) = names.hover_bounds;
    if !(least..=most).contains(&value) {
        source.note(format!(
            "{} is left out: it would be {value:.3}, and the autopilot documents {least} to {most}",
            names.hover
        ));
        return None;
    }
    let by_curve = air_ratio * factor_std * command * (1.0 - command);
    let voltage = source.value("battery_sag", "full_voltage");
    let voltage = voltage.map_or_else(
        || "at the battery voltage of the flight (the model file does not hold the voltage)".to_owned(),
        |full_v| format!("at a battery voltage of {full_v:.2} V"),
    );
    let why = format!(
        "weight of {:.4} kg over full thrust of all rotors {voltage}, with {} = {factor:.3}; {air}",
        source.vehicle.body.mass_kg, names.curve
    );
    Some(AircraftParameter::number(names.hover, (value, (value * load_std).hypot(by_curve)), "-", why))
}

/// What a hover throttle is multiplied by for the air of the flight's place, and the reason.
fn air(altitude_m: Option<f64>, by_density: bool) -> (f64, String) {
    match (by_density, altitude_m) {
        (false, _) => (1.0, "it belongs to the air of the flight: denser air needs less".to_owned()),
        (true, None) => {
            let told = "as in air of 1.225 kg/m^3, by which the autopilot scales it: 5 % too high if the flight was at 540 m above \
                        the sea, 10 % at 1100 m, unless --altitude states the height";
            (1.0, told.to_owned())
        }
        (true, Some(altitude_m)) => {
            let ratio = air_density_ratio(altitude_m);
            let told = format!(
                "in air of {:.3} kg/m^3 ({altitude_m:.0} m above the sea), for the {AIR_DENSITY_KG_M3} kg/m^3 by which the autopilot \
                 scales it",
                AIR_DENSITY_KG_M3 * ratio
            );
            (ratio, told)
        }
    }
}

/// ArduPilot's compensation of the voltage; PX4's has a law of its own.
fn battery(
    source: &mut Source<'_>,
    determined: &Determined<'_>,
    (factor, command): (f64, f64),
    table: &Table,
) -> Option<AircraftParameter> {
    let std = determined.std("battery_sag", "exponent")?;
    let exponent = source.value("battery_sag", "exponent")?;
    let full_v = source.value("battery_sag", "full_voltage")?;
    let said = format!("thrust goes with the voltage to the power {}", with_error(exponent, std));
    if table.is_px4() {
        source.note(format!(
            "battery_sag: {said}; PX4 holds no such law: MC_BAT_SCALE_EN scales by its own estimate of the charge, and is not set here"
        ));
        return None;
    }
    // (1 - f) r u + f (r u)^2 with the voltage's ratio r goes about the command of hover with the power that it has in u
    let power = 1.0 + factor * command / ((1.0 - factor) + factor * command);
    if (exponent - power).abs() > 2.0 * std {
        source.note(format!(
            "battery_sag: {said}; ArduPilot's compensation would take the power {power:.2} at hover: MOT_BAT_VOLT_MAX is left out"
        ));
        return None;
    }
    let _ = source.take("battery_sag", "exponent");
    source.note("MOT_BAT_VOLT_MIN does not follow from the model: set it by the cells, at least 0.6 of MOT_BAT_VOLT_MAX");
    let why = format!("{said}, as ArduPilot compensates it; full thrust of the model is at this voltage");
    Some(AircraftParameter { unit: "V", ..AircraftParameter::switch("MOT_BAT_VOLT_MAX", full_v, false, why) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hover_in_thin_air_is_told_for_sea_level() {
        let (ratio, told) = air(Some(584.0), true);
        assert!((ratio - 0.945).abs() < 5e-4 && told.contains("1.158 kg/m^3 (584 m"), "{ratio} {told}");
        assert!(air(None, true).1.contains("--altitude"));
        assert_eq!(air(Some(584.0), false).0, 1.0);
        // the heights that are told without one
        assert!(
            (air_density_ratio(540.0) - 0.95).abs() < 2e-3 && (air_density_ratio(1100.0) - 0.9).abs() < 2e-3
        );
    }

    #[test]
    fn the_factor_of_a_curve_is_found_from_its_slope() {
        for (factor, command) in [(0.0, 0.4), (0.3, 0.55), (0.65, 0.3), (1.0, 0.5)] {
            let slope = (1.0 - factor) + 2.0 * factor * command;
            let at = AtHover { command, elasticity: slope * command / share(factor, command) };
            assert!((at.factor() - factor).abs() < 1e-12, "{factor} {}", at.factor());
        }
    }
}
