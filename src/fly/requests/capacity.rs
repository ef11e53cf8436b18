//! Capacity of a link, and the rate that an autopilot gives for a requested one.

use super::StreamRequest;
use crate::autopilot::Autopilot;

/// Share of the setpoints, at 50 Hz, of a radio that transmits both directions in turn, bytes/s.
const SETPOINTS_BYTES_S: f64 = 50.0 * 65.0;
/// Largest share of a link's capacity that is used. The rest is for our own messages; a full link delays them.
const FILL: f64 = 0.9;
/// Bits that a byte takes on a serial line: one start bit, eight of data, one stop bit.
const BITS_PER_BYTE: f64 = 10.0;
/// Share of a serial line that PX4 uses for its messages.
const PX4_SHARE: f64 = 0.5;
/// Default limit of PX4 for a UDP link, bytes/s.
const PX4_UDP_BYTES_S: f64 = 100_000.0;

/// The kind of link between vehicle and ground station.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LinkKind {
    /// network, or USB whose baud rate means nothing
    Wide,
    /// a serial line or radio of so many bits a second
    Serial {
        /// bits a second
        baud: f64,
    },
}

/// Bytes a second that a link has for the vehicle's messages.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Capacity {
    /// bytes a second; infinite where nothing limits them
    pub bytes_s: f64,
}

impl Capacity {
    /// Of a link to an autopilot.
    #[must_use]
    pub fn new(link: LinkKind, autopilot: Autopilot) -> Self {
        let bytes_s = match (link, autopilot) {
            (LinkKind::Serial { baud }, Autopilot::Px4) => baud / BITS_PER_BYTE * PX4_SHARE,
            (LinkKind::Serial { baud }, _) => (baud / BITS_PER_BYTE - SETPOINTS_BYTES_S).max(0.0),
            (LinkKind::Wide, Autopilot::Px4) => PX4_UDP_BYTES_S,
            (LinkKind::Wide, _) => f64::INFINITY,
        };
        Self { bytes_s }
    }

    /// Whether a set of messages fits.
    #[must_use]
    pub fn fits(&self, set: &[StreamRequest]) -> bool {
        bytes_s(set) <= FILL * self.bytes_s
    }
}

/// Bytes a second of a set, without what is asked for only instead of something else.
#[must_use]
pub(super) fn bytes_s(set: &[StreamRequest]) -> f64 {
    set.iter()
        .filter(|stream| stream.instead_of.is_none())
        .map(|stream| stream.rate_hz * stream.frame_bytes)
        .sum()
}

/// The rate that an autopilot gives for a requested one, Hz; `None` if it refuses. ArduPilot uses whole milliseconds
/// and nothing faster than 0.8 of its 400 Hz loop. PX4 sends from a loop of 4 ms, so no stream is faster than 250 Hz.
#[must_use]
pub fn granted_hz(autopilot: Autopilot, asked_hz: f64) -> Option<f64> {
    if asked_hz.is_nan() || asked_hz <= 0.0 {
        return None;
    }
    match autopilot {
        Autopilot::ArduPilot => {
            let milliseconds = (1000.0 / asked_hz).floor().max(1.0);
            (asked_hz < 320.0).then_some(1000.0 / milliseconds)
        }
        Autopilot::Px4 => Some(asked_hz.min(250.0)),
        Autopilot::Other | Autopilot::Unknown => Some(asked_hz),
    }
}

#[cfg(test)]
mod tests {
    use super::super::{request_set, slow_request_set};
    use super::*;

    #[test]
    fn the_whole_set_needs_a_wide_link_and_the_slow_one_fits_a_radio() {
        for autopilot in [Autopilot::Px4, Autopilot::ArduPilot] {
            let whole = request_set(autopilot);
            let radio = Capacity::new(LinkKind::Serial { baud: 57_600.0 }, autopilot);
            assert!(!radio.fits(&whole));
            assert!(radio.fits(&slow_request_set(autopilot)), "{}", bytes_s(&slow_request_set(autopilot)));
            assert!(Capacity::new(LinkKind::Serial { baud: 921_600.0 }, autopilot).fits(&whole));
            assert!(Capacity::new(LinkKind::Wide, autopilot).fits(&whole));
        }
    }

    #[test]
    fn rates_are_those_that_were_seen() {
        let near = |granted: Option<f64>, seen: f64| (granted.unwrap() - seen).abs() < 0.02 * seen;
        assert!(near(granted_hz(Autopilot::ArduPilot, 100.0), 100.0));
        assert!(near(granted_hz(Autopilot::ArduPilot, 200.0), 198.0));
        assert_eq!(granted_hz(Autopilot::ArduPilot, 400.0), None);
        assert!(near(granted_hz(Autopilot::Px4, 100.0), 99.3));
        assert!(near(granted_hz(Autopilot::Px4, 400.0), 248.0));
        assert_eq!(granted_hz(Autopilot::Px4, f64::NAN), None);
    }
}
