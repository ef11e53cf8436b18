//! Hover throttle, thrust curve and battery compensation.
//!
//! Both autopilots take the share of thrust `(1 - f) u + f u^2` for a command u of the motors, and invert it: f is
//! THR_MDL_FAC or MOT_THST_EXPO. MPC_THR_HOVER and MOT_THST_HOVER are shares of thrust behind that curve.

use super::determined::Determined;
use super::parameter::{AircraftParameter, within};
use super::table::{Table, ThrustNames};
use crate::export::source::Source;
use crate::text::{significant, with_error};
use crate::units::{AIR_DENSITY_KG_M3, air_density_ratio};
use crate::vehicle::{Guessed, ThrustLaw, Vehicle};

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
    determined.unusable().into_iter().for_each(|why| source.note(why));
    let flown = determined.hover_command();
    let by_model = propulsion.command_from_thrust(more * source.airframe.hover_thrust_n);
    // what was flown needs no curve
    let command = flown.map_or(by_model, |(command, _)| command);
    let stated = match propulsion.law {
        ThrustLaw::Speed { .. } => 1.0,
        ThrustLaw::Curve { expo, .. } => expo,
    };
    let law = AtHover { command, elasticity: 1.0 + stated * command / ((1.0 - stated) + stated * command) };
    let mut parameters = Vec::new();
    let curve = curve(source, determined, law, names);
    let factor = curve.as_ref().map_or(stated, |curve| curve.value);
    let factor_std = curve.as_ref().and_then(|curve| curve.std).unwrap_or(0.0);
    let flown_std = flown.map(|(_, std)| std);
    let behind = Behind { factor, factor_std, is_written: curve.is_some(), command, flown_std };
    parameters.extend(curve);
    parameters.extend(hover(source, determined, &behind, names));
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
    let value_std = 0.5 * (at(curvature + std) - at(curvature - std)).abs();
    let (least, most) = names.curve_bounds;
    let Some((held, limited)) = within((value, value_std), (least, most)) else {
        source.refuse("thrust_curve");
        source.note(format!(
            "{} is left out: the curve that was identified would need {value:.3}, and the autopilot documents {least} to {most}",
            names.curve
        ));
        return None;
    };
    let why = format!(
        "{limited}thrust curve about hover, bent by {} against that of the vehicle file",
        with_error(curvature, std)
    );
    Some(AircraftParameter::number(names.curve, (held, value_std), "-", why))
}

/// Largest relative standard error of a hover throttle that is written. Autopilots learn it in flight, and find it by themselves from a
/// value that is 5 % off.
const MOST_HOVER_STD: f64 = 0.05;

/// The curve behind which the hover throttle is a share of thrust.
struct Behind {
    factor: f64,
    factor_std: f64,
    /// it was identified, and the file sets it
    is_written: bool,
    /// of the motors at hover
    command: f64,
    /// its standard error, where it was flown and is not from the model
    flown_std: Option<f64>,
}

impl Behind {
    /// Standard error of the share of thrust at hover, -. A command that was flown is behind the curve that the autopilot has, so that
    /// the curve's own error is none of it.
    fn command_std(&self, determined: &Determined<'_>) -> Option<f64> {
        let Self { factor, factor_std, command, .. } = *self;
        if let Some(std) = self.flown_std {
            return Some((1.0 - factor + 2.0 * factor * command) * std);
        }
        let by_load = share(factor, command) * determined.load_relative_std()?;
        Some(by_load.hypot(factor_std * command * (1.0 - command)))
    }

    /// What is said of it, `name` being the autopilot's parameter.
    fn words(&self, name: &str) -> String {
        let factor = self.factor;
        if self.is_written {
            format!("with {name} = {factor:.3}")
        } else {
            format!("for a vehicle that has {name} = {factor:.3}, which this file does not set")
        }
    }
}

fn hover(
    source: &mut Source<'_>,
    determined: &Determined<'_>,
    behind: &Behind,
    names: &ThrustNames,
) -> Option<AircraftParameter> {
    let Some(command_std) = behind.command_std(determined) else {
        source.note(format!(
            "{} does not follow from this model: neither mass nor thrust was identified with a standard error",
            names.hover
        ));
        return None;
    };
    let command = behind.command;
    let (air_ratio, air) = air(source.altitude_m, names.by_density);
    let value = air_ratio * share(behind.factor, command);
    let std = air_ratio * command_std;
    let (least, most) = names.hover_bounds;
    let Some((held, limited)) = within((value, std), (least, most)) else {
        source.note(format!(
            "{} is left out: it would be {value:.3}, and the autopilot documents {least} to {most}",
            names.hover
        ));
        return None;
    };
    if std > MOST_HOVER_STD * value {
        let why = too_rough((value, std), &cause(source.vehicle, determined, behind));
        source.note(format!("{} {why}", names.hover));
        return None;
    }
    let what = match behind.flown_std {
        Some(_) => "the motors' command at hover, as flown",
        None => "weight over full thrust of all rotors",
    };
    let why =
        format!("{limited}{what}, {}, {}; {air}", held_at(source, determined), behind.words(names.curve));
    Some(AircraftParameter::number(names.hover, (held, std), "-", why))
}

/// At which voltage and mass a hover throttle holds.
fn held_at(source: &Source<'_>, determined: &Determined<'_>) -> String {
    let mass = significant(source.vehicle.body.mass_kg, 4);
    // full thrust of a model of the battery is that at its full voltage
    let voltage_v = source.value("battery_sag", "full_voltage").or_else(|| determined.battery_voltage_v());
    voltage_v.map_or_else(
        || format!("at {mass} kg and the battery voltage of the flight (the model file does not hold the voltage)"),
        |volts| format!("at {volts:.1} V and {mass} kg"),
    )
}

/// Why a hover throttle with this standard error is not written.
fn too_rough((value, std): (f64, f64), cause: &str) -> String {
    format!(
        "is not written: it would be {}, an error of {:.0} %, and the autopilot's own value may be nearer than with more than {:.0} %. {cause}",
        with_error(value, std),
        100.0 * std / value,
        100.0 * MOST_HOVER_STD
    )
}

/// On what most of a hover throttle's error rests, and what makes it smaller.
fn cause(vehicle: &Vehicle, determined: &Determined<'_>, behind: &Behind) -> String {
    // how far the thrust at hover moves, at one full thrust, with one standard error of the curve
    let by_guess = vehicle.guessed(Guessed::Expo) * behind.command * (1.0 - behind.command)
        / share(behind.factor, behind.command);
    let load_std = determined.load_relative_std().unwrap_or(0.0);
    if !behind.is_written && by_guess > 0.5 * load_std {
        format!(
            "Most of it is the thrust curve's, which is a guess of +- {:.0} %: measure it on a thrust stand and draft the vehicle file \
             with --thrust-stand",
            100.0 * vehicle.guessed(Guessed::Expo)
        )
    } else if determined.own("mass").is_some() {
        "Weigh the vehicle and state its mass with anchor = \"mass\", or fly longer".to_owned()
    } else {
        "Fly longer".to_owned()
    }
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
    fn a_rough_hover_throttle_says_its_error() {
        let told = too_rough((0.5, 0.07), "Fly longer");
        assert!(told.starts_with("is not written: it would be 0.50 +- 0.07, an error of 14 %"), "{told}");
        assert!(told.ends_with("with more than 5 %. Fly longer"), "{told}");
    }

    #[test]
    fn a_curve_that_is_assumed_is_what_the_vehicle_must_have() {
        let of =
            |is_written| Behind { factor: 0.65, factor_std: 0.0, is_written, command: 0.4, flown_std: None };
        assert_eq!(of(true).words("MOT_THST_EXPO"), "with MOT_THST_EXPO = 0.650");
        let assumed = of(false).words("MOT_THST_EXPO");
        assert_eq!(assumed, "for a vehicle that has MOT_THST_EXPO = 0.650, which this file does not set");
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
