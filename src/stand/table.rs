//! The table of a thrust stand, in SI.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use super::StandError;
use super::column::{Column, Heading, StandQuantity, heading};
use crate::text;

/// Bytes of a table: an hour at 100 rows a second.
const BYTES_MAX: u64 = 1 << 26;
/// Lines among which the header is: some stands write about the test before it.
const HEADER_LINES: usize = 40;

/// What a thrust stand measured of one rotor, row by row.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct StandTable {
    /// commands, microseconds or 0..1 by [`Self::is_pulse`]; NaN where a cell is empty, as in the others
    pub command: Vec<f64>,
    /// the commands are pulses
    pub is_pulse: bool,
    /// rad/s
    pub speed_rad_s: Vec<f64>,
    /// N
    pub thrust_n: Vec<f64>,
    /// N m
    pub torque_nm: Vec<f64>,
    /// V
    pub voltage_v: Vec<f64>,
    /// columns that are not there, in words
    pub missing: Vec<&'static str>,
    /// rows without a number
    pub rows_left_out: usize,
}

/// Reads the table of a file.
///
/// # Errors
/// [`StandError`] where it cannot be read, or its header does not say what is needed.
pub fn read_table(path: &Path) -> Result<StandTable, StandError> {
    let failed = |source| StandError::Read { path: path.to_owned(), source };
    let mut bytes = Vec::new();
    File::open(path).and_then(|file| file.take(BYTES_MAX + 1).read_to_end(&mut bytes)).map_err(failed)?;
    if bytes.len() as u64 > BYTES_MAX {
        return Err(StandError::TooLarge { path: path.to_owned(), max: BYTES_MAX });
    }
    // some stands write Latin-1
    let text = String::from_utf8(bytes)
        .unwrap_or_else(|error| error.as_bytes().iter().map(|byte| char::from(*byte)).collect());
    parse_table(&text)
}

/// As [`read_table`], from text.
///
/// # Errors
/// As [`read_table`].
pub fn parse_table(text: &str) -> Result<StandTable, StandError> {
    let delimiter = delimiter(text);
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .delimiter(delimiter)
        .comment(Some(b'#'))
        .from_reader(text.as_bytes());
    let mut rows = reader.records().map_while(Result::ok);
    let mut best: Option<Vec<Heading>> = None;
    let mut seen = String::new();
    for row in rows.by_ref().take(HEADER_LINES) {
        let headings: Vec<Heading> = row.iter().map(heading).collect();
        if seen.is_empty() {
            seen = row.iter().collect::<Vec<_>>().join(", ");
        }
        let of = |wanted: StandQuantity| {
            headings.iter().any(|heading| match heading {
                Heading::Of(column) => column.of == wanted,
                Heading::UnknownUnit(of) => *of == wanted,
                Heading::Other => false,
            })
        };
        if of(StandQuantity::Thrust) && headings.iter().filter(|one| **one != Heading::Other).count() > 1 {
            seen = row.iter().collect::<Vec<_>>().join(", ");
            best = Some(headings);
            break;
        }
    }
    let came = || format!("\"{}\"", text::excerpt(&seen, 200));
    let Some(headings) = best else {
        return Err(StandError::Columns {
            expected: "a header with a column of thrust and one of the command or the rotor speed, each with its unit, such \
                       as Thrust (N), ESC signal (us), Throttle (%), Motor Optical Speed (RPM)"
                .to_owned(),
            came: came(),
        });
    };
    let unknown = headings.iter().find_map(|heading| match heading {
        Heading::UnknownUnit(of) => Some(of.name()),
        _ => None,
    });
    let table = Chosen::of(&headings)?;
    let is_instead =
        |name: &str| name == StandQuantity::Throttle.name() && table.has(StandQuantity::Pulse.name());
    if let Some(name) = unknown.filter(|name| !table.has(name) && !is_instead(name)) {
        let expected =
            format!("a unit of the column of {name}, such as N, kgf, gf, N m, us, %, RPM, rad/s, V");
        return Err(StandError::Columns { expected, came: came() });
    }
    table.read(rows)
}

/// The delimiter that the text has most often.
fn delimiter(text: &str) -> u8 {
    let head: Vec<&str> = text.lines().take(HEADER_LINES).collect();
    let count = |of: char| head.iter().map(|line| line.matches(of).count()).sum::<usize>();
    [(b',', ','), (b';', ';'), (b'\t', '\t')]
        .into_iter()
        .max_by_key(|(_, of)| count(*of))
        .map_or(b',', |(byte, _)| byte)
}

/// Index and factor of the column of each quantity.
#[derive(Debug)]
struct Chosen {
    columns: Vec<(usize, Column)>,
}

impl Chosen {
    fn of(headings: &[Heading]) -> Result<Self, StandError> {
        let mut columns: Vec<(usize, Column)> = Vec::new();
        for (index, heading) in headings.iter().enumerate() {
            let Heading::Of(column) = *heading else { continue };
            match columns.iter_mut().find(|(_, known)| known.of == column.of) {
                None => columns.push((index, column)),
                Some(known) if known.1.rank < column.rank => *known = (index, column),
                Some(known) if known.1.rank > column.rank => {}
                Some(_) => {
                    return Err(StandError::Columns {
                        expected: format!("one column of {}: the table of one rotor", column.of.name()),
                        came: "several".to_owned(),
                    });
                }
            }
        }
        Ok(Self { columns })
    }

    fn find(&self, of: StandQuantity) -> Option<(usize, f64)> {
        let (index, column) = self.columns.iter().find(|(_, column)| column.of == of)?;
        Some((*index, column.factor))
    }

    fn has(&self, name: &str) -> bool {
        self.columns.iter().any(|(_, column)| column.of.name() == name)
    }

    fn read(&self, rows: impl Iterator<Item = csv::StringRecord>) -> Result<StandTable, StandError> {
        let pulse = self.find(StandQuantity::Pulse);
        let command = pulse.or_else(|| self.find(StandQuantity::Throttle));
        let [speed, thrust, torque, voltage] =
            [StandQuantity::RotorSpeed, StandQuantity::Thrust, StandQuantity::Torque, StandQuantity::Voltage]
                .map(|of| self.find(of));
        let mut table = StandTable { is_pulse: pulse.is_some(), ..StandTable::default() };
        for row in rows {
            let cell = |at: Option<(usize, f64)>| {
                let number =
                    at.and_then(|(index, factor)| Some(row.get(index)?.trim().parse::<f64>().ok()? * factor));
                number.filter(|number| number.is_finite()).unwrap_or(f64::NAN)
            };
            let values = [command, speed, thrust, torque, voltage].map(cell);
            if values.iter().all(|value| value.is_nan()) {
                table.rows_left_out += 1;
                continue;
            }
            let [command, speed, thrust, torque, voltage] = values;
            table.command.push(command);
            table.speed_rad_s.push(speed);
            table.thrust_n.push(thrust);
            table.torque_nm.push(torque);
            table.voltage_v.push(voltage);
        }
        let lacks = [
            (command.is_none(), "no command: the thrust curve and the largest thrust stay as they were"),
            (speed.is_none(), "no rotor speed: no thrust coefficient"),
            (torque.is_none(), "no torque: the torque per thrust stays a guess"),
            (voltage.is_none(), "no voltage: its effect on thrust is not known"),
        ];
        table.missing = lacks.into_iter().filter_map(|(lacks, words)| lacks.then_some(words)).collect();
        if command.is_none() && speed.is_none() {
            return Err(StandError::Columns {
                expected: "a column of the command or of the rotor speed beside that of thrust".to_owned(),
                came: "neither".to_owned(),
            });
        }
        upright(&mut table.thrust_n);
        upright(&mut table.torque_nm);
        Ok(table)
    }
}

/// A stand that pushes the other way measures the same with the other sign.
fn upright(values: &mut [f64]) {
    let sum: f64 = values.iter().filter(|value| value.is_finite()).sum();
    if sum < 0.0 {
        values.iter_mut().for_each(|value| *value = -*value);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_is_read_by_its_header_whatever_stands_before() {
        let text = "# made by hand\nTest of a motor\n\nTime (s),ESC signal (us),Thrust (kgf),Torque (N m),Voltage (V),\
                    Motor Electrical Speed (RPM),Motor Optical Speed (RPM)\n\
                    0.1,1500,-0.5,0.05,15.9,9000,6000\n0.2,1510,,,,,\nend,,,,,,\n";
        let table = parse_table(text).unwrap();
        assert!(table.is_pulse && table.command == [1500.0, 1510.0]);
        // what pushes the other way is the same thrust
        assert!((table.thrust_n[0] - 4.903_325).abs() < 1e-9 && table.thrust_n[1].is_nan());
        assert!((table.speed_rad_s[0] - 200.0 * std::f64::consts::PI).abs() < 1e-9);
        assert_eq!((table.rows_left_out, table.missing.len()), (1, 0));
    }

    #[test]
    fn what_lacks_is_said() {
        let said = |text: &str| parse_table(text).unwrap_err().to_string();
        assert!(said("a,b\n1,2\n").contains("expected a header with a column of thrust"));
        assert!(said("Thrust,RPM\n1,2\n").contains("a unit of the column of thrust"));
        assert!(said("Thrust (N),Torque (N m)\n1,2\n").contains("the command or of the rotor speed"));
        assert!(said("Thrust A (N),Thrust B (N),RPM\n1,2,3\n").contains("one column of thrust"));
        assert!(said("").contains("got \"\""));
        let table = parse_table("Throttle (%);Thrust (g)\n50;700\n").unwrap();
        assert_eq!((table.command[0], table.missing.len()), (0.5, 3));
    }
}
