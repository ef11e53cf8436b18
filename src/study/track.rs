//! A parameter along the flights of a vehicle.

use crate::change::{Spread, pooled_mean, with_scatter};
use crate::diagnose::{FlightParameter, Owner};
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
    /// value at which the effect is none
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

    /// The value of one flight alone, with its standard error as the scatter of all flights leaves it.
    #[must_use]
    pub fn alone(&self, flight: usize) -> Option<(f64, f64)> {
        with_scatter(&self.values, &self.common_std).get(flight).copied().flatten()
    }

    /// Whether a flight alone shows that the effect is there.
    #[must_use]
    pub fn is_shown_by(&self, flight: usize) -> bool {
        self.alone(flight).is_some_and(|(value, std)| (value - self.nothing).abs() > CARRIES * std)
    }
}
