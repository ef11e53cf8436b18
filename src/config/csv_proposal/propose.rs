//! The proposal as the text of a mapping file, which is read back before it is given.

use std::fmt::Write;
use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use super::choose::{Axes, Chosen, begins_with_w, unit};
use super::group::{Group, groups};
use super::words::{Kind, Part};
use crate::config::{ConfigError, parse_csv_mapping};
use crate::log::csv::{CsvMapping, TableHead, read_head};
use crate::recording::Quantity;
use crate::text;

/// A mapping of columns that is proposed for a table.
#[derive(Debug, Clone, PartialEq)]
pub struct CsvProposal {
    /// the text of a mapping file
    pub toml: String,
    /// what it means
    pub mapping: CsvMapping,
    /// what is not sure about it, a sentence each
    pub unsure: Vec<String>,
    /// columns that the mapping does not use
    pub unused: Vec<String>,
}

/// Proposes a mapping for a table of unknown columns: by their names, and by the numbers of its first rows where the names say
/// neither unit nor axes.
///
/// # Errors
/// [`ConfigError::Table`] where the table cannot be read; [`ConfigError::Invalid`] where no column is a time, or nothing else is
/// recognised.
pub fn propose_csv_mapping(path: &Path) -> Result<CsvProposal, ConfigError> {
    let origin = text::path(&path);
    let file = File::open(path).map_err(|source| ConfigError::Read { path: path.to_owned(), source })?;
    let head = read_head(BufReader::new(file), &origin)?;
    propose(&head, &origin)
}

fn propose(head: &TableHead, origin: &str) -> Result<CsvProposal, ConfigError> {
    let (all, unused) = groups(&head.columns);
    let mut unused: Vec<usize> = unused;
    let mut chosen: Vec<(Quantity, &Group)> = Vec::new();
    let (mut time, mut unsure) = (None, Vec::new());
    for group in &all {
        let Some(quantity) = quantity(group) else {
            match (group.kind, time) {
                (Kind::Time, None) => time = Some(group),
                _ => unused.extend(&group.columns),
            }
            continue;
        };
        let columns = named(head, group).join(", ");
        if let Some((_, first)) = chosen.iter().find(|(known, _)| *known == quantity) {
            let used = named(head, first).join(", ");
            unsure.push(format!("{}: {used} are used; {columns} may be meant", quantity.name()));
            unused.extend(&group.columns);
        } else {
            chosen.push((quantity, group));
        }
    }
    // an attitude is whole as a quaternion
    if let (Some(_), Some(euler)) = (by(&chosen, Kind::Attitude), by(&chosen, Kind::Euler)) {
        if !unused.contains(&euler.columns[0]) {
            unused.extend(&euler.columns);
        }
        chosen.retain(|(_, group)| group.kind != Kind::Euler || group.is_setpoint);
    }
    let missing = |key: &str, expected: &str| ConfigError::Invalid {
        origin: origin.to_owned(),
        key: key.to_owned(),
        expected: expected.to_owned(),
        came: text::listed(head.columns.iter()),
    };
    let time = time.ok_or_else(|| missing("header", "a column of times (time, timestamp, t)"))?;
    if chosen.is_empty() {
        return Err(missing("header", "columns of a flight (position, gyro, acc, motor, ...)"));
    }
    let axes = Axes::of(head, &all);
    let mut toml = begin(head, time, &mut unsure);
    for (quantity, group) in &chosen {
        table(&mut toml, (head, &axes), (*quantity, group), &mut unsure);
    }
    unused.sort_unstable();
    let unused: Vec<String> = unused.into_iter().map(|index| head.columns[index].clone()).collect();
    let mapping = parse_csv_mapping(&toml, "the proposed mapping")?;
    Ok(CsvProposal { toml, mapping, unsure, unused })
}

fn by<'a>(chosen: &[(Quantity, &'a Group)], kind: Kind) -> Option<&'a Group> {
    chosen.iter().map(|(_, group)| *group).find(|group| group.kind == kind && !group.is_setpoint)
}

/// What a group is to a mapping; `None` of times, and of orders for which there is no place.
fn quantity(group: &Group) -> Option<Quantity> {
    Some(match (group.kind, group.is_setpoint) {
        (Kind::Position, false) => Quantity::Position,
        (Kind::Position, true) => Quantity::PositionSetpoint,
        (Kind::Velocity, false) => Quantity::Velocity,
        (Kind::Velocity, true) => Quantity::VelocitySetpoint,
        (Kind::Attitude, false) => Quantity::Attitude,
        (Kind::Attitude, true) => Quantity::AttitudeSetpoint,
        (Kind::Euler, false) if group.columns.len() == 2 => Quantity::RollYaw,
        (Kind::Euler, false) => Quantity::Attitude,
        (Kind::Euler, true) if group.columns.len() == 1 => Quantity::YawSetpoint,
        (Kind::Euler, true) => Quantity::AttitudeSetpoint,
        (Kind::Rate, false) => Quantity::AngularRate,
        (Kind::Acceleration, false) => Quantity::SpecificForce,
        (Kind::Acceleration, true) => Quantity::AccelerationSetpoint,
        (Kind::WorldAcceleration, false) => Quantity::WorldAcceleration,
        (Kind::Demand, _) => Quantity::ActuatorDemand,
        (Kind::Command, _) => Quantity::ActuatorCommand,
        (Kind::RotorSpeed, _) => Quantity::RotorSpeed,
        (Kind::Voltage, false) => Quantity::BatteryVoltage,
        (Kind::Current, false) => Quantity::BatteryCurrent,
        (Kind::Armed, false) => Quantity::Armed,
        (Kind::LandedState, false) => Quantity::LandedState,
        _ => return None,
    })
}

fn named(head: &TableHead, group: &Group) -> Vec<String> {
    group.columns.iter().map(|index| head.columns[*index].clone()).collect()
}

/// Delimiter and time.
fn begin(head: &TableHead, time: &Group, unsure: &mut Vec<String>) -> String {
    let delimiter = match head.delimiter {
        b';' => "semicolon",
        b'\t' => "tab",
        b'|' => "pipe",
        _ => "comma",
    };
    let chosen = unit(head, time);
    let mut toml = format!("delimiter = \"{delimiter}\"\n\n");
    remarks(&mut toml, "time", &chosen.unsure, unsure);
    let column = text::toml_string(&head.columns[time.columns[0]]);
    // writing to a String cannot fail
    let _ = writeln!(toml, "[time]\ncolumn = {column}\nunit = \"{}\"", chosen.unit.unwrap_or("s"));
    scale(&mut toml, &chosen);
    toml
}

/// One quantity.
fn table(
    toml: &mut String,
    (head, axes): (&TableHead, &Axes),
    (quantity, group): (Quantity, &Group),
    unsure: &mut Vec<String>,
) {
    let mut chosen = unit(head, group);
    let (frame, assumed) = axes.frame(group);
    chosen.frame = frame;
    chosen.unsure.extend(assumed);
    let mut columns = named(head, group);
    if group.kind == Kind::Attitude && matches!(group.parts[0], Part::Number(_)) {
        match begins_with_w(head, group) {
            Some(true) => {}
            Some(false) => {
                columns.rotate_right(1);
                chosen.unsure.push("the order: w is taken to be the last by the numbers".to_owned());
            }
            None => chosen.unsure.push("the order: w is taken to be the first".to_owned()),
        }
    }
    toml.push('\n');
    remarks(toml, quantity.name(), &chosen.unsure, unsure);
    let columns: Vec<String> = columns.iter().map(|column| text::toml_string(column)).collect();
    let _ =
        writeln!(toml, "[[quantity]]\nname = \"{}\"\ncolumns = [{}]", quantity.name(), columns.join(", "));
    if group.kind == Kind::Euler && matches!(quantity, Quantity::Attitude | Quantity::AttitudeSetpoint) {
        toml.push_str("form = \"euler\"\n");
    }
    for (key, value) in [("frame", chosen.frame), ("unit", chosen.unit)] {
        value.into_iter().for_each(|value| {
            let _ = writeln!(toml, "{key} = \"{value}\"");
        });
    }
    scale(toml, &chosen);
}

fn scale(toml: &mut String, chosen: &Chosen) {
    if let Some(scale) = chosen.scale {
        let _ = writeln!(toml, "scale = {scale:?}");
    }
}

/// What is not sure, above the table and in the list.
fn remarks(toml: &mut String, name: &str, found: &[String], unsure: &mut Vec<String>) {
    for remark in found {
        let _ = writeln!(toml, "# not sure of {remark}");
        unsure.push(format!("{name}: {remark}"));
    }
}
