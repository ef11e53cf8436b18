//! Files of parameters, as autopilots' ground stations save them.

use std::fs::File;
use std::io::{self, Read as _};
use std::path::Path;

use crate::text;

/// A larger file is no list of parameters.
const MOST_BYTES: u64 = 4 << 20;
/// MAVLink's names are no longer.
const NAME_CHARS: usize = 16;

/// Why a file gives no parameters.
#[derive(Debug, thiserror::Error)]
pub enum ParameterFileError {
    /// the file system says no
    #[error("{path}: {source}")]
    File {
        /// which file
        path: String,
        /// what it says
        source: io::Error,
    },
    /// a line, or the whole file, says something else
    #[error("{path}: expected {expected}, got {got}")]
    Form {
        /// which file, with its line
        path: String,
        /// what is read
        expected: &'static str,
        /// what came
        got: String,
    },
}

/// Names and values of a file: `NAME,VALUE`, `NAME VALUE` or `NAME=VALUE` (ArduPilot), system, component, name, value and type
/// (PX4), or `param set NAME VALUE`. Comments begin with `#` or `//`. Values have the precision of the messages.
///
/// # Errors
/// [`ParameterFileError`] where the file cannot be read, a line has none of these forms, or a name has two values.
pub fn read_parameter_file(path: &Path) -> Result<Vec<(String, f64)>, ParameterFileError> {
    let shown = text::path(path);
    let failed = |source| ParameterFileError::File { path: shown.clone(), source };
    let form =
        |got: String| ParameterFileError::Form { path: shown.clone(), expected: "a file of parameters", got };
    if path.is_dir() {
        return Err(form("a folder".to_owned()));
    }
    let mut bytes = Vec::new();
    File::open(path).and_then(|file| file.take(MOST_BYTES + 1).read_to_end(&mut bytes)).map_err(failed)?;
    if bytes.len() as u64 > MOST_BYTES {
        return Err(form(format!("more than {MOST_BYTES} bytes")));
    }
    let written = String::from_utf8(bytes).map_err(|_| form("bytes that are no text".to_owned()))?;
    parse(&shown, &written)
}

fn parse(path: &str, written: &str) -> Result<Vec<(String, f64)>, ParameterFileError> {
    let mut found: Vec<(String, f64)> = Vec::new();
    for (index, line) in written.lines().enumerate() {
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') || line.starts_with("//") {
            continue;
        }
        let refuse = |expected, got: &str| ParameterFileError::Form {
            path: format!("{path}, line {}", index + 1),
            expected,
            got: text::excerpt(got, 24),
        };
        // a file that begins with something else is none: what it says of itself helps nobody
        let first = found.is_empty();
        let (name, value) = match pair(line) {
            Some((name, value)) if !first || is_name(name) => (name, value),
            None if !first => return Err(refuse("a name and a value", line)),
            _ => return Err(no_parameter_file(path, index + 1)),
        };
        if !is_name(name) {
            return Err(refuse("a name of at most 16 letters, digits and underscores", name));
        }
        let value: f32 = value.parse().map_err(|_| refuse("a number as the value", value))?;
        if !value.is_finite() {
            return Err(refuse("a finite value", line));
        }
        let value = f64::from(value);
        match found.iter().find(|(known, _)| known == name) {
            Some((_, before)) if *before != value => {
                return Err(refuse("one value of each parameter", &format!("{name} = {before} and {value}")));
            }
            Some(_) => {}
            None => found.push((name.to_owned(), value)),
        }
    }
    if found.is_empty() {
        let path = path.to_owned();
        return Err(ParameterFileError::Form {
            path,
            expected: "at least one line with a name and a value",
            got: "none".to_owned(),
        });
    }
    Ok(found)
}

fn is_name(name: &str) -> bool {
    let is_letter = |letter: char| letter.is_ascii_alphanumeric() || letter == '_';
    !name.is_empty() && name.len() <= NAME_CHARS && name.chars().all(is_letter)
}

fn no_parameter_file(path: &str, line: usize) -> ParameterFileError {
    let got = format!("another kind of file: its line {line} is not of this form");
    ParameterFileError::Form {
        path: path.to_owned(),
        expected: "a parameter file, with lines such as MPC_THR_HOVER,0.5",
        got,
    }
}

/// Name and value of a line.
fn pair(line: &str) -> Option<(&str, &str)> {
    let line = line.split_once(" #").map_or(line, |(before, _)| before);
    let words: Vec<&str> = line
        .split(|letter: char| letter.is_whitespace() || letter == ',' || letter == '=')
        .filter(|word| !word.is_empty())
        .collect();
    match words.as_slice() {
        [name, value] | ["param", "set" | "set-default", name, value] | [_, _, name, value, _] => {
            Some((name, value))
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test ends where it fails")]
    use super::*;

    #[test]
    fn each_form_is_read() {
        let text = "# comment\n\nMOT_THST_EXPO,0.65\nMOT_THST_HOVER 0.31 # learnt\nEK3_X=2\n1\t1\tEKF2_MCOEF\t0.25\t9\n\
                    param set SIH_MASS 1.5e0\nMOT_THST_EXPO,0.65\n// end\n";
        let found = parse("f", text).unwrap();
        let names: Vec<&str> = found.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, ["MOT_THST_EXPO", "MOT_THST_HOVER", "EK3_X", "EKF2_MCOEF", "SIH_MASS"]);
        assert_eq!(found[3].1, 0.25);
        // to the precision of the messages
        assert_eq!(found[1].1, f64::from(0.31_f32));
    }

    #[test]
    fn what_is_wrong_is_said_with_its_line() {
        let said = |text: &str| parse("f", text).unwrap_err().to_string();
        assert_eq!(said("A,1\nB"), "f, line 2: expected a name and a value, got B");
        assert_eq!(said("A,x"), "f, line 1: expected a number as the value, got x");
        assert_eq!(said("A,nan"), "f, line 1: expected a finite value, got A,nan");
        assert_eq!(said("A,1\nA,2"), "f, line 2: expected one value of each parameter, got A = 1 and 2");
        assert!(said("A,1\nA_NAME_THAT_IS_LONG,1").contains("at most 16"));
        let prose = said("# mavid\n\nmavid is a ground station for PX4 and ArduPilot multirotors.\n");
        assert!(prose.ends_with("got another kind of file: its line 3 is not of this form"), "{prose}");
        assert!(said("[vehicle] 1\n").contains("another kind of file"));
        assert!(said("# nothing\n").contains("at least one line"));
        let folder = read_parameter_file(&std::env::temp_dir()).unwrap_err().to_string();
        assert!(folder.ends_with("expected a file of parameters, got a folder"), "{folder}");
    }
}
