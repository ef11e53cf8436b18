//! Which topic's messages bear which number.

use std::collections::HashMap;
use std::sync::Arc;

use super::definition::{Definition, parse};
use super::layout::Layout;
use super::number::array;

/// Entries that all layouts of one log may take together; PX4's logs have about 10 000.
const MOST_SPANS: usize = 1 << 20;

/// One instance of a topic.
#[derive(Debug, Clone, PartialEq)]
pub struct Subscription {
    /// number of its messages
    pub id: u16,
    /// name
    pub topic: Arc<str>,
    /// instance, from 0
    pub instance: u8,
    /// where its fields stand
    pub layout: Arc<Layout>,
}

/// What messages of one number look like.
#[derive(Debug, Clone, Copy)]
struct Kind {
    /// bytes, least and most
    least: usize,
    most: usize,
    /// where the stamp is; beyond all of it where there is none
    stamp_at: usize,
}

impl Kind {
    const UNKNOWN: Self = Self { least: 1, most: 0, stamp_at: usize::MAX };

    fn of(layout: &Layout) -> Self {
        let (least, most) = layout.lengths();
        Self { least, most, stamp_at: layout.stamp_offset().unwrap_or(usize::MAX) }
    }
}

/// All definitions of a log so far.
#[derive(Debug, Default)]
pub(in crate::log::ulog) struct Schema {
    definitions: HashMap<String, Definition>,
    layouts: HashMap<String, Arc<Layout>>,
    subscriptions: Vec<Option<Subscription>>,
    /// what a judgement of every message needs of each number, in one place
    kinds: Vec<Kind>,
    spans: usize,
}

impl Schema {
    /// Takes a definition; `false` where it is none.
    pub(in crate::log::ulog) fn define(&mut self, text: &[u8]) -> bool {
        let Some(definition) = parse(text) else { return false };
        self.layouts.clear();
        self.definitions.insert(definition.name.clone(), definition);
        true
    }

    /// From here on messages of this number are of this topic; `None` where its definition is missing.
    pub(in crate::log::ulog) fn subscribe(
        &mut self,
        id: u16,
        instance: u8,
        name: &str,
    ) -> Option<&Subscription> {
        let layout = self.layout(name)?;
        let slot = usize::from(id);
        if slot >= self.subscriptions.len() {
            self.subscriptions.resize(slot + 1, None);
            self.kinds.resize(slot + 1, Kind::UNKNOWN);
        }
        self.kinds[slot] = Kind::of(&layout);
        self.subscriptions[slot] = Some(Subscription { id, topic: name.into(), instance, layout });
        self.subscriptions[slot].as_ref()
    }

    /// The topic of a number.
    #[inline]
    pub(in crate::log::ulog) fn subscription(&self, id: u16) -> Option<&Subscription> {
        self.subscriptions.get(usize::from(id))?.as_ref()
    }

    /// Whether a message of this number can have so many bytes behind its number; `None` for a number that is not known.
    #[inline]
    pub(in crate::log::ulog) fn fits(&self, id: u16, bytes: usize) -> Option<bool> {
        let kind = self.kinds.get(usize::from(id)).filter(|kind| kind.least <= kind.most)?;
        Some((kind.least..=kind.most).contains(&bytes))
    }

    /// The stamp of a message of this number, microseconds; `None` where it has none.
    #[inline]
    pub(in crate::log::ulog) fn stamp_us(&self, id: u16, message: &[u8]) -> Option<u64> {
        array(message, self.kinds.get(usize::from(id))?.stamp_at).map(u64::from_le_bytes)
    }

    fn layout(&mut self, name: &str) -> Option<Arc<Layout>> {
        if let Some(known) = self.layouts.get(name) {
            return Some(Arc::clone(known));
        }
        let layout = Layout::of(self.definitions.get(name)?, &self.definitions)?;
        self.spans += layout.spans();
        if self.spans > MOST_SPANS {
            return None;
        }
        let layout = Arc::new(layout);
        self.layouts.insert(name.to_owned(), Arc::clone(&layout));
        Some(layout)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn schema(definitions: &[&str]) -> Schema {
        let mut schema = Schema::default();
        definitions.iter().for_each(|text| assert!(schema.define(text.as_bytes()), "{text}"));
        schema
    }

    #[test]
    fn offsets_follow_nested_messages_and_padding() {
        let mut schema = schema(&[
            "outer:uint64_t timestamp;uint8_t count;uint8_t[3] _padding0;inner[2] part;float last;uint8_t[4] _padding1;",
            "inner:float[2] xy;uint16_t n;",
        ]);
        let layout = &schema.subscribe(7, 1, "outer").unwrap().layout;
        let offset = |path: &str| layout.cell(path).map(|cell| cell.offset);
        assert_eq!(offset("count"), Some(8));
        assert_eq!((offset("part[0].xy[1]"), offset("part[1].n")), (Some(16), Some(30)));
        assert_eq!((offset("last"), offset("part[2].n"), offset("part[0].xy[2]")), (Some(32), None, None));
        assert_eq!(layout.paths().last().as_deref(), Some("last"));
        assert_eq!(layout.lengths(), (36, 40));
        let fits = [35, 36, 40, 41].map(|bytes| schema.fits(7, bytes));
        assert_eq!(fits, [Some(false), Some(true), Some(true), Some(false)]);
        assert_eq!(schema.fits(8, 36), None);
    }

    #[test]
    fn a_definition_that_is_missing_circular_or_too_long_is_refused() {
        let mut schema = schema(&["a:b x;", "b:a y;", "c:missing z;", "d:e[60000] e;", "e:uint16_t n;"]);
        for name in ["a", "c", "d", "f"] {
            assert_eq!(schema.subscribe(0, 0, name), None, "{name}");
        }
    }

    #[test]
    fn layouts_are_bounded_together() {
        let mut schema = schema(&["unit:uint8_t n;"]);
        for index in 0..100_u16 {
            assert!(schema.define(format!("big{index}:unit[60000] n;").as_bytes()));
        }
        let taken = (0..100).filter(|index| schema.subscribe(*index, 0, &format!("big{index}")).is_some());
        assert_eq!(taken.count(), 17);
    }
}
