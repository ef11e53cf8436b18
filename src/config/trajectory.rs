//! `trajectory.toml`: the coefficients of (18), what they were planned for, and what they are worth.

use super::ConfigError;
use super::check::Check;
use super::kind::Kind;
use super::read::{parse_toml, read_text};
use super::vehicle::limits_alone;
use super::vehicle_file::LimitsTable;
use super::vehicle_writer::limits_table;
use crate::text;
use crate::trajectory::{FourierAxis, FourierTrajectory, check_size};
use crate::vehicle::Limits;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::Path;

/// Characters of the criterion's name.
const NAME_CHARS: usize = 64;
/// The longest transition that is read, s; the planner's own last at most 60 s.
const TRANSITION_MAX_S: f64 = 600.0;

/// A series with what is known of it.
#[derive(Debug, Clone, PartialEq)]
pub struct StoredTrajectory {
    /// x, y, z (m) and psi (rad)
    pub series: FourierTrajectory,
    /// how many periods are flown
    pub repeats: u32,
    /// the limits it was planned for
    pub limits: Limits,
    /// name and value of the criterion
    pub criterion: Option<(String, f64)>,
    /// what is left to each bound over 2 ms samples, named with its unit
    pub margins: BTreeMap<String, f64>,
    /// expected relative standard errors by parameter
    pub standard_errors: BTreeMap<String, f64>,
    /// what is flown before and after
    pub transitions: Option<StoredTransitions>,
}

/// What is flown before and after a series; the polynomials follow from places and durations.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StoredTransitions {
    /// x, y, z (m) and psi (rad) where the vehicle hovers after takeoff
    pub takeoff: [f64; 4],
    /// where it hovers before it lands
    pub landing: [f64; 4],
    /// s from takeoff to the series' start
    pub to_start_s: f64,
    /// s from the series' end to the landing place
    pub to_landing_s: f64,
}

#[derive(Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
struct TransitionsTable {
    /// m, m, m, rad
    takeoff_x_y_z_yaw: [f64; 4],
    /// m, m, m, rad
    landing_x_y_z_yaw: [f64; 4],
    to_start_s: f64,
    to_landing_s: f64,
}

impl TransitionsTable {
    fn checked(self, check: &Check<'_>) -> Result<StoredTransitions, ConfigError> {
        for (key, place) in
            [("takeoff_x_y_z_yaw", self.takeoff_x_y_z_yaw), ("landing_x_y_z_yaw", self.landing_x_y_z_yaw)]
        {
            place
                .iter()
                .try_for_each(|value| check.finite(&format!("transitions.{key}"), *value).map(|_| ()))?;
        }
        Ok(StoredTransitions {
            takeoff: self.takeoff_x_y_z_yaw,
            landing: self.landing_x_y_z_yaw,
            to_start_s: check.duration("transitions.to_start_s", self.to_start_s, TRANSITION_MAX_S)?,
            to_landing_s: check.duration("transitions.to_landing_s", self.to_landing_s, TRANSITION_MAX_S)?,
        })
    }
}

impl From<StoredTransitions> for TransitionsTable {
    fn from(stored: StoredTransitions) -> Self {
        Self {
            takeoff_x_y_z_yaw: stored.takeoff,
            landing_x_y_z_yaw: stored.landing,
            to_start_s: stored.to_start_s,
            to_landing_s: stored.to_landing_s,
        }
    }
}

#[derive(Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
struct TrajectoryFile {
    /// s
    period_s: f64,
    /// N
    harmonics: usize,
    #[serde(default = "default_repeats")]
    repeats: u32,
    x_m: AxisTable,
    y_m: AxisTable,
    z_m: AxisTable,
    yaw_rad: AxisTable,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    criterion: Option<CriterionTable>,
    #[serde(default)]
    limits: LimitsTable,
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    margins_on_2_ms_samples: BTreeMap<String, f64>,
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    relative_standard_errors: BTreeMap<String, f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    transitions: Option<TransitionsTable>,
}

/// The diagnosis compares periods with each other: four, and one to settle.
fn default_repeats() -> u32 {
    5
}

#[derive(Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
struct AxisTable {
    /// per second
    a: Vec<f64>,
    /// per second
    b: Vec<f64>,
    c: f64,
}

#[derive(Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
struct CriterionTable {
    name: String,
    value: f64,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct LimitsFile {
    limits: LimitsTable,
}

/// Reads and checks `trajectory.toml`.
///
/// # Errors
/// If the file cannot be read, is not TOML, has unknown keys, or the coefficients do not fit together.
pub fn read_trajectory(path: &Path) -> Result<StoredTrajectory, ConfigError> {
    parse_trajectory(&read_text(path, Kind::Trajectory)?, &text::path(path))
}

/// As [`read_trajectory`], from text; `origin` names it in errors.
///
/// # Errors
/// If the text is not TOML, has unknown keys, or the coefficients do not fit together.
pub fn parse_trajectory(text: &str, origin: &str) -> Result<StoredTrajectory, ConfigError> {
    let file: TrajectoryFile = parse_toml(text, origin, Kind::Trajectory)?;
    let check = Check { origin };
    let count = file.harmonics;
    let axis = |name: &str, table: AxisTable| -> Result<FourierAxis, ConfigError> {
        for (key, values) in [("a", &table.a), ("b", &table.b)] {
            let key = format!("{name}.{key}");
            if values.len() != count {
                let expected = format!("{count} numbers, one a harmonic");
                return Err(check.refuse(&key, expected, values.len()));
            }
            values.iter().try_for_each(|value| check.finite(&key, *value).map(|_| ()))?;
        }
        let c = check.finite(&format!("{name}.c"), table.c)?;
        Ok(FourierAxis { a: table.a, b: table.b, c })
    };
    check_size(file.period_s, count, file.repeats)
        .map_err(|error| check.refuse(error.what, error.expected, error.got))?;
    Ok(StoredTrajectory {
        series: FourierTrajectory {
            period_s: file.period_s,
            axes: [
                axis("x_m", file.x_m)?,
                axis("y_m", file.y_m)?,
                axis("z_m", file.z_m)?,
                axis("yaw_rad", file.yaw_rad)?,
            ],
        },
        repeats: file.repeats,
        limits: limits_alone(&check, &file.limits)?,
        criterion: file.criterion.map(|table| (text::excerpt(&table.name, NAME_CHARS), table.value)),
        margins: file.margins_on_2_ms_samples,
        standard_errors: file.relative_standard_errors,
        transitions: file.transitions.map(|table| table.checked(&check)).transpose()?,
    })
}

/// The text of `trajectory.toml`; reading it gives the same numbers.
///
/// # Errors
/// If a number cannot be written as TOML.
pub fn trajectory_to_toml(stored: &StoredTrajectory) -> Result<String, ConfigError> {
    let axis = |axis: &FourierAxis| AxisTable { a: axis.a.clone(), b: axis.b.clone(), c: axis.c };
    let [x, y, z, yaw] = &stored.series.axes;
    let file = TrajectoryFile {
        period_s: stored.series.period_s,
        harmonics: x.a.len(),
        repeats: stored.repeats,
        x_m: axis(x),
        y_m: axis(y),
        z_m: axis(z),
        yaw_rad: axis(yaw),
        criterion: stored.criterion.clone().map(|(name, value)| CriterionTable { name, value }),
        limits: limits_table(&stored.limits),
        margins_on_2_ms_samples: stored.margins.clone(),
        relative_standard_errors: stored.standard_errors.clone(),
        transitions: stored.transitions.map(TransitionsTable::from),
    };
    Ok(format!("{HEADER}{}", toml::to_string(&file)?))
}

const HEADER: &str = "# q(t) = sum over l of a_l/(w l) sin(w l t) - b_l/(w l) cos(w l t), plus c; w = 2 pi / period_s.\n\
    # x, y, z in metres (north, west, up), yaw in radians; a and b per second.\n\
    # [transitions]: polynomials of seventh degree from a hover to the start and from the end to a hover.\n";

/// Limits from a file that holds a `[limits]` table as a vehicle's does.
///
/// # Errors
/// If the file cannot be read, is not TOML, has unknown keys, or a limit is out of range.
pub fn read_limits(path: &Path) -> Result<Limits, ConfigError> {
    parse_limits(&read_text(path, Kind::Limits)?, &text::path(path))
}

/// As [`read_limits`], from text; `origin` names it in errors.
///
/// # Errors
/// If the text is not TOML, has unknown keys, or a limit is out of range.
pub fn parse_limits(text: &str, origin: &str) -> Result<Limits, ConfigError> {
    let file: LimitsFile = parse_toml(text, origin, Kind::Limits)?;
    limits_alone(&Check { origin }, &file.limits)
}

#[cfg(test)]
mod tests {
    use super::*;

    const TABLE_2: &str = include_str!("../../configs/trajectories/table2.toml");
    const TRANSITIONS: &str = "[transitions]\ntakeoff_x_y_z_yaw = [0, 0, 1, 0]\nlanding_x_y_z_yaw = [0, 0, 1, 0]\n\
        to_start_s = 1e9\nto_landing_s = 1\n";

    #[test]
    fn what_is_written_is_read_back() {
        let mut stored = parse_trajectory(TABLE_2, "table2.toml").unwrap();
        stored.criterion = Some(("cond".to_owned(), 16.25));
        stored.series.axes[1].b[3] = 0.1 + 0.2;
        stored.limits.roll_max_rad = Some(0.1);
        stored.margins.insert("roll_rad".to_owned(), 1e-7);
        let place = [0.0, 0.0, 1.0, 0.0];
        stored.transitions =
            Some(StoredTransitions { takeoff: place, landing: place, to_start_s: 2.0, to_landing_s: 3.0 });
        let again = parse_trajectory(&trajectory_to_toml(&stored).unwrap(), "again").unwrap();
        assert_eq!(again.series, stored.series);
        assert_eq!(again.criterion, stored.criterion);
        assert_eq!(again.margins, stored.margins);
        assert_eq!(again.transitions, stored.transitions);
        assert!((again.limits.roll_max_rad.unwrap() - 0.1).abs() < 1e-15);
    }

    #[test]
    fn mistakes_are_named() {
        let cases = [
            (TABLE_2.replace("harmonics = 5", "harmonics = 4"), "x_m.a"),
            (TABLE_2.replace("period_s = 10.0", "period_s = -1.0"), "period_s"),
            (TABLE_2.replace("repeats = 5", "repeat = 5"), "repeat"),
            (TABLE_2.replace("repeats = 5", "repeats = 0"), "repeats"),
            (TABLE_2.replace("repeats = 5", "repeats = 4000000000"), "at most 3600 s of flight"),
            (TABLE_2.replace("period_s = 10.0", "period_s = 1e12"), "`period_s`: expected 0.1 to 1000 s"),
            (
                format!("{TABLE_2}{TRANSITIONS}"),
                "`transitions.to_start_s`: expected above 0 and at most 600 s",
            ),
        ];
        for (text, key) in cases {
            let message = parse_trajectory(&text, "t.toml").unwrap_err().to_string();
            assert!(message.contains(key) && message.contains("t.toml"), "{message}");
        }
    }

    #[test]
    fn limits_files_refuse_unknown_keys() {
        assert_eq!(parse_limits("[limits]\nspeed_max_m_s = 2.0\n", "l").unwrap().speed_max_m_s, Some(2.0));
        assert!(parse_limits("[limits]\nspeed = 2.0\n", "l").unwrap_err().to_string().contains("speed"));
    }
}
