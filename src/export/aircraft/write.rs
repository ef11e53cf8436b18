//! The parameters of a model, and their file.

use super::determined::Determined;
use super::drag::drag;
use super::geometry::geometry;
use super::parameter::{AircraftParameter, AircraftParameters};
use super::table;
use super::thrust::thrust;
use crate::autopilot::Autopilot;
use crate::export::error::ExportError;
use crate::export::notes::line_comments;
use crate::export::source::Source;
use crate::physics::ActiveEffect;
use crate::text::{compact, line_comment, significant, with_error};
use crate::vehicle::Vehicle;
use std::fmt::Write;
use toml::Table;

/// MAV_PARAM_TYPE of a single-precision number and of a whole one.
const REAL: u8 = 9;
const WHOLE: u8 = 6;

/// The parameters of the aircraft's autopilot that follow from a model; `identified` is the table of that name in its file.
/// What has no standard error there has no parameter. `altitude_m`: height of the flight's place above the sea, m; without it,
/// what an autopilot takes for the air at sea level is that of the flight.
///
/// # Errors
/// [`ExportError`] where the vehicle is not physical, the parameters of the autopilot are not known, or where nothing follows from the model.
pub fn aircraft_parameters(
    vehicle: &Vehicle,
    effects: &[ActiveEffect],
    identified: Option<&Table>,
    (autopilot, altitude_m): (Autopilot, Option<f64>),
) -> Result<AircraftParameters, ExportError> {
    let table = table::Table::of(autopilot).ok_or_else(|| ExportError::Unfit {
        format: "a parameter file",
        expected: "PX4 or ArduPilot",
        got: "another autopilot".to_owned(),
    })?;
    let determined = Determined::of(identified);
    let mut source = Source::new(vehicle, effects, identified)?;
    source.altitude_m = altitude_m;
    if let Some((other, named)) = table.other_of(vehicle) {
        source.note(format!(
            "the model is of a vehicle with {other} (its guesses name {named}), and these parameters are for {}: another autopilot",
            table.name
        ));
    }
    let mut parameters = thrust(&mut source, &determined, table);
    parameters.extend(drag(&mut source, &determined, table));
    parameters.extend(geometry(&mut source, &determined, table));
    if parameters.is_empty() {
        return Err(ExportError::Unfit {
            format: table.format,
            expected: "a model that `mavid identify` or `mavid explain` wrote, with standard errors",
            got: format!(
                "no identified value that the autopilot has a parameter for: {}",
                source.notes().join("; ")
            ),
        });
    }
    source.note(table.never);
    let exported = source.finish(|notes| file(&vehicle.name, &parameters, notes, table));
    Ok(AircraftParameters { parameters, left_out: exported.left_out, text: exported.text })
}

fn file(name: &str, parameters: &[AircraftParameter], notes: &[String], table: &table::Table) -> String {
    let autopilot = table.name;
    let mut text =
        line_comment("#", &format!("{name}: parameters of the aircraft's {autopilot}, not of a simulator"));
    text.push_str(&line_comment(
        "#",
        "to set them: mavid vehicle load --connect ADDRESS FILE; any ground station loads them too",
    ));
    for parameter in parameters {
        let AircraftParameter { name, value, std, unit, is_integer, why } = parameter;
        let said = std.map_or_else(|| compact(*value), |std| with_error(*value, std));
        let unit = if *unit == "-" { String::new() } else { format!(" {unit}") };
        text.push_str(&line_comment("#", &format!("{name} {said}{unit}: {why}")));
        let value = if *is_integer { format!("{value:.0}") } else { significant(*value, 6) };
        // as ground stations save them: system, component, name, value and type for PX4, name and value for ArduPilot
        let _ = if table.is_px4() {
            let kind = if *is_integer { WHOLE } else { REAL };
            writeln!(text, "1\t1\t{name}\t{value}\t{kind}")
        } else {
            writeln!(text, "{name},{value}")
        };
    }
    text.push_str(&line_comments("#", notes));
    text
}
