//! All definitions that a log has given so far, and its units.

use std::collections::BTreeMap;

use super::definition::{Definition, FMT};
use super::message::Message;

/// All definitions that a log has given so far, and its units.
#[derive(Debug, Clone)]
pub struct Definitions {
    /// by number
    known: Vec<Option<Known>>,
    /// what an identifier of a unit stands for
    units: BTreeMap<u8, String>,
    /// what an identifier of a multiplier stands for
    multipliers: BTreeMap<u8, f64>,
}

/// What ArduPilot's identifiers of multipliers have stood for in every release (LogStructure.h).
const WRITTEN: &[(u8, f64)] = &[
    (b'2', 1e2),
    (b'1', 1e1),
    (b'0', 1.0),
    (b'A', 1e-1),
    (b'B', 1e-2),
    (b'C', 1e-3),
    (b'D', 1e-4),
    (b'E', 1e-5),
    (b'F', 1e-6),
    (b'G', 1e-7),
    (b'I', 1e-9),
    (b'!', 3.6),
    (b'/', 3600.0),
];

#[derive(Debug, Clone)]
struct Known {
    definition: Definition,
    /// counts what was learnt of it
    revision: u32,
    teaches: bool,
}

/// What a message teaches about others.
pub(super) enum Lesson {
    Definition(Definition),
    /// number, identifiers of units and of multipliers
    Units(u8, Vec<u8>, Vec<u8>),
    Unit(u8, String),
    Multiplier(u8, f64),
}

impl Default for Definitions {
    fn default() -> Self {
        let mut definitions =
            Self { known: vec![None; 256], units: BTreeMap::new(), multipliers: BTreeMap::new() };
        definitions.learn(Lesson::Definition(Definition::of_fmt()));
        definitions
    }
}

impl Definitions {
    /// The definition of a number.
    #[must_use]
    pub fn get(&self, number: u8) -> Option<&Definition> {
        self.known[usize::from(number)].as_ref().map(|known| &known.definition)
    }

    /// The definition of a name, the last one given.
    #[must_use]
    pub fn named(&self, name: &str) -> Option<&Definition> {
        self.known.iter().rev().flatten().map(|known| &known.definition).find(|known| known.name == name)
    }

    /// Bytes of a message of this number with its header.
    pub(super) fn bytes(&self, number: u8) -> Option<usize> {
        self.get(number).map(|definition| definition.bytes)
    }

    /// Grows with each thing learnt of the message of this number.
    pub(super) fn revision(&self, number: u8) -> u32 {
        self.known[usize::from(number)].as_ref().map_or(0, |known| known.revision)
    }

    /// Unit of a field and what turns its number into it, where the log says them: `m/s` and 1.
    #[must_use]
    pub fn unit(&self, number: u8, field: usize) -> (Option<&str>, Option<f64>) {
        let Some(field) = self.get(number).and_then(|definition| definition.fields.get(field)) else {
            return (None, None);
        };
        let unit = field.unit.and_then(|id| self.units.get(&id)).map(String::as_str);
        (unit, field.multiplier.and_then(|id| self.multipliers.get(&id)).copied())
    }

    /// Whether messages of this number say what others are made of.
    pub(super) fn teaches(&self, number: u8) -> bool {
        self.known[usize::from(number)].as_ref().is_some_and(|known| known.teaches)
    }

    /// What a message says of others; `None` where it is damaged.
    pub(super) fn lesson(message: &Message<'_>) -> Option<Lesson> {
        let field = |name| message.definition.field(name);
        let id = |name| byte(message.number(field(name)?));
        match message.definition.name.as_str() {
            "UNIT" => Some(Lesson::Unit(id("Id")?, message.text(field("Label")?).into_owned())),
            "MULT" => Some(Lesson::Multiplier(id("Id")?, message.number(field("Mult")?))),
            "FMTU" => {
                let ids = |name| {
                    let text = message.text(field(name)?);
                    Some(text.bytes().collect())
                };
                Some(Lesson::Units(id("FmtType")?, ids("UnitIds")?, ids("MultIds")?))
            }
            _ => None,
        }
    }

    pub(super) fn learn(&mut self, lesson: Lesson) {
        match lesson {
            // its number is damaged
            Lesson::Definition(definition) if definition.number == FMT && definition.name != "FMT" => {}
            Lesson::Definition(definition) => {
                let known = &mut self.known[usize::from(definition.number)];
                let same = |known: &Known| {
                    let plain = |definition: &Definition| {
                        let mut definition = definition.clone();
                        definition.set_units(&[], &[]);
                        definition
                    };
                    plain(&known.definition) == definition
                };
                // said twice: it keeps its units
                if !known.as_ref().is_some_and(same) {
                    let teaches = definition.number == FMT
                        || ["FMTU", "UNIT", "MULT"].contains(&definition.name.as_str());
                    let revision = known.as_ref().map_or(1, |known| known.revision + 1);
                    *known = Some(Known { definition, revision, teaches });
                }
            }
            Lesson::Units(number, units, multipliers) => {
                if let Some(known) = &mut self.known[usize::from(number)] {
                    known.definition.set_units(&units, &multipliers);
                    known.revision += 1;
                }
            }
            Lesson::Unit(id, label) => {
                self.units.insert(id, label);
            }
            Lesson::Multiplier(id, value) => {
                let known = WRITTEN.iter().find(|(known, _)| *known == id).map(|(_, value)| *value);
                // it is in single precision; another value is damage
                let is_other = |known: &f64| (value - known).abs() > 1e-6 * known;
                self.multipliers.insert(id, known.filter(is_other).unwrap_or(value));
            }
        }
    }
}

/// A number that is a byte; `b`, in which identifiers stand, has a sign.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within the bounds of a byte")]
fn byte(number: f64) -> Option<u8> {
    let number = if number < 0.0 { number + 256.0 } else { number };
    (0.0..=255.0).contains(&number).then_some(number as u8)
}
