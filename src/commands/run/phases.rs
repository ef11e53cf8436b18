//! The phases of a flight and how long they took, by its log of events.

use std::fs;
use std::path::Path;

use mavid::fly::EVENTS;
use serde::Deserialize;

/// The phase of the climb, with which the vehicle leaves the ground, ...
const CLIMB: &str = "take off";
/// ... those in which it flies to the begin of the trajectory, ...
const WAY: [&str; 2] = ["go to start", "start gate"];
/// ... the one of the trajectory, ...
const TRAJECTORY: &str = "trajectory";
/// ... and the one after the landing.
const OVER: &str = "over";

/// The begin of a phase.
#[derive(Debug, Clone, PartialEq)]
pub struct Begun {
    /// s on the flight's clock
    pub time_s: f64,
    /// the phase
    pub name: String,
}

/// A line of a flight's events.
#[derive(Deserialize)]
struct Event {
    time_s: f64,
    kind: String,
    text: String,
}

/// The phases of the flight in a folder, in their order; none where it has no log of events.
pub fn phases(folder: &Path) -> Vec<Begun> {
    let text = fs::read_to_string(folder.join(EVENTS)).unwrap_or_default();
    let events = text.lines().filter_map(|line| serde_json::from_str::<Event>(line).ok());
    let phases = events.filter(|event| event.kind == "phase");
    phases.map(|event| Begun { time_s: event.time_s, name: event.text }).collect()
}

/// How long a whole flight took, and its parts; `None` where it did not take off or is not over.
pub fn durations(phases: &[Begun]) -> Option<String> {
    let from = phases.iter().position(|begun| begun.name == CLIMB)?;
    let to = from + phases[from..].iter().position(|begun| begun.name == OVER)?;
    // climb, way, trajectory, and what comes behind it
    let mut parts_s = [0.0; 4];
    let mut is_behind = false;
    for pair in phases[from..=to].windows(2) {
        let name = pair[0].name.as_str();
        let part = match name {
            CLIMB => 0,
            TRAJECTORY => 2,
            name if WAY.contains(&name) && !is_behind => 1,
            _ => 3,
        };
        is_behind |= part >= 2;
        parts_s[part] += pair[1].time_s - pair[0].time_s;
    }
    let [climb_s, way_s, trajectory_s, landing_s] = parts_s;
    Some(format!(
        "the whole flight took {:.0} s: climb {climb_s:.0} s, to the start {way_s:.0} s, trajectory with the ways to it and from it \
         {trajectory_s:.0} s, return and landing {landing_s:.0} s",
        phases[to].time_s - phases[from].time_s
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_whole_flight_is_longer_than_its_trajectory() {
        let begun = |(time_s, name): &(f64, &str)| Begun { time_s: *time_s, name: (*name).to_owned() };
        let all = [
            (3.0, "check"),
            (10.0, "take off"),
            (16.0, "go to start"),
            (19.0, "start gate"),
            (20.0, "trajectory"),
            (78.0, "land"),
            (90.0, "over"),
        ];
        let phases: Vec<Begun> = all.iter().map(begun).collect();
        let said = durations(&phases).unwrap();
        assert!(said.starts_with("the whole flight took 80 s: climb 6 s, to the start 4 s, "), "{said}");
        assert!(said.ends_with("from it 58 s, return and landing 12 s"), "{said}");
        assert_eq!((durations(&phases[..6]), durations(&phases[..1])), (None, None));
    }
}
