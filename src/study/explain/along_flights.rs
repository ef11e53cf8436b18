//! What several flights have in common, and what is each one's own.

use crate::diagnose::{Named, Owner};
use crate::study::Track;

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
}

impl AlongFlights {
    /// Parameters that all flights have in common.
    pub fn common(&self) -> impl Iterator<Item = &Track> {
        self.tracks.iter().filter(|track| track.owner == Owner::Vehicle)
    }
}
