//! The vehicles on the link, and the choice of the one to fly.

use crate::wire::heartbeat::{ARMED, BASE_MODE_AT, TYPE_AT};
use std::time::Duration;

use super::target::Target;
use crate::autopilot::{Stack, is_multirotor};
use crate::wire::{self, Frame, Record, SystemId};

/// Time for which others are awaited after the first vehicle: each sends a HEARTBEAT a second.
const SETTLE: Duration = Duration::from_millis(2500);
/// Time for which a requested vehicle is awaited after another one was heard.
const NAMED_WITHIN: Duration = Duration::from_secs(10);

/// A vehicle that was heard.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Listed {
    /// the vehicle
    pub vehicle: wire::Vehicle,
    mav_type: u8,
    armed: bool,
}

/// The choice of a vehicle.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Choice {
    /// not yet known
    Wait,
    /// this one, by these rules
    Vehicle(wire::Vehicle, Target, &'static Stack),
    /// none, with the reason
    Refuse(String),
}

/// All vehicles heard.
#[derive(Debug, Default)]
pub struct Roster {
    listed: Vec<Listed>,
    first: Option<Duration>,
}

impl Roster {
    /// Takes a frame.
    pub fn hear(&mut self, now: Duration, frame: Frame<'_>) {
        let record = Record { stamp_us: 0, offset: 0, known: true, frame };
        let Some(vehicle) = wire::Vehicle::from_heartbeat(&record) else { return };
        let payload = frame.payload();
        let listed =
            Listed { vehicle, mav_type: payload.u8(TYPE_AT), armed: payload.u8(BASE_MODE_AT) & ARMED != 0 };
        self.first.get_or_insert(now);
        match self.listed.iter_mut().find(|other| other.vehicle.system == vehicle.system) {
            Some(other) => *other = listed,
            None => self.listed.push(listed),
        }
    }

    /// The vehicle of this system id, or the only one.
    #[must_use]
    pub fn choose(&self, now: Duration, system: Option<SystemId>) -> Choice {
        if let Some(system) = system {
            return match self.listed.iter().find(|listed| listed.vehicle.system == system) {
                Some(listed) => admit(listed),
                None if self.others_for(now) > NAMED_WITHIN => Choice::Refuse(format!(
                    "expected a HEARTBEAT of system {system} within {} s, heard {}",
                    NAMED_WITHIN.as_secs(),
                    self.heard()
                )),
                None => Choice::Wait,
            };
        }
        if self.first.is_none_or(|first| now.saturating_sub(first) < SETTLE) {
            return Choice::Wait;
        }
        match self.listed.as_slice() {
            [] => Choice::Wait,
            [only] => admit(only),
            several => {
                let ids: Vec<String> =
                    several.iter().map(|listed| listed.vehicle.system.to_string()).collect();
                Choice::Refuse(format!(
                    "expected one vehicle, heard systems {}; name the one to fly (--system-id)",
                    ids.join(", ")
                ))
            }
        }
    }

    /// Time for which any vehicle has been heard.
    fn others_for(&self, now: Duration) -> Duration {
        self.first.map_or(Duration::ZERO, |first| now.saturating_sub(first))
    }

    /// The heard vehicles, in words, if the one of this system id is not heard for some time.
    #[must_use]
    pub fn without(&self, now: Duration, system: SystemId) -> Option<String> {
        let named = self.listed.iter().any(|listed| listed.vehicle.system == system);
        (!named && self.others_for(now) >= SETTLE).then(|| self.heard())
    }

    /// The heard vehicles, in words.
    #[must_use]
    pub fn heard(&self) -> String {
        match self.listed.as_slice() {
            [] => "no vehicle".to_owned(),
            listed => {
                let ids: Vec<String> =
                    listed.iter().map(|listed| format!("system {}", listed.vehicle.system)).collect();
                ids.join(", ")
            }
        }
    }
}

fn admit(listed: &Listed) -> Choice {
    let vehicle = listed.vehicle;
    let system = vehicle.system;
    let Some(stack) = vehicle.autopilot.stack() else {
        return Choice::Refuse(format!("system {system}: expected PX4 or ArduPilot, got another autopilot"));
    };
    let Some(target) = Target::new(system, vehicle.component) else {
        return Choice::Refuse(format!("expected a system id of 1 to 255, got {system}"));
    };
    if !is_multirotor(listed.mav_type) {
        let kind = listed.mav_type;
        return Choice::Refuse(format!(
            "system {system}: expected a multirotor, got a vehicle of type {kind}"
        ));
    }
    if listed.armed {
        return Choice::Refuse(format!(
            "system {system} is armed already; expected it on the ground, disarmed: land and disarm it, by the transmitter or \
             with another ground station, then give the same command again"
        ));
    }
    Choice::Vehicle(vehicle, target, stack)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::autopilot::PX4;
    use crate::wire::{CrcSeeds, checksum};

    /// A HEARTBEAT: who, MAV_TYPE, MAV_AUTOPILOT, base mode.
    fn heartbeat(system: u8, mav_type: u8, autopilot: u8, base_mode: u8) -> Vec<u8> {
        let mut frame = vec![0xFD, 9, 0, 0, 0, system, 1, 0, 0, 0];
        frame.extend([0, 0, 0, 0, mav_type, autopilot, base_mode, 3, 3]);
        let sum = checksum(&frame[1..], CrcSeeds::new().get(0).unwrap());
        frame.extend(sum.to_le_bytes());
        frame
    }

    fn choice(frames: &[Vec<u8>], system: Option<u32>) -> Choice {
        let mut roster = Roster::default();
        for frame in frames {
            roster.hear(Duration::ZERO, Frame::at_start(frame).unwrap());
        }
        roster.choose(Duration::from_secs(3), system.map(SystemId))
    }

    fn refused(frames: &[Vec<u8>]) -> String {
        match choice(frames, None) {
            Choice::Refuse(why) => why,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn the_only_vehicle_is_flown_and_ground_stations_are_none() {
        let frames = [heartbeat(255, 6, 8, 0), heartbeat(7, 2, 12, 0)];
        let Choice::Vehicle(_, target, stack) = choice(&frames, None) else { panic!() };
        assert_eq!((target.system, stack), (SystemId(7), &PX4));
    }

    #[test]
    fn among_several_one_must_be_named() {
        let frames = [heartbeat(1, 2, 3, 0), heartbeat(2, 2, 3, 0)];
        assert!(refused(&frames).contains("systems 1, 2"));
        assert!(
            matches!(choice(&frames, Some(2)), Choice::Vehicle(_, target, _) if target.system == SystemId(2))
        );
        assert_eq!(choice(&frames, Some(3)), Choice::Wait);
    }

    #[test]
    fn one_that_nobody_is_is_not_waited_for_for_ever() {
        let mut roster = Roster::default();
        let frame = heartbeat(1, 2, 3, 0);
        roster.hear(Duration::from_secs(5), Frame::at_start(&frame).unwrap());
        let named = |seconds| roster.choose(Duration::from_secs(seconds), Some(SystemId(9)));
        assert_eq!(named(14), Choice::Wait);
        let Choice::Refuse(why) = named(16) else { panic!() };
        assert!(why.contains("system 9 within 10 s, heard system 1"), "{why}");
        assert_eq!(roster.without(Duration::from_secs(6), SystemId(9)), None);
        assert_eq!(roster.without(Duration::from_secs(8), SystemId(9)).as_deref(), Some("system 1"));
        assert_eq!(roster.without(Duration::from_secs(8), SystemId(1)), None);
    }

    #[test]
    fn a_vehicle_that_cannot_be_flown_is_refused() {
        for (frame, why) in [
            (heartbeat(1, 1, 12, 0), "multirotor"),
            (heartbeat(1, 2, 12, 128), "armed already"),
            (heartbeat(1, 2, 18, 0), "PX4 or ArduPilot"),
        ] {
            let refusal = refused(&[frame]);
            assert!(refusal.contains(why), "{refusal}");
        }
    }

    #[test]
    fn a_second_vehicle_is_waited_for() {
        let mut roster = Roster::default();
        let frame = heartbeat(1, 2, 12, 0);
        roster.hear(Duration::from_secs(9), Frame::at_start(&frame).unwrap());
        assert_eq!(roster.choose(Duration::from_secs(10), None), Choice::Wait);
    }
}
