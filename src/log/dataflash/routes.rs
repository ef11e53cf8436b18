//! Where a message's fields go: resolved once a definition, not once a message.

use super::definition::Definition;
use super::definitions::Definitions;
use super::message::Message;
use super::special::{SPECIALS, Special};
use super::topics::{Demand, Instance, TOPICS, Topic};
use super::values::Values;

/// Names of the field that says of which sensor, core or output a message is, where the log does not mark it.
const INSTANCE_FIELDS: [&str; 5] = ["I", "C", "IMU", "Instance", "Inst"];
/// The unit of such a field, where the log marks it.
const INSTANCE_UNIT: &str = "instance";

/// Where the fields of all messages go, by number.
pub(super) struct AllRoutes(Vec<Option<Routes>>);

impl Default for AllRoutes {
    fn default() -> Self {
        let mut all = Vec::new();
        all.resize_with(256, || None);
        Self(all)
    }
}

impl AllRoutes {
    /// Those of a message.
    pub(super) fn of(&mut self, message: &Message<'_>, definitions: &Definitions) -> &mut Routes {
        let number = message.definition.number;
        let slot = &mut self.0[usize::from(number)];
        if slot.as_ref().is_some_and(|routes| routes.revision != definitions.revision(number)) {
            *slot = None;
        }
        slot.get_or_insert_with(|| Routes::of(message.definition, definitions))
    }
}

/// Where the fields of one definition go.
#[derive(Debug)]
pub(super) struct Routes {
    /// of the definition that these are for
    pub revision: u32,
    /// field with the time, and seconds in one of it
    pub stamp: Option<(usize, f64)>,
    pub instance: Option<usize>,
    pub special: Option<(Special, Vec<usize>)>,
    pub streams: Vec<Route>,
    /// the tally of each instance met
    pub tallies: Vec<(u8, usize)>,
}

/// Where some fields of one definition go.
#[derive(Debug)]
pub(super) struct Route {
    pub topic: &'static Topic,
    /// field and what turns its number into SI
    columns: Vec<(usize, f64)>,
    /// field with the time of the sample, microseconds
    pub sampled: Option<usize>,
    /// the log says in which units the message is
    pub has_units: bool,
}

impl Routes {
    pub(super) fn of(definition: &Definition, definitions: &Definitions) -> Self {
        let number = definition.number;
        let marked = |field: usize| definitions.unit(number, field).0 == Some(INSTANCE_UNIT);
        let is_instance = |field: &usize| {
            marked(*field) || INSTANCE_FIELDS.contains(&definition.fields[*field].name.as_str())
        };
        let streams = TOPICS.iter().flat_map(|topics| topics.iter());
        let streams = streams.filter(|topic| topic.message == definition.name);
        let special = SPECIALS.iter().find(|special| special.message == definition.name);
        let special = special.and_then(|special| Some((special.meaning, special.fields_in(definition)?)));
        Self {
            revision: definitions.revision(number),
            stamp: stamp(definition),
            instance: (0..definition.fields.len()).find(is_instance),
            special,
            streams: streams.filter_map(|topic| Route::of(topic, definition, definitions)).collect(),
            tallies: Vec::new(),
        }
    }

    /// Samples come of it: those without a time do not.
    pub(super) fn gives_samples(&self) -> bool {
        self.stamp.is_some() && !self.streams.is_empty()
    }

    /// The message's own time, s of the vehicle's clock.
    pub(super) fn stamp_s(&self, message: &Message<'_>) -> Option<f64> {
        let (field, unit_s) = self.stamp?;
        let stamp = message.number(field);
        stamp.is_finite().then_some(stamp * unit_s)
    }

    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a byte, or it saturates")]
    pub(super) fn instance(&self, message: &Message<'_>) -> u8 {
        self.instance.map_or(0, |field| message.number(field) as u8)
    }
}

/// The field with the time since start. GPS of old logs has the satellites' time in `TimeMS` and that of the vehicle in `T`.
fn stamp(definition: &Definition) -> Option<(usize, f64)> {
    let first = definition.fields.first()?;
    match first.name.as_str() {
        "TimeUS" => Some((0, 1e-6)),
        "TimeMS" => Some((0, 1e-3)),
        _ if definition.name.starts_with("GPS") => Some((definition.field("T")?, 1e-3)),
        _ => None,
    }
}

impl Route {
    fn of(topic: &'static Topic, definition: &Definition, definitions: &Definitions) -> Option<Self> {
        let column = |column: &super::topics::Column| {
            let field = column.names.iter().find_map(|name| definition.field(name))?;
            let letter = definition.fields[field].letter;
            Some((field, column.unit.factor(letter, definitions.unit(definition.number, field))))
        };
        let columns: Vec<(usize, f64)> = topic.columns.iter().map_while(column).collect();
        let wanted = if topic.demands == Demand::AsManyAsThere { 1 } else { topic.columns.len() };
        let sampled = topic.sampled.and_then(|name| definition.field(name));
        let has_units = definition.fields.iter().any(|field| field.unit.is_some());
        if topic.demands == Demand::Units && !has_units {
            return None;
        }
        (columns.len() >= wanted).then_some(Self { topic, columns, sampled, has_units })
    }

    /// The fields of a message in SI, in the log's frames, where a number is `times` one of the newest releases.
    pub(super) fn values(&self, message: &Message<'_>, times: f64, values: &mut Values) {
        values.clear();
        for (field, factor) in &self.columns {
            values.push(message.number(*field) * factor / times);
        }
    }

    pub(super) fn instance(&self, of_message: u8) -> u8 {
        match self.topic.instance {
            Instance::Field => of_message,
            Instance::Number(number) => number,
        }
    }
}
