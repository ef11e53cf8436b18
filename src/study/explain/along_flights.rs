//! What several flights have in common, and what is each one's own.

use crate::diagnose::signature::Signature;
use crate::diagnose::signatures::signature_of;
use crate::diagnose::{Named, Need, Owner};
use crate::estimate::NAMES;
use crate::study::Track;
use crate::study::track::CARRIES;

/// What several flights have in common, and what is each one's own.
#[derive(Debug, Clone, PartialEq)]
pub struct AlongFlights {
    /// each parameter along the flights
    pub tracks: Vec<Track>,
    /// steady wind of each flight, north and west, m/s, taken out before the flights were explained together; `None` where it shows none
    pub winds_m_s: Vec<Option<[f64; 2]>>,
    /// flights that each show a named effect alone, by its identifier; `None` where it is fitted to all flights together only
    pub carried_by: Vec<(&'static str, Option<Vec<usize>>)>,
    /// named effects that differ between the flights, with the flights that the answer's sizes are of
    pub sized_by: Vec<(&'static str, Vec<usize>)>,
    /// names that a flight has alone and the flights together have not: what a flight is loaded with, or a rotor
    pub of_one_flight: Vec<(usize, Named)>,
    /// what each flight shows alone; empty where nothing tells the flights apart
    pub alone: Vec<Vec<Named>>,
}

impl AlongFlights {
    /// Parameters that all flights have in common.
    pub fn common(&self) -> impl Iterator<Item = &Track> {
        self.tracks.iter().filter(|track| track.owner == Owner::Vehicle)
    }

    /// The value of a parameter in the answer and in the model, with its standard error: of all flights together, or of those that its
    /// effect's size is of. `None` for what each flight has its own.
    #[must_use]
    pub fn together(&self, track: &Track) -> Option<(f64, f64)> {
        let own = track.owner == Owner::Flight;
        let pooled =
            || self.sizing(track).map_or_else(|| track.pooled(), |flights| track.only(flights).pooled());
        if own { None } else { pooled() }
    }

    /// The value of one flight alone. Where an effect differs between the flights, their scatter is no error.
    #[must_use]
    pub fn alone(&self, track: &Track, flight: usize) -> Option<(f64, f64)> {
        match self.sizing(track) {
            Some(_) => track.values.get(flight).copied().flatten(),
            None => track.alone(flight),
        }
    }

    /// The flight which alone of several has an effect that a vehicle may have in one flight and not in the others: a load, a rotor that is
    /// weak, what follows the battery.
    #[must_use]
    pub fn flight_with_alone(&self, id: &str) -> Option<usize> {
        let of_one = || signature_of(id).is_some_and(is_of_one_flight);
        let (_, carriers) = self.carried_by.iter().find(|(of, _)| *of == id)?;
        let carriers = carriers.as_deref()?;
        let [flight] = carriers else { return None };
        let mut own = self.tracks.iter().filter(|track| track.effect == Some(id));
        (of_one() && own.any(|track| track.differs_from_others(carriers))).then_some(*flight)
    }

    /// Whether a flight, fitted with the effects that were found, has the moments of inertia of the first one within their errors.
    pub(super) fn has_inertia_of_first(&self, flight: usize) -> bool {
        let mut moments = self
            .tracks
            .iter()
            .filter(|track| {
                track.effect.is_none() && [1, 4, 6].iter().any(|index| track.name == NAMES[*index])
            })
            .peekable();
        let is_alike = |track: &Track| {
            let of = |flight: usize| track.values.get(flight).copied().flatten();
            of(0)
                .zip(of(flight))
                .is_some_and(|(first, own)| (own.0 - first.0).abs() <= CARRIES * own.1.hypot(first.1))
        };
        moments.peek().is_some() && moments.all(is_alike)
    }

    /// The flights that the size of a parameter's effect is of, where it differs between them.
    fn sizing(&self, track: &Track) -> Option<&[usize]> {
        let of = self.sized_by.iter().find(|(id, _)| track.effect == Some(id));
        of.map(|(_, flights)| flights.as_slice())
    }
}

/// Whether one flight of a vehicle may have an effect and the others not. What acts on the vehicle in every flight is told by all of them
/// together, and a substitute of it that one flight has alone is no name.
pub(super) fn is_of_one_flight(signature: &Signature) -> bool {
    let role = &signature.role;
    let by_voltage = signature.needs.contains(&Need::Voltage);
    by_voltage || role.moment.is_some() || role.hangs_below || role.of_the_loading || role.which.is_some()
}
