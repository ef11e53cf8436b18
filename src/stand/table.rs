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
    /// the file's thrust is negative, and is taken with the other sign
    pub is_turned: bool,
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
    refuse_other_kinds(&bytes)?;
    // some stands write Latin-1
    let text = String::from_utf8(bytes)
        .unwrap_or_else(|error| error.as_bytes().iter().map(|byte| char::from(*byte)).collect());
    parse_table(&text)
}

/// Files of spreadsheets and archives are no text.
fn refuse_other_kinds(bytes: &[u8]) -> Result<(), StandError> {
    let came = match bytes {
        [b'P', b'K', 3 | 5, 4 | 6, ..] => {
            "a zip archive, as files of spreadsheets (.xlsx, .ods) are; unpack it, or save the sheet as .csv"
        }
        [0xd0, 0xcf, 0x11, 0xe0, ..] => "a file of a spreadsheet (.xls); save the sheet as .csv",
        [0x1f, 0x8b, ..] => "a gzip archive; unpack it",
        bytes if bytes.contains(&0) => "a file that is no text",
        _ => return Ok(()),
    };
    Err(StandError::Columns {
        expected: "a table of a thrust stand as text (.csv)".to_owned(),
        came: came.to_owned(),
    })
}

/// As [`read_table`], from text.
///
/// # Errors
/// As [`read_table`].
pub fn parse_table(text: &str) -> Result<StandTable, StandError> {
    // numbers may have decimal commas: a comma is the last that is tried
    let found = DELIMITERS.iter().find_map(|delimiter| {
        let mut rows = rows_of(text, *delimiter);
        Some((header(&mut rows)?, rows, *delimiter))
    });
    let Some((header, rows, delimiter)) = found else {
        let first = text.lines().map(str::trim).find(|line| !line.is_empty() && !line.starts_with('#'));
        return Err(StandError::Columns {
            expected: "a header with a column of thrust and one of the command or the rotor speed, each with its unit, such \
                       as Thrust (N), ESC signal (us), Throttle (%), Motor Optical Speed (RPM)"
                .to_owned(),
            came: format!("\"{}\"", text::excerpt(first.unwrap_or_default(), 200)),
        });
    };
    let headings: Vec<Heading> = header.iter().map(heading).collect();
    let table = Chosen::of(&headings, &header)?;
    let is_instead =
        |name: &str| name == StandQuantity::Throttle.name() && table.has(StandQuantity::Pulse.name());
    for (heading, cell) in headings.iter().zip(header.iter()) {
        let Heading::UnknownUnit(of) = heading else { continue };
        if table.has(of.name()) || is_instead(of.name()) {
            continue;
        }
        return Err(StandError::Columns {
            expected: format!("a unit of the column of {}, such as {}", of.name(), of.units_words()),
            came: format!("the heading {}", quoted(cell)),
        });
    }
    table.read(rows, (&header, delimiter))
}

/// What may stand between two cells, in the order in which it is tried.
const DELIMITERS: [u8; 3] = [b';', b'\t', b','];

fn rows_of(text: &str, delimiter: u8) -> impl Iterator<Item = csv::StringRecord> + '_ {
    let reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .delimiter(delimiter)
        .comment(Some(b'#'))
        .from_reader(text.as_bytes());
    reader.into_records().map_while(Result::ok)
}

/// The row that names a thrust and something else.
fn header(rows: &mut impl Iterator<Item = csv::StringRecord>) -> Option<csv::StringRecord> {
    rows.take(HEADER_LINES).find(|row| {
        let headings: Vec<Heading> = row.iter().map(heading).collect();
        let is_thrust = |heading: &Heading| match heading {
            Heading::Of(column) => column.of == StandQuantity::Thrust,
            Heading::UnknownUnit(of) => *of == StandQuantity::Thrust,
            Heading::Other => false,
        };
        headings.iter().any(is_thrust) && headings.iter().filter(|one| **one != Heading::Other).count() > 1
    })
}

fn quoted(cell: &str) -> String {
    format!("\"{}\"", text::excerpt(cell.trim(), 80))
}

/// A number, where there is one; a comma is a decimal one where it stands between no cells.
fn number(cell: &str, delimiter: u8) -> Option<f64> {
    let cell = cell.trim();
    let read = |cell: &str| cell.parse::<f64>().ok().filter(|number| number.is_finite());
    read(cell).or_else(|| if delimiter == b',' { None } else { read(&cell.replacen(',', ".", 1)) })
}

/// Index and factor of the column of each quantity.
#[derive(Debug)]
struct Chosen {
    columns: Vec<(usize, Column)>,
}

impl Chosen {
    fn of(headings: &[Heading], header: &csv::StringRecord) -> Result<Self, StandError> {
        let mut columns: Vec<(usize, Column)> = Vec::new();
        for (index, heading) in headings.iter().enumerate() {
            let Heading::Of(column) = *heading else { continue };
            match columns.iter_mut().find(|(_, known)| known.of == column.of) {
                None => columns.push((index, column)),
                Some(known) if known.1.rank < column.rank => *known = (index, column),
                Some(known) if known.1.rank > column.rank => {}
                Some(known) => {
                    let [one, other] = [known.0, index].map(|at| quoted(header.get(at).unwrap_or_default()));
                    return Err(StandError::Columns {
                        expected: format!("one column of {}: the table of one rotor", column.of.name()),
                        came: format!("several, {one} and {other}"),
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

    fn read(
        &self,
        rows: impl Iterator<Item = csv::StringRecord>,
        (header, delimiter): (&csv::StringRecord, u8),
    ) -> Result<StandTable, StandError> {
        let pulse = self.find(StandQuantity::Pulse);
        let command = pulse.or_else(|| self.find(StandQuantity::Throttle));
        let [speed, thrust, torque, voltage] =
            [StandQuantity::RotorSpeed, StandQuantity::Thrust, StandQuantity::Torque, StandQuantity::Voltage]
                .map(|of| self.find(of));
        let mut table = StandTable { is_pulse: pulse.is_some(), ..StandTable::default() };
        let mut odd: Option<String> = None;
        for row in rows {
            let cell = |at: Option<(usize, f64)>| {
                let number =
                    at.and_then(|(index, factor)| Some(number(row.get(index)?, delimiter)? * factor));
                number.unwrap_or(f64::NAN)
            };
            let of_thrust = thrust.and_then(|(index, _)| row.get(index)).map(str::trim);
            let is_odd = |cell: &&str| !cell.is_empty() && number(cell, delimiter).is_none();
            if odd.is_none() {
                odd = of_thrust.filter(is_odd).map(quoted);
            }
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
        if table.thrust_n.iter().all(|thrust| thrust.is_nan()) {
            let name = thrust.and_then(|(index, _)| header.get(index)).unwrap_or_default();
            return Err(StandError::Rows {
                expected: format!("numbers in the column {}, such as 4.9", quoted(name)),
                came: odd.unwrap_or_else(|| "none".to_owned()),
            });
        }
        table.is_turned = upright(&mut table.thrust_n);
        upright(&mut table.torque_nm);
        Ok(table)
    }
}

/// A stand that pushes the other way measures the same with the other sign. Whether it did.
fn upright(values: &mut [f64]) -> bool {
    let sum: f64 = values.iter().filter(|value| value.is_finite()).sum();
    let is_turned = sum < 0.0;
    if is_turned {
        values.iter_mut().for_each(|value| *value = -*value);
    }
    is_turned
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
        assert!(table.is_turned);
    }

    #[test]
    fn what_lacks_is_said() {
        let said = |text: &str| parse_table(text).unwrap_err().to_string();
        assert!(said("a,b\n1,2\n").contains("expected a header with a column of thrust"));
        assert!(said("Thrust,RPM\n1,2\n").contains("a unit of the column of thrust"));
        assert!(
            said("command,Thrust (N)\n0.5,2\n").contains("such as us, %, 0..1, got the heading \"command\"")
        );
        assert!(said("Thrust (N),Torque (N m)\n1,2\n").contains("the command or of the rotor speed"));
        assert!(said("Thrust A (N),Thrust B (N),RPM\n1,2,3\n").contains("one column of thrust"));
        assert!(said("").contains("got \"\""));
        assert!(
            said("Thrust A (N),Thrust B (N),RPM\n1,2,3\n").contains("\"Thrust A (N)\" and \"Thrust B (N)\"")
        );
        assert!(said("Schub, Thrust ,RPM\n1,2,3\n").contains("got the heading \"Thrust\""));
        assert!(said("Thrust (N),RPM\n1.234.5,2\n").contains("in the column \"Thrust (N)\""));
        let table = parse_table("Throttle (%);Thrust (g)\n50;700\n").unwrap();
        assert_eq!((table.command[0], table.missing.len()), (0.5, 3));
    }

    #[test]
    fn a_decimal_comma_is_one_where_other_signs_stand_between_the_cells() {
        let table = parse_table("Throttle (%);Thrust (N);RPM\n50,0;7,25;6000,5\n60,0;8,5;7000,5\n").unwrap();
        assert_eq!((table.thrust_n[0], table.command[0]), (7.25, 0.5));
    }

    #[test]
    fn an_archive_is_called_one() {
        let why = refuse_other_kinds(b"PK\x03\x04rest").unwrap_err().to_string();
        assert!(why.contains("a zip archive"), "{why}");
        assert!(refuse_other_kinds(b"Thrust (N),RPM\n").is_ok());
    }
}
