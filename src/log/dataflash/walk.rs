//! One way through a log, binary or text.

use super::batches::Batches;
use super::clock::{Clock, Placed};
use super::definition::FMT;
use super::definitions::Definitions;
use super::identity::Identity;
use super::join::Join;
use super::jumps::Jumps;
use super::message::{Kept, Message};
use super::outlet::Outlet;
use super::routes::{AllRoutes, Route, Routes};
use super::special::Special;
use super::states::{Meaning, States, is_refusal_to_arm, meaning};
use super::tally::Tally;
use super::topics::{Demand, Part};
use super::values::Values;
use crate::autopilot::{ARDUPILOT, Autopilot};
use crate::frames::Geodetic;
use crate::log::date::Date;
use crate::log::error::LogError;
use crate::log::format::Sink;
use crate::log::leap::{Leap, LeapCause};
use crate::recording::landed::{IN_AIR, ON_GROUND};
use crate::recording::{Event, Quantity};

/// MAV_SEVERITY of texts, which carry none, and of errors.
const INFORMATION: u8 = 6;
const ERROR: u8 = 3;
/// Parameters and messages of the simulator tell the truth that is to be found out.
const SIMULATOR: &str = "SIM_";
/// Parameters of Copter 3.4 and later, and of those before: whether rates are as they are now.
const RATES: [(&str, bool); 2] = [("ATC_RAT_", true), ("RATE_RLL_", false)];
const STATES: &str = "EV";
/// Tells of arming when it changes; others tell it again and again.
const CHANGES: &str = "ARM";
const BATCHES: &str = "ISBD";
const PLACES: &str = "POS";
/// Of a parameter, beside its value, since Copter 4.3.
const DEFAULT: &str = "Default";

/// Gives a log's messages one after the other.
pub(super) trait Messages {
    /// The next message and all that is defined; `None` at the end.
    fn next(&mut self) -> Result<Option<(Message<'_>, &Definitions)>, LogError>;

    /// All that is defined so far.
    fn definitions(&self) -> &Definitions;
}

/// What a walk met beside samples.
#[derive(Debug, Default)]
pub(super) struct Walked {
    pub identity: Identity,
    pub tally: Tally,
    pub clock: Clock,
    pub date: Date,
    /// messages dropped before they were written, as the log itself counts
    pub dropped: u64,
    /// messages of parameters that are withheld
    pub withheld: u64,
}

/// Gives each event with its place to `sink`; memory does not grow with the log.
pub(super) fn walk(messages: &mut impl Messages, sink: &mut Sink<'_>) -> Result<Walked, LogError> {
    let mut all_routes = AllRoutes::default();
    let mut walk = Walk {
        out: Outlet::new(sink),
        leap: None,
        values: Values::NONE,
        join: Join::default(),
        batches: Batches::default(),
        states: States::default(),
        began_s: None,
        armed_s: None,
        jumps: Jumps::default(),
        origin: None,
        rates_as_now: None,
        walked: Walked::default(),
    };
    walk.out.give(Event::Autopilot(Autopilot::ArduPilot));
    while let Some((message, definitions)) = messages.next()? {
        walk.take(&message, all_routes.of(&message, definitions));
        while walk.leap.as_ref().is_some_and(|(_, is_told)| *is_told) {
            walk.resolve(definitions, &mut all_routes);
        }
    }
    while walk.leap.is_some() {
        walk.resolve(messages.definitions(), &mut all_routes);
    }
    walk.finish();
    Ok(walk.walked)
}

struct Walk<'a, 'b> {
    out: Outlet<'a, 'b>,
    /// a stamp leapt: messages wait until it is told, as it is here, what that was
    leap: Option<(Leap<Kept>, bool)>,
    /// of the sample in hand
    values: Values,
    join: Join,
    batches: Batches,
    states: States,
    /// time of the first sample since the clock began, s: parameters may be of long before
    began_s: Option<f64>,
    /// time of the first arming since then, s
    armed_s: Option<f64>,
    jumps: Jumps,
    /// where on the earth positions are counted from
    origin: Option<Geodetic>,
    /// rates are in the units of now, as far as it is known
    rates_as_now: Option<bool>,
    walked: Walked,
}

impl Walk<'_, '_> {
    fn take(&mut self, message: &Message<'_>, routes: &mut Routes) {
        let stamp_s = routes.stamp_s(message);
        match &mut self.leap {
            Some((leap, is_told)) => *is_told |= leap.wait(stamp_s, Kept::of(message)),
            None => self.route(message, stamp_s, routes),
        }
    }

    /// Messages that waited do so no longer.
    fn resolve(&mut self, definitions: &Definitions, all_routes: &mut AllRoutes) {
        let messages = match self.leap.take().map(|(leap, _)| leap.resolve()) {
            Some(LeapCause::Passed(messages)) => {
                let first = messages.first().map(Kept::message);
                let stamp_s = first.and_then(|first| all_routes.of(&first, definitions).stamp_s(&first));
                stamp_s.into_iter().for_each(|stamp_s| self.walked.clock.leap(stamp_s));
                messages
            }
            Some(LeapCause::Damage(damaged, others)) => {
                self.walked.clock.damaged(damaged as u64);
                others
            }
            None => Vec::new(),
        };
        for kept in messages {
            let message = kept.message();
            self.take(&message, all_routes.of(&message, definitions));
        }
    }

    fn route(&mut self, message: &Message<'_>, stamp_s: Option<f64>, routes: &mut Routes) {
        self.out.at(message.offset);
        if message.definition.number == FMT && message.number(0) == f64::from(FMT) {
            self.walked.clock.definitions_anew();
        }
        let instance = routes.instance(message);
        let placed = stamp_s.map(|stamp_s| (stamp_s, self.walked.clock.place(stamp_s)));
        let own_s = match placed {
            Some((stamp_s, Placed::Leaps)) => {
                let leap = Leap::new(self.walked.clock.last_s(), stamp_s, Kept::of(message));
                self.leap = Some((leap, false));
                return;
            }
            Some((_, Placed::Stray)) => {
                self.walked.tally.count(message, instance, None, routes);
                return;
            }
            Some((_, Placed::At(time_s))) => Some(time_s),
            Some((stamp_s, Placed::Anew(time_s))) => {
                self.finish_samples();
                (self.states, self.began_s, self.armed_s) = (States::default(), None, None);
                self.jumps.clear();
                self.out.give(Event::ClockReset { time_s, stamp_s });
                Some(time_s)
            }
            None => None,
        };
        self.walked.tally.count(message, instance, stamp_s, routes);
        let time_s = own_s.unwrap_or_else(|| self.walked.clock.now_s());
        while let Some((topic, time_s, values)) = self.join.due(time_s) {
            self.out.values(topic, 0, time_s, &values);
        }
        for route in &routes.streams {
            self.sample(message, route, instance, own_s, time_s);
        }
        if let Some((special, fields)) = &routes.special {
            self.special(*special, message, fields, instance, time_s);
        }
        for (quantity, value) in self.states.due(time_s) {
            self.out.sample(*quantity, STATES, 0, time_s, &[*value]);
        }
    }

    fn sample(
        &mut self,
        message: &Message<'_>,
        route: &Route,
        instance: u8,
        own_s: Option<f64>,
        time_s: f64,
    ) {
        let topic = route.topic;
        let times = match topic.demands {
            Demand::Rates(_) if route.has_units => Some(1.0),
            Demand::Rates(before) => self.rates_as_now.map(|as_now| if as_now { 1.0 } else { before }),
            _ => Some(1.0),
        };
        route.values(message, times.unwrap_or(1.0), &mut self.values);
        // states are kept, and told again; yes and no are those of armed, or of in the air
        let states = match topic.quantity {
            Quantity::Armed => Some([0.0, 1.0]),
            Quantity::LandedState => Some([ON_GROUND, IN_AIR]),
            _ => None,
        };
        if let Some([no, yes]) = states {
            if let Some(value) = self.values.get().first() {
                let is_change = topic.message == CHANGES;
                self.state(topic.quantity, if *value > 0.5 { yes } else { no }, time_s, is_change);
            }
            return;
        }
        self.began_s.get_or_insert(time_s);
        // when a sample was taken is not to be guessed
        let Some(own_s) = own_s else {
            self.walked.tally.without_time += 1;
            self.walked.tally.outputs_without_time |= topic.quantity == Quantity::ActuatorCommand;
            return;
        };
        if times.is_none() {
            self.walked.tally.unknown_unit += 1;
            return;
        }
        let sampled = route.sampled.and_then(|field| self.walked.clock.beside(message.number(field) * 1e-6));
        let time_s = sampled.unwrap_or(own_s);
        let slot = match topic.part {
            None => {
                (topic.convert)(&mut self.values);
                self.out.values(topic, route.instance(instance), time_s, &self.values);
                return;
            }
            Some(Part::OfInstance) => usize::from(instance),
            Some(Part::Index(index) | Part::From(index)) => index,
        };
        if let Some((topic, time_s, values)) = self.join.take(topic, slot, time_s, self.values.get()) {
            self.out.values(topic, 0, time_s, &values);
        }
    }

    fn special(
        &mut self,
        special: Special,
        message: &Message<'_>,
        fields: &[usize],
        instance: u8,
        time_s: f64,
    ) {
        let number = |index: usize| fields.get(index).map_or(f64::NAN, |field| message.number(*field));
        let text =
            |index: usize| fields.get(index).map_or_else(Default::default, |field| message.text(*field));
        match special {
            Special::Parameter => {
                let default = message.definition.field(DEFAULT).map(|field| message.number(field));
                self.parameter(&text(0), number(1), default);
            }
            Special::Text => {
                let text = text(0);
                self.walked.identity.text(&text);
                if is_refusal_to_arm(&text) {
                    self.state(Quantity::Armed, 0.0, time_s, false);
                }
                self.out.give(Event::Text { time_s, severity: INFORMATION, text: &text });
            }
            Special::Event => match meaning(number(0)) {
                Some(Meaning::State(quantity, value)) => self.state(quantity, value, time_s, true),
                Some(Meaning::Jump) => self.out.give(Event::EstimatorReset { time_s }),
                None => {}
            },
            Special::Mode => {
                let by_name = || ARDUPILOT.modes.iter().find(|mode| mode.name.eq_ignore_ascii_case(&text(0)));
                let by_number = Some(number(0)).filter(|number| number.is_finite());
                let mode = by_number.or_else(|| by_name().map(|mode| f64::from(mode.number)));
                mode.into_iter().for_each(|mode| self.state(Quantity::Mode, mode, time_s, false));
            }
            Special::Error if number(1) != 0.0 => {
                let text = format!("error of subsystem {:.0}, code {:.0}", number(0), number(1));
                self.out.give(Event::Text { time_s, severity: ERROR, text: &text });
            }
            Special::Error => {}
            // of the first core, as the samples that are used
            Special::Jump if instance == 0 => {
                let jumped_s = self.jumps.take(message.definition.number, [number(0), number(1)], time_s);
                jumped_s.into_iter().for_each(|time_s| self.out.give(Event::EstimatorReset { time_s }));
            }
            Special::Jump => {}
            Special::Place => self.place([number(0), number(1)], number(2), time_s),
            Special::Date => self.walked.date.satellites(number(0), number(1), time_s),
            Special::Dropped => self.walked.dropped = self.walked.dropped.max(count(number(0))),
            Special::BatchHead => self.batches.head(message, fields),
            Special::BatchData => self.batch(message, fields),
        }
    }

    fn parameter(&mut self, name: &str, value: f64, default: Option<f64>) {
        if name.starts_with(SIMULATOR) {
            self.walked.withheld += 1;
            return;
        }
        let of_rates = RATES.iter().find(|(beginning, _)| name.starts_with(beginning));
        self.rates_as_now = of_rates.map(|(_, as_now)| *as_now).or(self.rates_as_now);
        self.walked.identity.parameter(name, value);
        if let Some(value) = default.filter(|default| default.is_finite()) {
            self.out.give(Event::ParameterDefault { name, value });
        }
        if value.is_finite() {
            self.out.give(Event::Parameter { name, value });
        }
    }

    /// Before the first `change` to a state the contrary held: what is disarmed was armed, and what took off stood on the
    /// ground from its arming on.
    fn state(&mut self, quantity: Quantity, value: f64, time_s: f64, change: bool) {
        // a vehicle that took off was armed, also where a log with a gap says last that it was not
        if change
            && (quantity, value) == (Quantity::LandedState, IN_AIR)
            && self.states.is(Quantity::Armed, 0.0)
        {
            self.state(Quantity::Armed, 1.0, time_s, false);
        }
        let is_first = self.states.set(quantity, value);
        let before = match (quantity, value) {
            (Quantity::Armed, 0.0) if change => Some((1.0, self.began_s)),
            (Quantity::LandedState, IN_AIR) if change => Some((ON_GROUND, self.armed_s.or(self.began_s))),
            _ => None,
        };
        // a log that begins with its states says nothing of before
        let since_s = |since_s: Option<f64>| since_s.filter(|since_s| *since_s < time_s);
        let before = before.and_then(|(contrary, since)| Some((contrary, since_s(since)?)));
        if let Some((contrary, since_s)) = before.filter(|_| is_first) {
            self.out.sample(quantity, STATES, 0, since_s, &[contrary]);
        }
        if quantity == Quantity::Armed && value > 0.5 {
            self.armed_s.get_or_insert(time_s);
        }
        self.out.sample(quantity, STATES, 0, time_s, &[value]);
    }

    /// Positions are counted from the first place.
    fn place(&mut self, [latitude_deg, longitude_deg]: [f64; 2], height_m: f64, time_s: f64) {
        let place = Geodetic { latitude_deg, longitude_deg };
        // before the first fix it is nowhere
        if latitude_deg == 0.0 && longitude_deg == 0.0 || !(latitude_deg + longitude_deg).is_finite() {
            return;
        }
        let [north_m, west_m] = place.north_west_m(self.origin.get_or_insert(place));
        self.out.sample(Quantity::Position, PLACES, 0, time_s, &[north_m, west_m, height_m]);
    }

    fn batch(&mut self, message: &Message<'_>, fields: &[usize]) {
        let Some(piece) = self.batches.piece(message, fields) else { return };
        for (index, sample) in piece.samples.iter().enumerate() {
            let stamp_s = piece.start_s + index as f64 * piece.step_s;
            if let Some(time_s) = self.walked.clock.beside(stamp_s) {
                self.out.sample(piece.quantity, BATCHES, piece.instance, time_s, sample);
            }
        }
    }

    fn finish_samples(&mut self) {
        for (topic, time_s, values) in self.join.finish() {
            self.out.values(topic, 0, time_s, &values);
        }
    }

    fn finish(&mut self) {
        self.finish_samples();
        let time_s = self.walked.clock.now_s();
        for (quantity, value) in self.states.due(f64::INFINITY) {
            self.out.sample(*quantity, STATES, 0, time_s, &[*value]);
        }
    }
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count; it saturates")]
fn count(number: f64) -> u64 {
    number as u64
}
