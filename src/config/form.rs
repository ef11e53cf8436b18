//! From TOML to the form of a file, past what is wrong with it: so that every fault is told, and not the first alone.

use std::collections::BTreeSet;
use std::fmt;
use std::ops::Range;

use serde::de::value::{MapDeserializer, SeqDeserializer, StrDeserializer};
use serde::de::{
    DeserializeOwned, DeserializeSeed, Deserializer, Error as _, IntoDeserializer, MapAccess, SeqAccess,
    Visitor,
};
use serde::forward_to_deserialize_any;
use toml::Spanned;
use toml::de::{DeTable, DeValue, ValueDeserializer};

/// Faults that are looked for in one file: a file of another program would have thousands.
pub(super) const MOST_FAULTS: usize = 20;

/// A key that does not exist, a key that is missing, a value of the wrong kind, or what is not TOML.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Fault {
    /// key with its tables; empty where the text is not TOML
    pub path: String,
    /// bytes of the text
    pub span: Option<Range<usize>>,
    /// what is wrong
    pub message: String,
}

/// A form as far as it could be read. What is at fault stands in it as nothing: NaN, an empty text, no table.
#[derive(Debug)]
pub(super) struct Read<T> {
    pub form: T,
    /// in the order in which they were met; empty where the form is whole
    pub faults: Vec<Fault>,
    /// paths at which nothing stands for what is at fault
    pub stands_in: BTreeSet<String>,
}

/// The form `T` of a text; its faults where it has too many to have a form.
pub(super) fn read_form<T: DeserializeOwned>(text: &str) -> Result<Read<T>, Vec<Fault>> {
    let (table, errors) = DeTable::parse_recoverable(text);
    if !errors.is_empty() {
        return Err(syntax(&errors));
    }
    let root = Spanned::new(table.span(), DeValue::Table(table.into_inner()));
    let (mut faults, mut stands_in) = (Vec::new(), BTreeSet::new());
    loop {
        let node = Node { value: Some(&root), path: String::new(), stands_in: &stands_in };
        let halt = match T::deserialize(node) {
            Ok(form) => return Ok(Read { form, faults, stands_in }),
            Err(halt) => halt,
        };
        let path = halt.path.unwrap_or_default();
        if !is_at_or_below(&stands_in, &path) {
            faults.push(Fault { path: path.clone(), span: halt.span, message: halt.message });
        }
        // what stands in already cannot be at fault again
        if !stands_in.insert(path) || faults.len() == MOST_FAULTS {
            return Err(faults);
        }
    }
}

/// Whether nothing stands at this path, or for a table that it is in.
pub(super) fn is_at_or_below(stands_in: &BTreeSet<String>, path: &str) -> bool {
    let ends = path.match_indices(['.', '[']).map(|(end, _)| end).chain([path.len()]);
    ends.into_iter().any(|end| stands_in.contains(&path[..end]))
}

/// What is not TOML, once a line: one slip makes several errors.
fn syntax(errors: &[toml::de::Error]) -> Vec<Fault> {
    let fault = |error: &toml::de::Error| Fault {
        path: String::new(),
        span: error.span(),
        message: error.message().to_owned(),
    };
    errors.iter().take(MOST_FAULTS).map(fault).collect()
}

/// Where reading stopped.
#[derive(Debug)]
struct Halt {
    /// `None` until it is known
    path: Option<String>,
    span: Option<Range<usize>>,
    message: String,
    /// a key that is not there
    missing: Option<&'static str>,
}

impl fmt::Display for Halt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for Halt {}

impl serde::de::Error for Halt {
    fn custom<T: fmt::Display>(message: T) -> Self {
        Self { path: None, span: None, message: message.to_string(), missing: None }
    }

    fn missing_field(field: &'static str) -> Self {
        Self { missing: Some(field), ..Self::custom(format_args!("missing field `{field}`")) }
    }
}

/// A value of the file and where it stands; without a value nothing.
#[derive(Clone)]
struct Node<'a> {
    value: Option<&'a Spanned<DeValue<'a>>>,
    path: String,
    stands_in: &'a BTreeSet<String>,
}

impl<'a> Node<'a> {
    /// The value, unless nothing stands in its place.
    fn sound(&self) -> Option<&'a Spanned<DeValue<'a>>> {
        self.value.filter(|_| !self.stands_in.contains(&self.path))
    }

    fn key(&self, name: &str) -> String {
        if self.path.is_empty() { name.to_owned() } else { format!("{}.{name}", self.path) }
    }

    fn child(&self, name: &str, value: Option<&'a Spanned<DeValue<'a>>>) -> Self {
        Self { value, path: self.key(name), stands_in: self.stands_in }
    }

    /// As it stands in the file.
    fn as_written<T>(
        &self,
        value: &Spanned<DeValue<'a>>,
        read: impl FnOnce(ValueDeserializer<'a>) -> Result<T, toml::de::Error>,
    ) -> Result<T, Halt> {
        read(ValueDeserializer::from(value.clone())).map_err(|error| Halt {
            path: Some(self.path.clone()),
            span: error.span().or_else(|| Some(value.span())),
            ..Halt::custom(error.message())
        })
    }

    /// An error of this value, where none of its parts was named.
    fn located(&self, mut halt: Halt) -> Halt {
        if halt.path.is_none() {
            halt.path = Some(halt.missing.map_or_else(|| self.path.clone(), |field| self.key(field)));
            halt.span = self.value.map(|value| value.span());
        }
        halt
    }

    fn elements(&self, values: &'a [Spanned<DeValue<'a>>]) -> Elements<'a> {
        Elements { of: self.clone(), values: values.iter(), next: 0 }
    }
}

/// Methods that read a value as it stands, or give what stands for it.
macro_rules! values {
    ($($method:ident: $visit:ident($nothing:expr)),* $(,)?) => {$(
        fn $method<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Halt> {
            match self.sound() {
                Some(value) => self.as_written(value, |of| of.$method(visitor)),
                None => visitor.$visit($nothing),
            }
        }
    )*};
}

impl<'de> Deserializer<'de> for Node<'de> {
    type Error = Halt;

    values! {
        deserialize_f64: visit_f64(f64::NAN),
        deserialize_u8: visit_u8(0),
        deserialize_u32: visit_u32(0),
        deserialize_u64: visit_u64(0),
        deserialize_bool: visit_bool(false),
        deserialize_str: visit_str(""),
        deserialize_string: visit_str(""),
        deserialize_any: visit_map(MapDeserializer::new(std::iter::empty::<(&str, f64)>())),
        deserialize_map: visit_map(MapDeserializer::new(std::iter::empty::<(&str, f64)>())),
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Halt> {
        if self.sound().is_some() { visitor.visit_some(self) } else { visitor.visit_none() }
    }

    fn deserialize_seq<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Halt> {
        match self.sound().map(|value| (value, value.get_ref())) {
            Some((_, DeValue::Array(values))) => {
                visitor.visit_seq(self.elements(values)).map_err(|halt| self.located(halt))
            }
            Some((value, _)) => self.as_written(value, |of| of.deserialize_seq(visitor)),
            None => visitor.visit_seq(SeqDeserializer::new(std::iter::empty::<f64>())),
        }
    }

    fn deserialize_tuple<V: Visitor<'de>>(self, length: usize, visitor: V) -> Result<V::Value, Halt> {
        match self.sound().map(|value| (value, value.get_ref())) {
            Some((value, DeValue::Array(values))) if values.len() != length => Err(Halt {
                path: Some(self.path.clone()),
                span: Some(value.span()),
                ..Halt::invalid_length(values.len(), &visitor)
            }),
            Some((_, DeValue::Array(values))) => {
                visitor.visit_seq(self.elements(values)).map_err(|halt| self.located(halt))
            }
            Some((value, _)) => self.as_written(value, |of| of.deserialize_tuple(length, visitor)),
            None => visitor.visit_seq(SeqDeserializer::new(std::iter::repeat_n(f64::NAN, length))),
        }
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        name: &'static str,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Halt> {
        let mut keys: Vec<(&'de str, Option<&'de Spanned<DeValue<'de>>>)> = Vec::new();
        match self.sound().map(|value| (value, value.get_ref())) {
            Some((_, DeValue::Table(table))) => {
                for (key, value) in table {
                    let known = fields.contains(&key.get_ref().as_ref());
                    let path = self.key(key.get_ref());
                    if known {
                        keys.push((key.get_ref(), Some(value)));
                    } else if !self.stands_in.contains(&path) {
                        let halt = Halt::unknown_field(key.get_ref(), fields);
                        return Err(Halt { path: Some(path), span: Some(key.span()), ..halt });
                    }
                }
            }
            Some((value, _)) => {
                return self.as_written(value, |of| of.deserialize_struct(name, fields, visitor));
            }
            None => {}
        }
        let is_there = |field: &str, keys: &[(&str, Option<_>)]| keys.iter().any(|(key, _)| *key == field);
        for field in fields.iter().filter(|field| self.stands_in.contains(&self.key(field))) {
            if !is_there(field, &keys) {
                keys.push((field, None));
            }
        }
        visitor
            .visit_map(Entries { of: self.clone(), keys: keys.into_iter(), value: None })
            .map_err(|halt| self.located(halt))
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        name: &'static str,
        variants: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Halt> {
        match self.sound() {
            Some(value) => self.as_written(value, |of| of.deserialize_enum(name, variants, visitor)),
            None => {
                let first = variants.first().copied().unwrap_or_default();
                visitor.visit_enum(StrDeserializer::<Halt>::new(first))
            }
        }
    }

    fn deserialize_ignored_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Halt> {
        visitor.visit_unit()
    }

    forward_to_deserialize_any! {
        i8 i16 i32 i64 i128 u16 u128 f32 char bytes byte_buf unit unit_struct newtype_struct tuple_struct identifier
    }
}

/// The keys of a table that the form has, and those for which nothing stands.
struct Entries<'a> {
    of: Node<'a>,
    keys: std::vec::IntoIter<(&'a str, Option<&'a Spanned<DeValue<'a>>>)>,
    value: Option<Node<'a>>,
}

impl<'de> MapAccess<'de> for Entries<'de> {
    type Error = Halt;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, Halt> {
        let Some((key, value)) = self.keys.next() else { return Ok(None) };
        self.value = Some(self.of.child(key, value));
        let key: StrDeserializer<'_, Halt> = key.into_deserializer();
        seed.deserialize(key).map(Some)
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, Halt> {
        let node = self.value.take().ok_or_else(|| Halt::custom("a value before its key"))?;
        let at = node.clone();
        seed.deserialize(node).map_err(|halt| at.located(halt))
    }
}

/// The elements of an array.
struct Elements<'a> {
    of: Node<'a>,
    values: std::slice::Iter<'a, Spanned<DeValue<'a>>>,
    next: usize,
}

impl<'de> SeqAccess<'de> for Elements<'de> {
    type Error = Halt;

    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>, Halt> {
        let Some(value) = self.values.next() else { return Ok(None) };
        let path = format!("{}[{}]", self.of.path, self.next);
        self.next += 1;
        let node = Node { value: Some(value), path, stands_in: self.of.stands_in };
        let at = node.clone();
        seed.deserialize(node).map_err(|halt| at.located(halt)).map(Some)
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.values.len())
    }
}
