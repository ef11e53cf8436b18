//! The notes of a flight as tracing events, and the layer that writes these events to the flight's log of events.
//!
//! A note becomes an event with typed fields. The layer restores the note from the event and gives it to the thread that
//! writes the log, without waiting. The filters of other layers do not change the log.

use std::collections::HashMap;
use std::fmt;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use tracing::field::{Field, Visit};
use tracing::span::Id;
use tracing::{Event, Metadata, Span, Subscriber, dispatcher};
use tracing_subscriber::Layer;
use tracing_subscriber::filter::{FilterFn, LevelFilter};
use tracing_subscriber::layer::Context;
use tracing_subscriber::registry::LookupSpan;

use super::feed::Feed;
use crate::fly::outcome::{Level, Note};

/// Target of the events that are lines of a flight's log of events.
pub const EVENTS_TARGET: &str = "mavid::fly::events";
/// Target and name of the span of a flight.
const FLIGHT_TARGET: &str = "mavid::fly";
const FLIGHT: &str = "flight";

/// The layer that writes `events.jsonl`. Whoever flies by [`run`](super::run) needs it in the subscriber:
///
/// ```
/// use tracing_subscriber::prelude::*;
///
/// let subscriber = tracing_subscriber::registry().with(mavid::fly::event_layer());
/// tracing::subscriber::set_global_default(subscriber)?;
/// # Ok::<(), tracing::subscriber::SetGlobalDefaultError>(())
/// ```
pub fn event_layer<S>() -> impl Layer<S>
where
    S: Subscriber + for<'a> LookupSpan<'a>,
{
    let filter = FilterFn::new(is_of_a_flight as fn(&Metadata<'_>) -> bool);
    EventLayer::default().with_filter(filter.with_max_level_hint(LevelFilter::INFO))
}

/// A flight and the lines of its log, which is all that the layer hears.
fn is_of_a_flight(metadata: &Metadata<'_>) -> bool {
    let is_flight = metadata.is_span() && metadata.name() == FLIGHT && metadata.target() == FLIGHT_TARGET;
    is_flight || metadata.target() == EVENTS_TARGET
}

/// The span of a flight over the link of this address.
pub(super) fn flight_span(address: &impl fmt::Display, vehicle: &str) -> Span {
    tracing::info_span!(target: FLIGHT_TARGET, FLIGHT, %address, vehicle)
}

/// Emits a note as an event.
pub(super) fn emit(note: &Note) {
    let Note { time_s, level, kind, text } = note;
    macro_rules! emit {
        ($level:ident) => {
            tracing::event!(
                target: EVENTS_TARGET,
                tracing::Level::$level,
                time_s = *time_s,
                kind = kind.as_ref(),
                message = text.as_str()
            )
        };
    }
    match level {
        Level::Information => emit!(INFO),
        Level::Warning => emit!(WARN),
        Level::Error => emit!(ERROR),
    }
}

/// Flights under way, by their spans.
type Flights = Arc<Mutex<HashMap<Id, Feed>>>;

/// Writes the events within the span of a flight into the log of that flight.
#[derive(Debug, Default)]
struct EventLayer {
    flights: Flights,
}

impl<S> Layer<S> for EventLayer
where
    S: Subscriber + for<'a> LookupSpan<'a>,
{
    fn on_event(&self, event: &Event<'_>, context: Context<'_, S>) {
        if event.metadata().target() != EVENTS_TARGET {
            return;
        }
        let Some(mut scope) = context.event_scope(event) else { return };
        let feed = {
            let flights = locked(&self.flights);
            scope.find_map(|span| flights.get(&span.id()).cloned())
        };
        if let Some(feed) = feed {
            let mut said = EventText::default();
            event.record(&mut said);
            feed.write(said.note(*event.metadata().level()));
        }
    }
}

/// What a log of events hears of the subscriber, for as long as it lives.
#[derive(Debug)]
pub(super) struct Subscription {
    flights: Flights,
    id: Id,
}

impl Subscription {
    /// To the notes of the flight of this span; `None` where the current subscriber is without the layer.
    pub(super) fn to(span: &Span) -> Option<Self> {
        let flights = dispatcher::get_default(|current| {
            current.downcast_ref::<EventLayer>().map(|layer| layer.flights.clone())
        })?;
        Some(Self { flights, id: span.id()? })
    }

    /// The notes go to `feed` from now on.
    pub(super) fn begin(&self, feed: Feed) {
        locked(&self.flights).insert(self.id.clone(), feed);
    }
}

impl Drop for Subscription {
    fn drop(&mut self) {
        locked(&self.flights).remove(&self.id);
    }
}

/// The map is whole at every moment.
fn locked(flights: &Mutex<HashMap<Id, Feed>>) -> MutexGuard<'_, HashMap<Id, Feed>> {
    flights.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The fields of a note, as they are read from its event.
#[derive(Debug, Default)]
struct EventText {
    time_s: f64,
    kind: String,
    text: String,
}

impl EventText {
    fn note(self, level: tracing::Level) -> Note {
        let level = match level {
            tracing::Level::ERROR => Level::Error,
            tracing::Level::WARN => Level::Warning,
            _ => Level::Information,
        };
        Note { time_s: self.time_s, level, kind: self.kind.into(), text: self.text }
    }
}

impl Visit for EventText {
    fn record_f64(&mut self, field: &Field, value: f64) {
        if field.name() == "time_s" {
            self.time_s = value;
        }
    }

    fn record_str(&mut self, field: &Field, value: &str) {
        match field.name() {
            "kind" => value.clone_into(&mut self.kind),
            "message" => value.clone_into(&mut self.text),
            _ => {}
        }
    }

    /// No field of a note is of another type.
    fn record_debug(&mut self, _: &Field, _: &dyn fmt::Debug) {}
}
