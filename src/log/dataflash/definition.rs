//! What a message is made of, as the log itself says (FMT, FMTU).

use super::letter::{Letter, MESSAGE_BYTES};

/// Marker and number.
pub(super) const HEADER_BYTES: usize = 3;
/// The number of FMT, the message that defines the others.
pub(super) const FMT: u8 = 128;
/// What FMT itself is made of, in every log.
pub(super) const FMT_BYTES: usize = 89;

/// What a message is made of.
#[derive(Debug, Clone, PartialEq)]
pub struct Definition {
    /// number in its header
    pub number: u8,
    /// bytes with its header
    pub bytes: usize,
    /// up to four letters
    pub name: String,
    /// in the order of the message
    pub fields: Vec<Field>,
}

/// One field of a message.
#[derive(Debug, Clone, PartialEq)]
pub struct Field {
    /// as the log calls it
    pub name: String,
    /// how it is stored
    pub letter: Letter,
    /// where it begins, from the message's header on
    pub offset: usize,
    /// identifier of its unit among the log's units (UNIT); `None` where the log does not say
    pub unit: Option<u8>,
    /// identifier of what turns its value into that unit (MULT)
    pub multiplier: Option<u8>,
}

impl Definition {
    /// The definition of FMT itself.
    #[must_use]
    pub(super) fn of_fmt() -> Self {
        let fields = "Type,Length,Name,Format,Columns";
        Self { number: FMT, bytes: FMT_BYTES, name: "FMT".to_owned(), fields: laid_out("BBnNZ", fields) }
    }

    /// What a FMT defines; `None` where it cannot be meant: letters that nobody knows, a name that is none, lengths that
    /// contradict each other.
    #[must_use]
    pub(super) fn new(number: u8, bytes: usize, name: &str, format: &str, fields: &str) -> Option<Self> {
        let is_name =
            |name: &str| !name.is_empty() && name.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_');
        let is_label = |b: u8| b.is_ascii_graphic() || b == b' ';
        let known = format.bytes().all(|letter| Letter::of(letter).is_some());
        if !is_name(name) || !known || !fields.bytes().all(is_label) || !MESSAGE_BYTES.contains(&bytes) {
            return None;
        }
        let fields = laid_out(format, fields);
        let end = fields.last().map_or(HEADER_BYTES, |last| last.offset + last.letter.bytes());
        // a message of an old release may be empty although its definition counts bytes
        (end == bytes || fields.is_empty()).then(|| Self { number, bytes, name: name.to_owned(), fields })
    }

    /// What a whole FMT message defines.
    #[must_use]
    pub(super) fn from_message(message: &[u8]) -> Option<Self> {
        let [number, bytes] = *message.get(HEADER_BYTES..)?.first_chunk::<2>()?;
        let text = |from: usize, length: usize| {
            let padded = message.get(from..from + length)?;
            let end = padded.iter().position(|byte| *byte == 0).unwrap_or(length);
            // what follows the end is nothing: PX4's older logs have spaces there
            padded[end..].iter().all(|byte| *byte == 0).then_some(())?;
            std::str::from_utf8(&padded[..end]).ok()
        };
        Self::new(number, bytes.into(), text(5, 4)?, text(9, 16)?, text(25, 64)?)
    }

    /// Where a field stands among the fields.
    #[must_use]
    pub fn field(&self, name: &str) -> Option<usize> {
        self.fields.iter().position(|field| field.name == name)
    }

    /// Takes the units that a FMTU says, one identifier a field.
    pub(super) fn set_units(&mut self, units: &[u8], multipliers: &[u8]) {
        for (index, field) in self.fields.iter_mut().enumerate() {
            field.unit = units.get(index).copied();
            field.multiplier = multipliers.get(index).copied();
        }
    }
}

fn laid_out(format: &str, names: &str) -> Vec<Field> {
    let mut names = names.split(',').map(str::trim);
    let mut offset = HEADER_BYTES;
    let letters = format.bytes().filter_map(Letter::of);
    letters
        .map(|letter| {
            let name = names.next().unwrap_or_default().to_owned();
            let field = Field { name, letter, offset, unit: None, multiplier: None };
            offset += letter.bytes();
            field
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::Definition;

    #[test]
    fn a_definition_that_contradicts_itself_is_none() {
        let of = |bytes, name, format, fields| Definition::new(130, bytes, name, format, fields);
        let good = of(3 + 8 + 4, "ATT", "Qf", "TimeUS,Roll").unwrap();
        assert_eq!((good.fields[1].offset, good.field("Roll")), (11, Some(1)));
        assert!(of(16, "ATT", "Qf", "TimeUS,Roll").is_none());
        assert!(of(15, "A T", "Qf", "TimeUS,Roll").is_none());
        assert!(of(15, "ATT", "Q?", "TimeUS,Roll").is_none());
        assert!(of(15, "", "Qf", "TimeUS,Roll").is_none());
        // names may be fewer than fields where the row of names is cut off
        assert_eq!(of(15, "ATT", "Qf", "TimeUS").unwrap().fields[1].name, "");
    }
}
