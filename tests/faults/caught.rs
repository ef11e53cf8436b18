//! Each law catches what breaks it: made-up flights.

use std::time::Duration;

use mavid::fly::{Cause, Ending, FlightStatistics, Level, Note, Outcome};
use mavid::sitl::Beheld;

use crate::harness::laws::{Law, check};
use crate::harness::ours::Given;
use crate::harness::trace::{Observation, Part, Report, Trace};
use crate::harness::wire::{Left, SetpointSeen};

const GUIDED: u32 = 4;
const LOITER: u32 = 5;
const LAND: u32 = 9;
const BRAKE: u32 = 17;
const GIVEN: Given = Given { px4: false, room_m: [2.0, 2.0, 1.5, 4.0], here: false };

fn ms(value: u64) -> Duration {
    Duration::from_millis(value)
}

/// A made-up flight: what is seen at which ms.
#[derive(Default)]
struct Made(Trace);

impl Made {
    fn at(mut self, at: u64, seen: Observation) -> Self {
        self.0.add(ms(at), seen);
        self
    }

    fn vehicle(self, at: u64, mode: u32, armed: bool) -> Self {
        self.at(at, Observation::Vehicle(Beheld { custom_mode: mode, armed, landed: !armed }))
    }

    /// A report that the vehicle sends, and that is read at once.
    fn report(self, at: u64, mode: u32) -> Self {
        let report = Report { mode, armed: Some(true), said: Some(ms(at)) };
        self.at(at, Observation::Came)
            .at(at, Observation::Reached(report))
            .at(at, Observation::Heard(report, ms(at)))
    }

    fn setpoint(self, at: u64, made: u64, position_m: [f64; 3]) -> Self {
        let setpoint = SetpointSeen { made: ms(made), position_m, velocity_m_s: [0.0; 3] };
        self.at(at, Observation::Left(Left::Setpoint(setpoint)))
    }

    fn says(self, at: u64, kind: &'static str, text: &str) -> Self {
        self.at(at, Observation::Note(Note::new(ms(at), Level::Error, kind, text)))
    }

    fn left(self, at: u64, left: Left) -> Self {
        self.at(at, Observation::Left(left))
    }

    fn over(self, at: u64, ending: Ending) -> Self {
        let outcome = Outcome { cause: None, ending, flown: FlightStatistics::default(), losses: Vec::new() };
        self.at(at, Observation::Over(outcome))
    }

    fn breaks(&self) -> Vec<Law> {
        check(&self.0, &GIVEN).into_iter().map(|broken| broken.law).collect()
    }
}

/// In the air in our mode, with a setpoint inside the room.
fn flying() -> Made {
    Made::default()
        .vehicle(0, GUIDED, true)
        .report(1000, GUIDED)
        .setpoint(1000, 1000, [0.0, 0.0, 2.0])
        .report(1200, GUIDED)
}

/// From there: down, by our order.
fn landed(made: Made, from: u64) -> Made {
    made.says(from, "phase", "land")
        .report(from + 100, GUIDED)
        .left(from + 100, Left::Mode(LAND))
        .vehicle(from + 200, LAND, true)
        .report(from + 200, LAND)
        .vehicle(from + 9000, LAND, false)
        .over(from + 9100, Ending::Landed)
}

#[test]
fn a_flight_that_keeps_the_laws_is_clean() {
    assert_eq!(landed(flying(), 2000).breaks(), []);
}

#[test]
fn a_command_or_a_setpoint_after_a_takeover_is_caught() {
    let taken = |made: Made| made.vehicle(1500, LOITER, true).report(1600, LOITER);
    let over = |made: Made| made.over(9000, Ending::InTheAir("LOITER".into()));
    assert_eq!(over(taken(flying())).breaks(), []);
    let setpoint = taken(flying()).setpoint(1900, 1900, [0.0, 0.0, 2.0]);
    assert_eq!(over(setpoint).breaks(), [Law::Takeover]);
    // also once it shows our mode again
    let again = taken(flying())
        .vehicle(2000, GUIDED, true)
        .report(2000, GUIDED)
        .says(2050, "phase", "hold")
        .report(2200, GUIDED)
        .left(2200, Left::Mode(BRAKE));
    assert!(over(again).breaks().contains(&Law::Takeover));
    // a pilot who goes back from where we sent it
    let back = landed(flying(), 2000).0;
    let until = back.entries.iter().position(|entry| entry.at > ms(2500)).unwrap();
    let mut made = Made(Trace { entries: back.entries[..until].to_vec() });
    made =
        made.vehicle(3000, BRAKE, true).report(3100, BRAKE).says(3150, "abort", "again").report(3300, BRAKE);
    assert!(over(made.left(3300, Left::Mode(LAND))).breaks().contains(&Law::Takeover));
}

#[test]
fn a_command_without_a_report_of_our_mode_after_its_reason_is_caught() {
    let over = |made: Made| made.vehicle(9000, BRAKE, true).over(9100, Ending::InTheAir("BRAKE".into()));
    let at_once = flying().says(1900, "abort", "late").left(1900, Left::Mode(BRAKE));
    assert_eq!(over(at_once).breaks(), [Law::Stale]);
    let after = flying().says(1900, "abort", "late").report(2000, GUIDED).left(2000, Left::Mode(BRAKE));
    assert_eq!(over(after).breaks(), []);
    // what came to the socket long before is no news, however late it is read
    let old = Report { mode: GUIDED, armed: None, said: Some(ms(1300)) };
    let queued = flying()
        .at(1300, Observation::Reached(old))
        .says(1900, "abort", "late")
        .at(1950, Observation::Heard(old, ms(1300)))
        .left(1950, Left::Mode(BRAKE));
    assert_eq!(over(queued).breaks(), [Law::Stale]);
    let long_ago = flying()
        .says(1900, "abort", "late")
        .report(2000, GUIDED)
        .left(2000, Left::Mode(BRAKE))
        .left(4000, Left::Mode(BRAKE));
    assert_eq!(over(long_ago).breaks(), [Law::Stale]);
}

#[test]
fn a_setpoint_that_is_old_outside_or_below_the_floor_is_caught() {
    let with = |made, position_m| landed(flying().setpoint(1300, made, position_m), 2000).breaks();
    assert_eq!(with(1300, [1.9, -1.9, 3.9]), []);
    assert_eq!(with(1190, [0.0, 0.0, 2.0]), [Law::Age]);
    for outside in [[2.2, 0.0, 2.0], [0.0, -2.2, 2.0], [0.0, 0.0, 4.2], [0.0, 0.0, 1.3]] {
        assert_eq!(with(1300, outside), [Law::Room], "{outside:?}");
    }
    // up from the ground, the floor is not reached yet
    let climb =
        Made::default().vehicle(0, GUIDED, true).report(500, GUIDED).setpoint(600, 600, [0.0, 0.0, 0.2]);
    assert_eq!(landed(climb, 2000).breaks(), []);
}

#[test]
fn setpoints_into_a_silence_of_more_than_five_seconds_are_caught() {
    assert_eq!(landed(flying().setpoint(6100, 6100, [0.0, 0.0, 2.0]), 7000).breaks(), []);
    assert_eq!(landed(flying().setpoint(6400, 6400, [0.0, 0.0, 2.0]), 7000).breaks(), [Law::Silence]);
}

#[test]
fn what_leaves_while_a_part_stands_still_is_caught() {
    // where nothing comes, nothing tells that its way stands still
    let parked = |part| flying().at(1300, Observation::Parked(part, ms(2500))).at(1300, Observation::Came);
    for part in [Part::Link, Part::Telemetry, Part::Supervisor, Part::Setpoints] {
        let early = parked(part).setpoint(1440, 1440, [0.0, 0.0, 2.0]);
        assert_eq!(landed(early, 3000).breaks(), [], "{part:?}");
        let late = parked(part).setpoint(1460, 1460, [0.0, 0.0, 2.0]);
        assert_eq!(landed(late, 3000).breaks(), [Law::Standstill], "{part:?}");
        let command = parked(part).report(1500, GUIDED).left(1600, Left::Mode(BRAKE));
        // where only the setpoints stand still, who knows the mode may command
        let caught = landed(command, 3000).breaks().contains(&Law::Standstill);
        assert_eq!(caught, part != Part::Setpoints, "{part:?}");
    }
}

#[test]
fn what_is_no_message_for_a_vehicle_is_caught() {
    let made = flying().left(1300, Left::Wrong("a mode that no vehicle has".into()));
    assert_eq!(landed(made, 2000).breaks(), [Law::Range]);
}

#[test]
fn an_end_that_is_not_safe_or_not_true_is_caught() {
    let left = flying().over(5000, Ending::InTheAir("GUIDED".into()));
    assert_eq!(left.breaks(), [Law::End]);
    assert_eq!(flying().over(5000, Ending::Landed).breaks(), [Law::End]);
    assert_eq!(flying().breaks(), [Law::Time]);
    // who is told that another flies it lets go
    let forged = Report { mode: LOITER, armed: Some(true), said: None };
    let told =
        flying().at(1300, Observation::Heard(forged, ms(1300))).over(5000, Ending::InTheAir("GUIDED".into()));
    assert_eq!(told.breaks(), []);
    let killed = Outcome {
        cause: Some(Cause::Killed),
        ending: Ending::Fell,
        flown: FlightStatistics::default(),
        losses: Vec::new(),
    };
    assert_eq!(flying().at(5000, Observation::Over(killed)).breaks(), []);
}
