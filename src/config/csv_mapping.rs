//! Which column of a CSV flight means what, as the user writes it.

use std::path::Path;

use serde::Deserialize;

use super::ConfigError;
use super::check::Check;
use super::kind::Kind;
use super::read::{parse_toml, read_text};
use crate::log::csv::{AttitudeForm, AxisFrame, CsvMapping, CsvQuantity, CsvTime, CsvUnit, column_count};
use crate::recording::Quantity;
use crate::text;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct MappingFile {
    delimiter: Option<String>,
    time: TimeTable,
    #[serde(default, rename = "quantity")]
    quantities: Vec<QuantityTable>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct TimeTable {
    column: String,
    unit: Option<String>,
    #[serde(default = "one")]
    scale: f64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct QuantityTable {
    name: String,
    columns: Vec<String>,
    form: Option<String>,
    frame: Option<String>,
    unit: Option<String>,
    #[serde(default = "one")]
    scale: f64,
    #[serde(default)]
    missing: Vec<f64>,
    #[serde(default)]
    optional: bool,
    #[serde(default)]
    instance: u8,
}

fn one() -> f64 {
    1.0
}

/// Names of units and what they mean; the first is taken where none is given.
type Units = &'static [(&'static str, CsvUnit)];

/// Names of frames and what they mean; the first is taken where none is given.
type Frames = &'static [(&'static str, AxisFrame)];

const TIME: Units = &[("s", CsvUnit::Si), ("ms", CsvUnit::Milliseconds), ("us", CsvUnit::Microseconds)];
const RATIO: Units = &[("1", CsvUnit::Si)];
const ACTUATOR: Units = &[("1", CsvUnit::Si), ("us", CsvUnit::Si)];
const METRE: Units = &[("m", CsvUnit::Si)];
const METRE_PER_SECOND: Units = &[("m/s", CsvUnit::Si)];
const ACCELERATION: Units =
    &[("m/s^2", CsvUnit::Si), ("g", CsvUnit::StandardGravity), ("mg", CsvUnit::MilliGravity)];
const ANGLE: Units = &[("rad", CsvUnit::Si), ("deg", CsvUnit::Degrees)];
const RATE: Units =
    &[("rad/s", CsvUnit::Si), ("deg/s", CsvUnit::Degrees), ("mrad/s", CsvUnit::MilliradiansPerSecond)];
const ROTOR_SPEED: Units = &[("rad/s", CsvUnit::Si), ("rpm", CsvUnit::RevolutionsPerMinute)];
const VOLT: Units = &[("V", CsvUnit::Si), ("mV", CsvUnit::Millivolts), ("cV", CsvUnit::Centivolts)];
const AMPERE: Units = &[("A", CsvUnit::Si), ("cA", CsvUnit::Centiamperes)];

const BODY: Frames = &[("flu", AxisFrame::FluNwu), ("frd", AxisFrame::FrdNed)];
const WORLD: Frames = &[("nwu", AxisFrame::FluNwu), ("ned", AxisFrame::FrdNed), ("enu", AxisFrame::FluEnu)];
const BOTH: Frames =
    &[("flu-nwu", AxisFrame::FluNwu), ("frd-ned", AxisFrame::FrdNed), ("flu-enu", AxisFrame::FluEnu)];
const NO_FRAME: Frames = &[];

/// Each quantity that a table may hold, with its units and frames.
const QUANTITIES: &[(Quantity, Units, Frames)] = &[
    (Quantity::Attitude, RATIO, BOTH),
    (Quantity::RollYaw, ANGLE, BOTH),
    (Quantity::AngularRate, RATE, BODY),
    (Quantity::SpecificForce, ACCELERATION, BODY),
    (Quantity::WorldAcceleration, ACCELERATION, WORLD),
    (Quantity::Position, METRE, WORLD),
    (Quantity::Velocity, METRE_PER_SECOND, WORLD),
    (Quantity::ActuatorCommand, ACTUATOR, NO_FRAME),
    (Quantity::ActuatorDemand, ACTUATOR, NO_FRAME),
    (Quantity::RotorSpeed, ROTOR_SPEED, NO_FRAME),
    (Quantity::BatteryVoltage, VOLT, NO_FRAME),
    (Quantity::BatteryCurrent, AMPERE, NO_FRAME),
    (Quantity::PositionSetpoint, METRE, WORLD),
    (Quantity::VelocitySetpoint, METRE_PER_SECOND, WORLD),
    (Quantity::AccelerationSetpoint, ACCELERATION, WORLD),
    (Quantity::YawSetpoint, ANGLE, WORLD),
    (Quantity::AttitudeSetpoint, RATIO, BOTH),
    (Quantity::ThrustSetpoint, RATIO, NO_FRAME),
    (Quantity::LandedState, RATIO, NO_FRAME),
    (Quantity::Armed, RATIO, NO_FRAME),
    (Quantity::Mode, RATIO, NO_FRAME),
];

/// The mapping of a file.
///
/// # Errors
/// [`ConfigError`] where the file cannot be read, has an unknown or missing key, or says what cannot be.
pub fn load_csv_mapping(path: &Path) -> Result<CsvMapping, ConfigError> {
    parse_csv_mapping(&read_text(path, Kind::CsvMapping)?, &text::path(path))
}

/// As [`load_csv_mapping`], from text; `origin` is named in errors.
///
/// # Errors
/// As [`load_csv_mapping`].
pub fn parse_csv_mapping(text: &str, origin: &str) -> Result<CsvMapping, ConfigError> {
    let file: MappingFile = parse_toml(text, origin, Kind::CsvMapping)?;
    let check = Check { origin };
    let mut quantities: Vec<CsvQuantity> = Vec::with_capacity(file.quantities.len());
    for (index, table) in file.quantities.into_iter().enumerate() {
        let mapped = quantity(&check, &format!("quantity[{index}]"), table)?;
        let key = (mapped.quantity, mapped.instance);
        if quantities.iter().any(|other| (other.quantity, other.instance) == key) {
            let expected = "another `instance` for the same quantity";
            return Err(check.refuse(&format!("quantity[{index}].instance"), expected, key.1));
        }
        quantities.push(mapped);
    }
    if quantities.is_empty() {
        return Err(check.refuse("quantity", "at least one [[quantity]] table", "none"));
    }
    Ok(CsvMapping {
        delimiter: file.delimiter.map(|name| delimiter(&check, &name)).transpose()?,
        time: CsvTime {
            unit: choose(&check, "time.unit", file.time.unit.as_deref(), TIME)?,
            scale: check.positive("time.scale", file.time.scale)?,
            column: text::clean(&file.time.column),
        },
        quantities,
    })
}

fn delimiter(check: &Check<'_>, name: &str) -> Result<u8, ConfigError> {
    let known = &[("comma", b','), ("semicolon", b';'), ("tab", b'\t'), ("pipe", b'|')];
    choose(check, "delimiter", Some(name), known)
}

fn quantity(check: &Check<'_>, key: &str, table: QuantityTable) -> Result<CsvQuantity, ConfigError> {
    let Some((quantity, units, frames)) =
        QUANTITIES.iter().find(|(quantity, ..)| quantity.name() == table.name)
    else {
        let names: Vec<&str> = QUANTITIES.iter().map(|(quantity, ..)| quantity.name()).collect();
        let expected = format!("one of {}", names.join(", "));
        return Err(check.refuse(&format!("{key}.name"), expected, format!("\"{}\"", table.name)));
    };
    let form = form(check, &format!("{key}.form"), *quantity, table.form.as_deref())?;
    let units = if form == AttitudeForm::Euler { ANGLE } else { units };
    column_names(check, &format!("{key}.columns"), column_count(*quantity, form), &table)?;
    let frame_key = format!("{key}.frame");
    let frame = match (frames.is_empty(), table.frame.as_deref()) {
        (true, None) => AxisFrame::FluNwu,
        (true, Some(name)) => {
            return Err(check.refuse(&frame_key, format!("no such key for {}", table.name), name));
        }
        (false, name) => choose(check, &frame_key, name, frames)?,
    };
    Ok(CsvQuantity {
        quantity: *quantity,
        instance: table.instance,
        form,
        frame,
        unit: choose(check, &format!("{key}.unit"), table.unit.as_deref(), units)?,
        scale: check.finite(&format!("{key}.scale"), table.scale)?,
        // as the columns of a header are read
        columns: table.columns.iter().map(|column| text::clean(column)).collect(),
        missing: table.missing,
        optional: table.optional,
    })
}

fn form(
    check: &Check<'_>,
    key: &str,
    quantity: Quantity,
    name: Option<&str>,
) -> Result<AttitudeForm, ConfigError> {
    match (quantity, name) {
        (Quantity::Attitude | Quantity::AttitudeSetpoint, _) | (_, None) => {
            let known = &[("quaternion", AttitudeForm::Quaternion), ("euler", AttitudeForm::Euler)];
            choose(check, key, name, known)
        }
        (_, Some(name)) => Err(check.refuse(key, "no such key but for attitudes", name)),
    }
}

/// As many columns as the quantity has values; a numbered pattern stands alone.
fn column_names(
    check: &Check<'_>,
    key: &str,
    count: Option<usize>,
    table: &QuantityTable,
) -> Result<(), ConfigError> {
    let columns = &table.columns;
    let numbered = columns.iter().any(|column| column.contains("{n}"));
    if numbered && (count.is_some() || columns.len() != 1) {
        let expected = "{n} in a single name, and only for a quantity with one value a channel";
        return Err(check.refuse(key, expected, columns.join(", ")));
    }
    match count {
        Some(count) if columns.len() != count => {
            Err(check.refuse(key, format!("{count} name(s) for {}", table.name), columns.len()))
        }
        None if columns.is_empty() => Err(check.refuse(key, "at least one name", 0)),
        _ => Ok(()),
    }
}

/// The value of a name; the first of `known` where there is no name.
fn choose<T: Copy>(
    check: &Check<'_>,
    key: &str,
    name: Option<&str>,
    known: &[(&str, T)],
) -> Result<T, ConfigError> {
    let found = match name {
        None => known.first(),
        Some(name) => known.iter().find(|(known, _)| *known == name),
    };
    found.map(|(_, value)| *value).ok_or_else(|| {
        let names: Vec<String> = known.iter().map(|(name, _)| format!("\"{name}\"")).collect();
        let came = name.map_or_else(|| "nothing".to_owned(), |name| format!("\"{name}\""));
        check.refuse(key, format!("one of {}", names.join(", ")), came)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_default_mapping_is_that_of_the_file_for_users() {
        let file = include_str!("../../configs/csv/default.toml");
        assert_eq!(parse_csv_mapping(file, "default.toml").unwrap(), CsvMapping::default());
    }
}
