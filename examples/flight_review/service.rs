//! The side of the service, in short: the shape of its analyzers, and the pass that gives them the messages of a log.
//!
//! Names and types are those that an analyzer of PX4's `flight-review-rs` meets: messages of the topics that it asks for, one after the
//! other, each with its flat fields; at the end it gives diagnostics. Only what this example needs is here.

use std::collections::BTreeMap;

/// A field of a message without nested ones: `esc[2].esc_rpm`, `q[0]`.
#[derive(Debug, Clone, PartialEq)]
pub struct FlattenedField {
    pub flattened_field_name: String,
    /// as the log calls it: `float`, `uint8_t`
    pub field_type: String,
    /// bytes from the message's beginning
    pub offset: u16,
}

/// The fields of a topic.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FlattenedFormat {
    pub message_name: String,
    pub fields: Vec<FlattenedField>,
    size: u16,
}

/// One message.
pub struct DataMessage<'a> {
    pub multi_id: u8,
    pub flattened_format: &'a FlattenedFormat,
    pub data: &'a [u8],
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Severity {
    Info,
    Warning,
    Critical,
}

/// An instant, or a span with its end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AnomalyKind {
    Point,
    Region { end_timestamp_us: u64 },
}

/// What an analyzer found.
#[derive(Debug, Clone, PartialEq)]
pub struct Diagnostic {
    pub id: String,
    pub summary: String,
    pub severity: Severity,
    pub kind: AnomalyKind,
    pub timestamp_us: u64,
    /// topic and field at which it is plotted
    pub anchor: Option<(String, String)>,
    /// name, value, unit
    pub evidence: Vec<(String, f64, String)>,
}

#[allow(dead_code, reason = "a service lists its analyzers by name and description, this one does not")]
pub trait Analyzer {
    fn id(&self) -> &str;
    fn description(&self) -> &str;
    fn required_topics(&self) -> &[&str];
    fn on_message(&mut self, data: &DataMessage);
    fn finish(self: Box<Self>) -> Vec<Diagnostic>;
}

/// What the service knows of a log before its messages.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Metadata {
    /// of the log's clock, microseconds
    pub start_timestamp_us: u64,
    pub parameters: BTreeMap<String, f64>,
}

/// The passes of the service over a log: first what it knows beforehand, then every message to whoever asked for its topic.
pub fn analyze(log: &[u8], analyzers: impl Fn(&Metadata) -> Vec<Box<dyn Analyzer>>) -> Vec<Diagnostic> {
    let mut metadata = Metadata { start_timestamp_us: u64_at(log, 8), ..Metadata::default() };
    let mut formats: BTreeMap<String, Vec<(String, String)>> = BTreeMap::new();
    for (kind, body) in messages(log) {
        match kind {
            b'F' => formats.extend(format(body)),
            b'P' => metadata.parameters.extend(parameter(body)),
            _ => (),
        }
    }
    let mut analyzers = analyzers(&metadata);
    let mut topics: BTreeMap<u16, (u8, FlattenedFormat)> = BTreeMap::new();
    for (kind, body) in messages(log) {
        match (kind, body) {
            (b'A', [multi_id, low, high, name @ ..]) => {
                let name = String::from_utf8_lossy(name).into_owned();
                let mut flat = FlattenedFormat { message_name: name.clone(), ..FlattenedFormat::default() };
                flatten(&formats, &name, "", &mut flat);
                topics.insert(u16::from_le_bytes([*low, *high]), (*multi_id, flat));
            }
            (b'D', [low, high, data @ ..]) => {
                let Some((multi_id, flat)) = topics.get(&u16::from_le_bytes([*low, *high])) else { continue };
                let message = DataMessage { multi_id: *multi_id, flattened_format: flat, data };
                let asked = |analyzer: &&mut Box<dyn Analyzer>| {
                    analyzer.required_topics().contains(&flat.message_name.as_str())
                };
                analyzers.iter_mut().filter(asked).for_each(|analyzer| analyzer.on_message(&message));
            }
            _ => (),
        }
    }
    analyzers.into_iter().flat_map(Analyzer::finish).collect()
}

fn u64_at(bytes: &[u8], at: usize) -> u64 {
    let found = bytes.get(at..at + 8).and_then(|bytes| bytes.try_into().ok());
    found.map_or(0, u64::from_le_bytes)
}

/// Kind and body of each message behind the header.
fn messages(log: &[u8]) -> impl Iterator<Item = (u8, &[u8])> {
    let mut rest = log.get(16..).unwrap_or_default();
    std::iter::from_fn(move || {
        let [low, high, kind, behind @ ..] = rest else { return None };
        let body = behind.get(..usize::from(u16::from_le_bytes([*low, *high])))?;
        rest = &behind[body.len()..];
        Some((*kind, body))
    })
}

/// Name of a format, and type and name of its fields.
fn format(body: &[u8]) -> Option<(String, Vec<(String, String)>)> {
    let text = std::str::from_utf8(body).ok()?;
    let (name, fields) = text.split_once(':')?;
    let field = |field: &str| field.split_once(' ').map(|(kind, name)| (kind.to_owned(), name.to_owned()));
    Some((name.to_owned(), fields.split(';').filter_map(field).collect()))
}

fn parameter(body: &[u8]) -> Option<(String, f64)> {
    let length = usize::from(*body.first()?);
    let (kind, name) = std::str::from_utf8(body.get(1..=length)?).ok()?.split_once(' ')?;
    let value: [u8; 4] = body.get(length + 1..length + 5)?.try_into().ok()?;
    let value =
        if kind == "float" { f32::from_le_bytes(value).into() } else { i32::from_le_bytes(value).into() };
    Some((name.to_owned(), value))
}

fn size_of(kind: &str) -> Option<u16> {
    match kind {
        "int8_t" | "uint8_t" | "bool" | "char" => Some(1),
        "int16_t" | "uint16_t" => Some(2),
        "int32_t" | "uint32_t" | "float" => Some(4),
        "int64_t" | "uint64_t" | "double" => Some(8),
        _ => None,
    }
}

fn flatten(
    formats: &BTreeMap<String, Vec<(String, String)>>,
    name: &str,
    prefix: &str,
    flat: &mut FlattenedFormat,
) {
    for (kind, field) in formats.get(name).into_iter().flatten() {
        let (kind, count) = match kind.strip_suffix(']').and_then(|kind| kind.split_once('[')) {
            Some((kind, count)) => (kind, count.parse::<u16>().ok()),
            None => (kind.as_str(), None),
        };
        for index in 0..count.unwrap_or(1) {
            let place = count.map_or_else(String::new, |_| format!("[{index}]"));
            let own = format!("{prefix}{field}{place}");
            match size_of(kind) {
                Some(size) => {
                    let offset = flat.size;
                    flat.size += size;
                    if !field.starts_with("_padding") {
                        let field_type = kind.to_owned();
                        flat.fields.push(FlattenedField { flattened_field_name: own, field_type, offset });
                    }
                }
                None => flatten(formats, kind, &format!("{own}."), flat),
            }
        }
    }
}
