//! One pass over a log: what is moved, emptied and left out.

use super::names::Coordinate;
use super::texts::{self, Part};
use std::collections::BTreeMap;

/// Where the flight is moved to, degrees: beside the point without a position, where a degree of longitude is as long as one of
/// latitude.
const TO_DEG: f64 = 0.01;

/// What a pass did.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Tally {
    /// messages that stay
    pub kept: u64,
    /// coordinates that were moved
    pub moved: u64,
    /// values of serial numbers, hardware identifiers, keys and parameters of positions that were emptied: those of a field count once
    /// for each message
    pub emptied: u64,
    /// messages that were left out, because what they hold is not known or cannot be moved
    pub left_out: u64,
    /// bytes that are no message
    pub unread_bytes: u64,
}

/// How often each of several things occurred, by their names in the log.
pub type Counts = BTreeMap<String, u64>;

/// A pass with the origin of the positions.
#[derive(Debug, Default)]
pub(super) struct Pass {
    /// degrees; the first position of the log
    pub(super) origin_deg: Option<[f64; 2]>,
    pub(super) tally: Tally,
    /// values that were emptied, by field or parameter
    pub(super) emptied: Counts,
    /// messages that were left out, by their names
    pub(super) left_out: Counts,
    latitude_deg: Option<f64>,
}

impl Pass {
    /// A pass that moves what is at this origin.
    pub(super) fn from(origin_deg: Option<[f64; 2]>) -> Self {
        Self { origin_deg, ..Self::default() }
    }

    /// The same flight over the ground, in metres, elsewhere. Zero and what is no coordinate stay as they are.
    pub(super) fn moved(&mut self, coordinate: Coordinate, deg: f64) -> f64 {
        if deg == 0.0 || !deg.is_finite() || deg.abs() > 180.0 {
            return deg;
        }
        self.note(coordinate, deg);
        self.tally.moved += 1;
        let Some([latitude, longitude]) = self.origin_deg else { return 0.0 };
        match coordinate {
            Coordinate::Latitude => deg - latitude + TO_DEG,
            Coordinate::Longitude => {
                let apart = (deg - longitude + 540.0).rem_euclid(360.0) - 180.0;
                apart * latitude.to_radians().cos() + TO_DEG
            }
        }
    }

    /// The same of 1e-7 degrees.
    #[expect(clippy::cast_possible_truncation, reason = "180e7 fits")]
    pub(super) fn moved_e7(&mut self, coordinate: Coordinate, value: i32) -> i32 {
        let moved = self.moved(coordinate, 1e-7 * f64::from(value));
        if value == 0 || f64::from(value).abs() > 180e7 { value } else { (1e7 * moved).round() as i32 }
    }

    /// The first latitude with the longitude that follows is the origin, where it is still looked for.
    fn note(&mut self, coordinate: Coordinate, deg: f64) {
        match (self.origin_deg, coordinate, self.latitude_deg) {
            (None, Coordinate::Latitude, _) => self.latitude_deg = Some(deg),
            (None, Coordinate::Longitude, Some(latitude)) => self.origin_deg = Some([latitude, deg]),
            _ => {}
        }
    }

    /// Empties bytes that tell hardware or hold a key: those of a field or a parameter of this name.
    pub(super) fn empty(&mut self, name: impl FnOnce() -> String, bytes: &mut [u8]) {
        if bytes.iter().any(|byte| *byte != 0) {
            self.tally.emptied += 1;
            *self.emptied.entry(name()).or_default() += 1;
            bytes.fill(0);
        }
    }

    /// Covers in a text what may tell hardware, a key or a place: that of a field of this name.
    pub(super) fn cover(&mut self, name: impl FnOnce() -> String, text: &mut [u8], part: Part) {
        if texts::cover(text, part) {
            self.tally.emptied += 1;
            *self.emptied.entry(name()).or_default() += 1;
        }
    }

    /// A message of this name is left out.
    pub(super) fn leave_out(&mut self, name: String) {
        self.tally.left_out += 1;
        *self.left_out.entry(name).or_default() += 1;
    }

    /// Moves a coordinate that stands in bytes, little-endian: `i32` in 1e-7 degrees, `f32` and `f64` in degrees.
    pub(super) fn move_in(&mut self, (coordinate, kind): (Coordinate, Kind), name: &str, bytes: &mut [u8]) {
        match (kind, bytes.len()) {
            (Kind::E7, 4) => {
                if let Ok(raw) = <[u8; 4]>::try_from(&*bytes) {
                    let moved = self.moved_e7(coordinate, i32::from_le_bytes(raw));
                    bytes.copy_from_slice(&moved.to_le_bytes());
                }
            }
            (Kind::Degrees, 4) => {
                if let Ok(raw) = <[u8; 4]>::try_from(&*bytes) {
                    #[expect(clippy::cast_possible_truncation, reason = "as the field is")]
                    let moved = self.moved(coordinate, f64::from(f32::from_le_bytes(raw))) as f32;
                    bytes.copy_from_slice(&moved.to_le_bytes());
                }
            }
            (Kind::Degrees, 8) => {
                if let Ok(raw) = <[u8; 8]>::try_from(&*bytes) {
                    let moved = self.moved(coordinate, f64::from_le_bytes(raw));
                    bytes.copy_from_slice(&moved.to_le_bytes());
                }
            }
            _ => self.empty(|| name.to_owned(), bytes),
        }
    }
}

/// How a coordinate is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// 1e-7 degrees
    E7,
    /// degrees
    Degrees,
}

/// Where the flight is after it was moved, degrees.
pub(super) fn is_moved(origin_deg: [f64; 2]) -> bool {
    // the first one may be any message's: home and vehicle can be some kilometres apart
    origin_deg.iter().all(|deg| (deg - TO_DEG).abs() < 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flight_keeps_its_metres() {
        let mut pass = Pass::from(Some([60.0, 10.0]));
        // 100 m to the north and 100 m to the east at 60 degrees
        let north = pass.moved(Coordinate::Latitude, 60.0 + 100.0 / 111_195.0);
        let east = pass.moved(Coordinate::Longitude, 10.0 + 100.0 / (111_195.0 * 0.5));
        assert!(((north - TO_DEG) * 111_195.0 - 100.0).abs() < 1e-6, "{north}");
        assert!(((east - TO_DEG) * 111_195.0 - 100.0).abs() < 1e-6, "{east}");
        // no position stays none
        assert_eq!(pass.moved_e7(Coordinate::Latitude, 0), 0);
        assert_eq!(pass.moved_e7(Coordinate::Latitude, i32::MAX), i32::MAX);
        // over the date line
        let mut pass = Pass::from(Some([0.0, 179.999]));
        assert!((pass.moved(Coordinate::Longitude, -179.999) - TO_DEG - 0.002).abs() < 1e-9);
    }
}
