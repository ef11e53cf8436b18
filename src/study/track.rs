//! A parameter along the flights of a vehicle.

use crate::change::{Spread, pooled_mean, with_scatter};
use crate::diagnose::signatures::signature_of;
use crate::diagnose::{FlightParameter, LATENCY, Owner, called, turns_about_z};
use crate::estimate::{LARGEST_RELATIVE_STD, NAMES, THETA, UNITS};
use crate::physics::effects::ALL;
use crate::vehicle::Vehicle;

/// A flight carries a name from so many standard errors on: one that is there in all flights shows in nearly all of them, and
/// one that is in none shows by chance in one of 400.
pub(super) const CARRIES: f64 = 3.0;

/// A flight tells an effect from none where so many standard errors are below the effect's size.
const TELLS: f64 = 2.0;

/// Standard deviation of a moment of inertia between flights of one vehicle beside its error, share: the phase at which a log samples
/// its commands moves it. Measured on two autopilots in simulation: -12 to 2 % (ArduPilot), 0 to 3 % (PX4).
const INERTIA: Spread = Spread { relative: 0.05, absolute: 0.0 };
/// The same of an effect: laws are never quite those of the air, and flights differ in speed. A smaller one would
/// call a difference in speed a change of the vehicle; false changes are measured by `cargo bench --bench blind --
/// --vehicles --compared 40 --seed 9101`.
const EFFECT: Spread = Spread { relative: 0.12, absolute: 0.0 };
/// The same of a damping of the rotation, in its usual size (0.8 1/s of the moment of inertia) beside [`EFFECT`]: a time error of the
/// commands looks like damping. Between flights of unchanged vehicles in simulation, logged in different ways, it moved by up to 0.95 1/s
/// on PX4 and up to 2 1/s on ArduCopter.
const DAMPING: f64 = 1.0;
/// Standard deviation of that between flights that are logged in different ways, as a share of [`DAMPING`]: about a third of the largest
/// that was seen.
pub(super) const OF_LOG: f64 = 0.35;
/// The same of a latency between command and rotor: its error holds what is not known of it, and the phase at which a log samples commands
/// and motion, up to some ms, is beside it. Set by judgement.
const OF_LATENCY: Spread = Spread { relative: 0.12, absolute: 0.005 };
/// A shorter latency is determined if its error is less than this, s, whatever share of it that is.
const DETERMINED_S: f64 = 0.005;
/// Load and battery are the flight's own.
const OWN: Spread = Spread { relative: 0.0, absolute: 0.0 };

/// A parameter along the flights.
#[derive(Debug, Clone, PartialEq)]
pub struct Track {
    /// `mass`, `ixx` ... or `effect.parameter`
    pub name: String,
    /// SI
    pub unit: &'static str,
    /// the flight's own parameters are told and never a change
    pub owner: Owner,
    /// effect of which it is; `None`: of the rigid body
    pub effect: Option<&'static str>,
    /// of a wind: 0 to north, 1 to west, 2 up
    pub wind_axis: Option<usize>,
    /// value at which the effect is none; the largest of the flights where it is not the same in all of them
    pub nothing: f64,
    /// value and standard error of each flight; `None` where it does not determine it
    pub values: Vec<Option<(f64, f64)>>,
    /// part of each flight's error that goes the same way in every flight of the vehicle
    pub common_std: Vec<f64>,
    /// how it differs between flights of one vehicle beside its error
    pub spread: Spread,
}

impl Track {
    /// Whether flights tell it as a ratio to the rotors' torque per thrust.
    pub(super) fn turns_about_z(&self) -> bool {
        if self.effect.is_some() {
            turns_about_z(&self.name, self.unit)
        } else {
            self.name == NAMES[THETA - 1]
        }
    }

    /// The same on another scale.
    pub(super) fn scale(&mut self, factor: f64) {
        for (value, std) in self.values.iter_mut().flatten() {
            (*value, *std) = (*value * factor, *std * factor);
        }
        self.common_std.iter_mut().for_each(|std| *std *= factor);
    }

    /// A parameter along the flights of a table that was stored: values and common parts of their errors, flight by flight. `None` where
    /// no parameter here has that unit.
    #[must_use]
    pub fn stored(
        (name, unit): (&str, &str),
        (owner, effect): (Owner, Option<&str>),
        values: Vec<Option<(f64, f64)>>,
        common_std: Vec<f64>,
    ) -> Option<Self> {
        let known = effect.and_then(|id| ALL.iter().find(|effect| effect.id() == id));
        let of_effects = || ALL.iter().flat_map(|effect| effect.parameters()).map(|parameter| parameter.unit);
        let unit =
            UNITS.into_iter().chain(["s", "m/s^2"]).chain(of_effects()).find(|other| *other == unit)?;
        let spread = match (owner, effect) {
            (Owner::Flight, _) => OWN,
            (Owner::Vehicle, None) => INERTIA,
            (Owner::Vehicle, Some(_)) => EFFECT,
        };
        let effect = known.map(|effect| effect.id());
        let name = name.to_owned();
        Some(Self { name, unit, owner, effect, wind_axis: None, nothing: 0.0, values, common_std, spread })
    }

    fn new(parameter: &FlightParameter, flights: usize, vehicle: &Vehicle) -> Self {
        let spread = match (parameter.owner, parameter.effect) {
            (Owner::Flight, _) => OWN,
            (Owner::Vehicle, None) => INERTIA,
            (Owner::Vehicle, Some(_)) if parameter.name == LATENCY => OF_LATENCY,
            (Owner::Vehicle, Some(_)) => {
                Spread { absolute: DAMPING * usual_damping(parameter, vehicle), ..EFFECT }
            }
        };
        Self {
            name: parameter.name.clone(),
            unit: parameter.unit,
            owner: parameter.owner,
            effect: parameter.effect,
            wind_axis: parameter.wind_axis,
            nothing: parameter.nothing,
            values: vec![None; flights],
            common_std: vec![0.0; flights],
            spread,
        }
    }

    /// The flights' parameters by their names; `each` has those of one flight each, by its place.
    pub(super) fn all(
        each: Vec<(usize, Vec<FlightParameter>)>,
        flights: usize,
        vehicle: &Vehicle,
    ) -> Vec<Self> {
        let mut tracks: Vec<Self> = Vec::new();
        for (place, parameters) in each {
            for parameter in parameters {
                let known = tracks.iter().position(|track| track.name == parameter.name);
                let at = known.unwrap_or_else(|| {
                    tracks.push(Self::new(&parameter, flights, vehicle));
                    tracks.len() - 1
                });
                // how much latency is ordinary goes with the log
                tracks[at].nothing = tracks[at].nothing.max(parameter.nothing);
                tracks[at].values[place] = Some(parameter.estimate);
                tracks[at].common_std[place] = parameter.common_std;
            }
        }
        tracks
    }

    /// What it is, as people say it, without an article: `drag (dx)`, `moment of inertia ixx`.
    #[must_use]
    pub fn words(&self) -> String {
        if self.name == LATENCY {
            return "latency from command to rotor (lag and delay)".to_owned();
        }
        let Some(id) = self.effect else {
            let is_moment = self.name.starts_with('i');
            return if is_moment { format!("moment of inertia {}", self.name) } else { self.name.clone() };
        };
        let called = called(id);
        let noun = ["an ", "a "].iter().find_map(|article| called.strip_prefix(article)).unwrap_or(called);
        match self.name.split_once('.') {
            Some((_, parameter)) => format!("{noun} ({parameter})"),
            None => noun.to_owned(),
        }
    }

    /// Pooled mean of the flights' values, with its standard error; `None` where no flight has one.
    #[must_use]
    pub fn pooled(&self) -> Option<(f64, f64)> {
        pooled_mean(&self.values, &self.common_std)
    }

    /// Moves this share of what a flight's time errors do to it into the flights' errors, where it is no longer beside them.
    pub(super) fn move_spread_into_errors(&mut self, share: f64) {
        let moved = share * self.spread.absolute;
        self.spread.absolute *= (1.0 - share * share).sqrt();
        self.values.iter_mut().flatten().for_each(|(_, std)| *std = std.hypot(moved));
    }

    /// The value of one flight alone. The standard error of what the flights have in common is as their scatter leaves it. What is each
    /// flight's own differs in truth, and keeps its error.
    #[must_use]
    pub fn alone(&self, flight: usize) -> Option<(f64, f64)> {
        if self.owner == Owner::Flight {
            return self.values.get(flight).copied().flatten();
        }
        with_scatter(&self.values, &self.common_std).get(flight).copied().flatten()
    }

    /// The same with the values of these flights only.
    #[must_use]
    pub fn only(&self, flights: &[usize]) -> Self {
        let mut of = self.clone();
        let others = of.values.iter_mut().enumerate().filter(|(place, _)| !flights.contains(place));
        others.for_each(|(_, value)| *value = None);
        of
    }

    /// Whether the value of these flights is certainly another one than that of the others.
    #[must_use]
    pub(super) fn differs_from_others(&self, flights: &[usize]) -> bool {
        let others: Vec<usize> = (0..self.values.len()).filter(|flight| !flights.contains(flight)).collect();
        let (with, without) = (self.only(flights).pooled(), self.only(&others).pooled());
        with.zip(without)
            .is_some_and(|(with, without)| (with.0 - without.0).abs() > CARRIES * with.1.hypot(without.1))
    }

    /// How far a flight's value is from that of no effect, in its standard errors.
    #[must_use]
    pub fn strength(&self, flight: usize) -> f64 {
        let own = self.values.get(flight).copied().flatten();
        own.map_or(0.0, |(value, std)| self.beyond(value) / std.max(f64::MIN_POSITIVE))
    }

    /// Whether an estimate tells anything: that of a mass or a moment of inertia has an error well below it, and that of an effect which
    /// a flight shows would tell it from none. A hover does not determine moments of inertia, nor drag.
    #[must_use]
    pub fn is_determined(&self, (value, std): (f64, f64)) -> bool {
        if self.name == LATENCY {
            return std <= DETERMINED_S.max(LARGEST_RELATIVE_STD * value.abs());
        }
        if self.effect.is_none() {
            return std <= LARGEST_RELATIVE_STD * value.abs();
        }
        let shown = (0..self.values.len()).filter(|flight| self.is_shown_by(*flight));
        let sizes = shown.filter_map(|flight| Some((self.values[flight]?.0 - self.nothing).abs()));
        let is_told = |size: f64| TELLS * std <= size;
        self.owner == Owner::Flight || sizes.reduce(f64::max).is_none_or(is_told)
    }

    /// Whether a flight alone shows that the effect is there, by its own standard error: an effect that one of a few flights has makes
    /// them scatter, and the scatter would hide it in every one of them.
    #[must_use]
    pub fn is_shown_by(&self, flight: usize) -> bool {
        self.strength(flight) > CARRIES
    }

    /// Leaves out the values of flights that do not determine it: it did not change in them.
    pub(super) fn keep_determined(&mut self) {
        let all = self.clone();
        self.values.iter_mut().for_each(|of| *of = of.filter(|value| all.is_determined(*value)));
    }

    /// How far a value is from that of no effect. A latency is ordinary up to there.
    fn beyond(&self, value: f64) -> f64 {
        let by = value - self.nothing;
        if self.name == LATENCY { by } else { by.abs() }
    }
}

/// Usual size of a parameter that a time error of the commands moves; 0 of another.
fn usual_damping(parameter: &FlightParameter, vehicle: &Vehicle) -> f64 {
    let signature = parameter.effect.and_then(signature_of);
    let Some(signature) = signature.filter(|of| of.role.like_latency.is_some() && !of.role.of_air) else {
        return 0.0;
    };
    let own = parameter.name.strip_prefix(signature.id()).and_then(|name| name.strip_prefix('.'));
    own.and_then(|name| (signature.naming.usual)(name, vehicle)).unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::load_vehicle;
    use std::path::Path;

    fn vehicle() -> Vehicle {
        load_vehicle(&Path::new(env!("CARGO_MANIFEST_DIR")).join("configs/x500.toml")).unwrap()
    }

    #[test]
    fn a_damping_differs_between_flights_by_a_share_of_its_axis_inertia_and_a_drag_does_not() {
        let spread = |name: &str, effect: &'static str| {
            let parameter = FlightParameter {
                name: name.to_owned(),
                unit: "1",
                owner: Owner::Vehicle,
                effect: Some(effect),
                wind_axis: None,
                nothing: 0.0,
                estimate: (0.0, 1.0),
                common_std: 0.0,
            };
            Track::all(vec![(0, vec![parameter])], 1, &vehicle())[0].spread
        };
        let izz = vehicle().body.inertia_kg_m2[(2, 2)];
        assert!((spread("angular_damping.bz", "angular_damping").absolute - 0.8 * izz).abs() < 1e-12);
        assert_eq!(spread("linear_drag.dx", "linear_drag"), EFFECT);
    }

    fn track(owner: Owner, nothing: f64, values: &[(f64, f64)]) -> Track {
        let of = |(place, estimate): (usize, &(f64, f64))| {
            let parameter = FlightParameter {
                name: "one".to_owned(),
                unit: "1",
                owner,
                effect: None,
                wind_axis: None,
                nothing,
                estimate: *estimate,
                common_std: 0.0,
            };
            (place, vec![parameter])
        };
        let [track] = Track::all(values.iter().enumerate().map(of).collect(), values.len(), &vehicle())
            .try_into()
            .unwrap();
        track
    }

    #[test]
    fn what_is_each_flights_own_keeps_its_error_where_the_flights_differ() {
        let payloads = [(0.20, 0.002), (0.50, 0.003)];
        let own = track(Owner::Flight, 0.0, &payloads);
        assert_eq!([0, 1].map(|flight| own.alone(flight).unwrap()), payloads);
        let common = track(Owner::Vehicle, 0.0, &payloads);
        assert!((0..2).all(|flight| common.alone(flight).unwrap().1 > 10.0 * payloads[flight].1));
        assert_eq!(own.alone(2), None);
    }

    #[test]
    fn a_flight_that_would_not_tell_an_effect_from_none_does_not_determine_it() {
        let drag =
            Track { effect: Some("linear_drag"), ..track(Owner::Vehicle, 0.0, &[(0.30, 0.02), (0.20, 0.4)]) };
        assert!(
            drag.is_determined((0.30, 0.02))
                && drag.is_determined((0.0, 0.1))
                && !drag.is_determined((0.20, 0.4))
        );
        let mut kept = drag.clone();
        kept.keep_determined();
        assert_eq!(kept.values, [Some((0.30, 0.02)), None]);
        let inertia = track(Owner::Vehicle, 0.0, &[(0.02, 0.001), (0.02, 0.01)]);
        assert!(inertia.is_determined((0.02, 0.001)) && !inertia.is_determined((0.02, 0.01)));
        // a flight without wind says so
        let wind =
            Track { effect: Some("steady_wind"), ..track(Owner::Flight, 0.0, &[(3.0, 0.1), (0.1, 2.0)]) };
        assert!(wind.is_determined((0.1, 2.0)));
    }

    #[test]
    fn one_flight_of_two_or_three_shows_what_it_alone_has() {
        let (weak, whole) = ((0.9, 0.01), (1.0, 0.01));
        for flights in [&[whole, weak][..], &[whole, weak, whole]] {
            let rotor = track(Owner::Vehicle, 1.0, flights);
            let shown: Vec<usize> = (0..flights.len()).filter(|flight| rotor.is_shown_by(*flight)).collect();
            assert_eq!(shown, [1]);
        }
        // less latency than is ordinary is no lag
        let of = |value| Track { name: LATENCY.to_owned(), ..track(Owner::Vehicle, 0.02, &[(value, 0.003)]) };
        assert!(of(0.03).is_shown_by(0) && !of(0.005).is_shown_by(0));
    }
}
