//! Definitions of messages as they stand in the file: `name:type field;type[3] field;`.

use super::number::NumberType;

/// A message's definition.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Definition {
    pub(super) name: String,
    pub(super) fields: Vec<Field>,
}

/// One field of a definition.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Field {
    pub(super) name: String,
    pub(super) kind: FieldType,
    /// elements of an array; `None` for a single value
    pub(super) count: Option<usize>,
}

/// What a field holds.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum FieldType {
    Number(NumberType),
    /// a message of this name
    Message(String),
}

impl Field {
    /// It holds nothing: it moves the next field to an address that its type wants.
    pub(super) fn is_padding(&self) -> bool {
        self.name.starts_with("_padding")
    }
}

/// The definition that a text holds; `None` where it is none.
pub(super) fn parse(text: &[u8]) -> Option<Definition> {
    let text = str::from_utf8(text).ok()?;
    let (name, fields) = text.split_once(':')?;
    let fields = fields.split(';').filter(|field| !field.is_empty()).map(field);
    let fields = fields.collect::<Option<Vec<Field>>>()?;
    is_name(name).then(|| Definition { name: name.to_owned(), fields })
}

fn field(text: &str) -> Option<Field> {
    let (kind, name) = text.split_once(' ')?;
    let (kind, count) = match kind.split_once('[') {
        Some((kind, count)) => (kind, Some(count.strip_suffix(']')?.parse::<usize>().ok()?)),
        None => (kind, None),
    };
    if count == Some(0) {
        return None;
    }
    let kind = match NumberType::of(kind) {
        Some(number) => FieldType::Number(number),
        None if is_name(kind) => FieldType::Message(kind.to_owned()),
        None => return None,
    };
    is_name(name).then(|| Field { name: name.to_owned(), kind, count })
}

/// Letters, digits, and what other writers put between them.
pub(in crate::log::ulog) fn is_name(name: &str) -> bool {
    !name.is_empty() && name.bytes().all(|byte| byte.is_ascii_alphanumeric() || b"_-/.".contains(&byte))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_definition_is_read() {
        let definition = parse(b"esc_status:uint64_t timestamp;esc_report[8] esc;float[3] xyz;").unwrap();
        assert_eq!(definition.name, "esc_status");
        let fields: Vec<_> =
            definition.fields.iter().map(|field| (field.name.as_str(), field.count)).collect();
        assert_eq!(fields, [("timestamp", None), ("esc", Some(8)), ("xyz", Some(3))]);
        assert_eq!(definition.fields[1].kind, FieldType::Message("esc_report".into()));
    }

    #[test]
    fn what_is_no_definition_is_none() {
        for text in [
            "",
            "name",
            "name:float",
            "name:float[x] a",
            "na me:float a",
            ":float a",
            "n:fl\0t a",
            "n:float[0] a",
        ] {
            assert_eq!(parse(text.as_bytes()), None, "{text}");
        }
        assert_eq!(parse(&[0xff, b':']), None);
    }
}
