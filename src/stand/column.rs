//! What a column of a thrust stand's table holds, by its name and unit.

use crate::units::{STANDARD_GRAVITY_M_S2, rad_s_from_rpm};

/// What a column holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum StandQuantity {
    /// command of the speed controller, microseconds
    Pulse,
    /// the same as a share of full command, 0..1
    Throttle,
    /// rad/s
    RotorSpeed,
    /// N
    Thrust,
    /// N m
    Torque,
    /// V
    Voltage,
}

impl StandQuantity {
    /// In messages.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Pulse => "command in microseconds",
            Self::Throttle => "throttle",
            Self::RotorSpeed => "rotor speed",
            Self::Thrust => "thrust",
            Self::Torque => "torque",
            Self::Voltage => "voltage",
        }
    }

    /// Units that its column may have, in messages.
    pub(super) fn units_words(self) -> &'static str {
        match self {
            Self::Pulse => "us, ms",
            Self::Throttle => "us, %, 0..1",
            Self::RotorSpeed => "RPM, rad/s, Hz",
            Self::Thrust => "N, kgf, gf, lbf, ozf",
            Self::Torque => "N m, mN m, kgf cm, ozf in",
            Self::Voltage => "V, mV",
        }
    }
}

/// Names of units, and what of them is one in SI (a pulse: microseconds; a throttle: 1).
type Units = &'static [(&'static str, f64)];

const POUND_N: f64 = 4.448_221_615_260_5;
const INCH_M: f64 = 0.0254;
const TURN_RAD: f64 = std::f64::consts::TAU;

const PULSES: Units = &[("us", 1.0), ("ms", 1000.0)];
const SHARES: Units = &[("%", 0.01), ("1", 1.0), ("0..1", 1.0)];
const SPEEDS: Units = &[("rad/s", 1.0), ("hz", TURN_RAD), ("rev/s", TURN_RAD)];
const FORCES: Units = &[
    ("n", 1.0),
    ("mn", 0.001),
    ("kgf", STANDARD_GRAVITY_M_S2),
    ("kg", STANDARD_GRAVITY_M_S2),
    ("gf", STANDARD_GRAVITY_M_S2 * 1e-3),
    ("g", STANDARD_GRAVITY_M_S2 * 1e-3),
    ("lbf", POUND_N),
    ("lb", POUND_N),
    ("ozf", POUND_N / 16.0),
    ("oz", POUND_N / 16.0),
];
const TORQUES: Units = &[
    ("nm", 1.0),
    ("mnm", 0.001),
    ("ncm", 0.01),
    ("kgfm", STANDARD_GRAVITY_M_S2),
    ("kgfcm", STANDARD_GRAVITY_M_S2 * 0.01),
    ("gfcm", STANDARD_GRAVITY_M_S2 * 1e-5),
    ("lbfft", POUND_N * INCH_M * 12.0),
    ("lbfin", POUND_N * INCH_M),
    ("ozfin", POUND_N / 16.0 * INCH_M),
    ("ozin", POUND_N / 16.0 * INCH_M),
];
const VOLTS: Units = &[("v", 1.0), ("mv", 0.001)];

/// A column that is used.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Column {
    pub of: StandQuantity,
    /// what turns its numbers into those of the quantity
    pub factor: f64,
    /// of several columns of one quantity the largest is used
    pub rank: u8,
}

/// Judges a column by its heading.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Heading {
    Of(Column),
    /// one of a quantity whose unit is missing or not known
    UnknownUnit(StandQuantity),
    /// nothing that is used
    Other,
}

/// What a heading such as `Thrust (kgf)`, `Torque - N*m` or `voltage_V` says.
pub(super) fn heading(text: &str) -> Heading {
    let (name, unit) = parts(text);
    let has = |words: &[&str]| words.iter().any(|word| name.contains(word));
    // what is derived of the others names them too
    if has(&["effic", "power", "coeff", "norm", "temperature", "max", "min", "limit"]) {
        return Heading::Other;
    }
    let by = |of, units: Units, rank| match factor(&unit, units) {
        Some(factor) => Heading::Of(Column { of, factor, rank }),
        None => Heading::UnknownUnit(of),
    };
    let is_rpm = unit.contains("rpm") || unit == "r/min" || unit == "rev/min" || name.contains("rpm");
    if has(&["thrust"]) {
        by(StandQuantity::Thrust, FORCES, 0)
    } else if has(&["torque"]) {
        by(StandQuantity::Torque, TORQUES, 0)
    } else if has(&["rpm", "speed", "rotation"]) && !has(&["wind", "air"]) {
        // a probe of light counts turns; one of voltage counts noise too where the motor hardly turns
        let rank = if has(&["optical"]) { 2 } else { u8::from(!has(&["electrical"])) };
        if is_rpm {
            Heading::Of(Column { of: StandQuantity::RotorSpeed, factor: rad_s_from_rpm(1.0), rank })
        } else {
            by(StandQuantity::RotorSpeed, SPEEDS, rank)
        }
    } else if has(&["throttle", "esc", "command", "pwm", "pulse"]) {
        match (factor(&unit, PULSES), factor(&unit, SHARES)) {
            (Some(factor), _) => Heading::Of(Column { of: StandQuantity::Pulse, factor, rank: 1 }),
            (None, Some(factor)) => Heading::Of(Column { of: StandQuantity::Throttle, factor, rank: 0 }),
            (None, None) if has(&["current", "voltage"]) => Heading::Other,
            (None, None) => Heading::UnknownUnit(StandQuantity::Throttle),
        }
    } else if has(&["volt"]) || name == "vol" {
        by(StandQuantity::Voltage, VOLTS, 0)
    } else {
        Heading::Other
    }
}

/// Name and unit, in small letters.
fn parts(text: &str) -> (String, String) {
    let text = text.trim().trim_start_matches('\u{feff}').to_lowercase();
    let bracketed = ["(", "[", "{"].iter().find_map(|open| text.split_once(open));
    let apart = bracketed.or_else(|| text.split_once(" - ")).or_else(|| text.rsplit_once('_'));
    match apart {
        Some((name, unit)) => (name.trim().to_owned(), unit_name(unit)),
        None => (text, String::new()),
    }
}

/// Without brackets, signs of multiplication and blanks, `µ` as `u`.
fn unit_name(unit: &str) -> String {
    let kept = |letter: &char| !" )]}*·.⋅×-".contains(*letter) && !letter.is_control();
    let is_range = unit.contains("..");
    let letter = |letter: char| if "µμ".contains(letter) { 'u' } else { letter };
    if is_range { "0..1".to_owned() } else { unit.chars().filter(kept).map(letter).collect() }
}

fn factor(unit: &str, units: Units) -> Option<f64> {
    units.iter().find(|(name, _)| *name == unit).map(|(_, factor)| *factor)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(text: &str) -> Option<(StandQuantity, f64)> {
        match heading(text) {
            Heading::Of(column) => Some((column.of, column.factor)),
            _ => None,
        }
    }

    #[test]
    fn headings_of_usual_stands_are_known() {
        let rpm = std::f64::consts::TAU / 60.0;
        for (text, quantity, factor) in [
            ("ESC signal (µs)", StandQuantity::Pulse, 1.0),
            ("Thrust (kgf)", StandQuantity::Thrust, STANDARD_GRAVITY_M_S2),
            ("Thrust - gf", StandQuantity::Thrust, STANDARD_GRAVITY_M_S2 * 1e-3),
            ("Torque (N·m)", StandQuantity::Torque, 1.0),
            ("Torque - N*m", StandQuantity::Torque, 1.0),
            ("Torque (ozf·in)", StandQuantity::Torque, 0.007_061_551_8),
            ("Motor Optical Speed (RPM)", StandQuantity::RotorSpeed, rpm),
            ("Motor Electrical Speed (rad/s)", StandQuantity::RotorSpeed, 1.0),
            ("RPM", StandQuantity::RotorSpeed, rpm),
            ("Throttle (%)", StandQuantity::Throttle, 0.01),
            ("Voltage [V]", StandQuantity::Voltage, 1.0),
            ("voltage_V", StandQuantity::Voltage, 1.0),
            ("thrust_N", StandQuantity::Thrust, 1.0),
        ] {
            let (found, by) = of(text).unwrap_or_else(|| panic!("{text}"));
            assert_eq!(found, quantity, "{text}");
            assert!((by / factor - 1.0).abs() < 1e-6, "{text}: {by}");
        }
    }

    #[test]
    fn what_is_derived_or_without_a_unit_is_not_taken() {
        for text in
            ["Overall Efficiency (gf/W)", "Time (s)", "Mechanical Power (W)", "Current (A)", "App message"]
        {
            assert_eq!(heading(text), Heading::Other, "{text}");
        }
        assert_eq!(heading("Thrust"), Heading::UnknownUnit(StandQuantity::Thrust));
        assert_eq!(heading("Torque (stone)"), Heading::UnknownUnit(StandQuantity::Torque));
    }
}
