//! A parameter along the flights of a vehicle.

use crate::change::{Spread, pooled_mean, with_scatter};
use crate::diagnose::{FlightParameter, LATENCY, Owner};
use crate::estimate::UNITS;
use crate::physics::effects::ALL;

/// A flight carries a name from so many standard errors on: one that is there in all flights shows in nearly all of them, and
/// one that is in none shows by chance in one of 400.
const CARRIES: f64 = 3.0;

/// Standard deviation of a moment of inertia between flights of one vehicle beside its error, share: the phase at which a log samples
/// its commands moves it. Measured on two autopilots in simulation: -12 to 2 % (ArduPilot), 0 to 3 % (PX4).
const INERTIA: Spread = Spread { relative: 0.05, absolute: 0.0 };
/// The same of an effect: laws are never quite those of the air, and flights differ in speed. A smaller one would
/// call a difference in speed a change of the vehicle; false changes are measured by `cargo bench --bench blind --
/// --vehicles --compared 40 --seed 9101`.
const EFFECT: Spread = Spread { relative: 0.12, absolute: 0.0 };
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

    fn new(parameter: &FlightParameter, flights: usize) -> Self {
        let spread = match (parameter.owner, parameter.effect) {
            (Owner::Flight, _) => OWN,
            (Owner::Vehicle, None) => INERTIA,
            (Owner::Vehicle, Some(_)) => EFFECT,
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
    pub(super) fn all(each: Vec<(usize, Vec<FlightParameter>)>, flights: usize) -> Vec<Self> {
        let mut tracks: Vec<Self> = Vec::new();
        for (place, parameters) in each {
            for parameter in parameters {
                let known = tracks.iter().position(|track| track.name == parameter.name);
                let at = known.unwrap_or_else(|| {
                    tracks.push(Self::new(&parameter, flights));
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

    /// Pooled mean of the flights' values, with its standard error; `None` where no flight has one.
    #[must_use]
    pub fn pooled(&self) -> Option<(f64, f64)> {
        pooled_mean(&self.values, &self.common_std)
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

    /// Whether a flight alone shows that the effect is there, by its own standard error: an effect that one of a few flights has makes
    /// them scatter, and the scatter would hide it in every one of them.
    #[must_use]
    pub fn is_shown_by(&self, flight: usize) -> bool {
        let own = self.values.get(flight).copied().flatten();
        own.is_some_and(|(value, std)| self.beyond(value) > CARRIES * std)
    }

    /// How far a value is from that of no effect. A latency is ordinary up to there.
    fn beyond(&self, value: f64) -> f64 {
        let by = value - self.nothing;
        if self.name == LATENCY { by } else { by.abs() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
        let [track] =
            Track::all(values.iter().enumerate().map(of).collect(), values.len()).try_into().unwrap();
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
