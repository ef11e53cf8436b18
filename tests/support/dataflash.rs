//! Logs of ArduPilot, made by hand.

#![allow(clippy::panic, reason = "a test ends where it fails")]

use mavid::log::Letter;

/// A value of a message.
#[derive(Debug, Clone, Copy)]
pub enum Value<'a> {
    Number(f64),
    Text(&'a str),
    Array([i16; 32]),
}

impl From<f64> for Value<'_> {
    fn from(number: f64) -> Self {
        Self::Number(number)
    }
}

impl<'a> From<&'a str> for Value<'a> {
    fn from(text: &'a str) -> Self {
        Self::Text(text)
    }
}

/// A log in both forms.
#[derive(Debug, Default, Clone)]
pub struct DataflashLog {
    pub binary: Vec<u8>,
    pub text: String,
    defined: Vec<(u8, String, String)>,
}

impl DataflashLog {
    /// With the definition of FMT itself.
    pub fn new() -> Self {
        let mut log = Self::default();
        log.defined.push((128, "FMT".to_owned(), "BBnNZ".to_owned()));
        log.define(128, "FMT", "BBnNZ", "Type,Length,Name,Format,Columns");
        log
    }

    pub fn define(&mut self, number: u8, name: &str, format: &str, columns: &str) {
        let bytes: usize = format.bytes().map(|letter| Letter::of(letter).unwrap().bytes()).sum();
        let length = 3.0 + f64::from(u8::try_from(bytes).unwrap());
        self.defined.retain(|(known, ..)| *known != number || number == 128);
        self.defined.push((number, name.to_owned(), format.to_owned()));
        let numbers = [f64::from(number).into(), length.into()];
        self.add("FMT", &[&numbers[..], &[name.into(), format.into(), columns.into()]].concat());
    }

    /// One message; its values as they are, before the scale of a letter.
    pub fn add(&mut self, name: &str, values: &[Value<'_>]) {
        let (number, _, format) = self.defined.iter().find(|(_, known, _)| known == name).unwrap().clone();
        assert_eq!(format.len(), values.len(), "{name}");
        self.binary.extend([0xa3, 0x95, number]);
        self.text.push_str(name);
        for (letter, value) in format.bytes().zip(values) {
            self.binary.extend(stored(letter, *value));
            self.text.push_str(", ");
            match value {
                Value::Number(number) => self.text.push_str(&number.to_string()),
                Value::Text(text) => self.text.push_str(text),
                Value::Array(_) => self.text.push('0'),
            }
        }
        self.text.push('\n');
    }
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
fn stored(letter: u8, value: Value<'_>) -> Vec<u8> {
    let letter = Letter::of(letter).unwrap();
    match (letter, value) {
        (Letter::Text(bytes), Value::Text(text)) => {
            let mut stored = text.as_bytes().to_vec();
            stored.resize(bytes.into(), 0);
            stored
        }
        (Letter::Array, Value::Array(values)) => {
            values.iter().flat_map(|value| value.to_le_bytes()).collect()
        }
        (_, Value::Number(number)) => {
            let number = number / letter.scale();
            match letter {
                Letter::F32 => (number as f32).to_le_bytes().to_vec(),
                Letter::F64 => number.to_le_bytes().to_vec(),
                _ => (number.round() as i128).to_le_bytes()[..letter.bytes()].to_vec(),
            }
        }
        other => panic!("{other:?}"),
    }
}
