//! Screening of one log: what it finds, within its bounds and on the calling thread; by its bytes, and as an analyzer of a service.

use std::ops::Range;

use mavid::autopilot::Frame;
use mavid::draft::Given;
use mavid::screen::{Bounds, Gravity, ScreenSettings, Screening, screen};

use crate::flight_review::{Severity, diagnostics};

fn fixture(name: &str) -> Vec<u8> {
    std::fs::read(format!("{}/fixtures/{name}", env!("CARGO_MANIFEST_DIR"))).unwrap()
}

fn weighed(mass_kg: f64) -> ScreenSettings {
    let given = Given { mass_kg, size_m: Some(0.5), frame: Frame::of_id("quadrotor-x") };
    ScreenSettings { vehicle: Some(given), ..ScreenSettings::default() }
}

fn ids(screening: &Screening) -> Vec<&'static str> {
    screening.findings.iter().map(|finding| finding.id).collect()
}

fn is_told(screening: &Screening, why: &str) -> bool {
    screening.not_done.iter().any(|told| told.contains(why))
}

/// Kind and bytes of each message of a ULog, with the place of its bytes.
fn messages(log: &[u8]) -> Vec<(u8, Range<usize>)> {
    let (mut at, mut found) = (16, Vec::new());
    while let Some([low, high, kind]) = log.get(at..at + 3) {
        let body = at + 3..at + 3 + usize::from(u16::from_le_bytes([*low, *high]));
        if body.end > log.len() {
            break;
        }
        at = body.end;
        found.push((*kind, body));
    }
    found
}

/// A log with a second flight, which is the first once more, so many seconds later.
fn flown_twice(log: &[u8], later_s: u64) -> Vec<u8> {
    let mut twice = log.to_vec();
    for (_, body) in messages(log).into_iter().filter(|(kind, _)| *kind == b'D') {
        let start = twice.len() + 3;
        twice.extend(&log[body.start - 3..body.end]);
        let stamp = start + 2..start + 10;
        let stamp_us = u64::from_le_bytes(twice[stamp.clone()].try_into().unwrap()) + later_s * 1_000_000;
        twice[stamp].copy_from_slice(&stamp_us.to_le_bytes());
    }
    twice
}

/// A log in which one motor's output stands still from a byte of it on, while the others go on.
fn with_a_stuck_output(log: &[u8], from: usize) -> Vec<u8> {
    let mut stuck = log.to_vec();
    let mut outputs = Vec::new();
    for (kind, body) in messages(log) {
        let bytes = &log[body.clone()];
        match (kind, &bytes[..bytes.len().min(3)]) {
            // stamps, and of the outputs their number, stand before the values; the second one is held
            (b'A', [_, low, high]) if bytes[3..] == *b"actuator_motors" => {
                outputs.push(([*low, *high], 20, None))
            }
            (b'A', [_, low, high]) if bytes[3..] == *b"actuator_outputs" => {
                outputs.push(([*low, *high], 16, None))
            }
            (b'D', _) if body.start > from => {
                if let Some((_, place, held)) = outputs.iter_mut().find(|(id, ..)| bytes[..2] == *id) {
                    let value = body.start + 2 + *place..body.start + 6 + *place;
                    let held = held.get_or_insert_with(|| stuck[value.clone()].to_vec());
                    stuck[value].copy_from_slice(held);
                }
            }
            _ => (),
        }
    }
    stuck
}

#[test]
fn a_lag_is_found_where_the_mass_is_given_and_a_cause_in_the_log_without() {
    // the true lag is 60 ms: fixtures/README.md
    let lagging = screen(&fixture("p04_identify_10_22s.tlog"), &weighed(1.0)).unwrap();
    assert!(ids(&lagging).contains(&"motor_lag"), "{lagging:?}");
    let sound = screen(&fixture("px4_flight.ulg"), &ScreenSettings::default()).unwrap();
    assert!(sound.findings.is_empty() && is_told(&sound, "mass"), "{sound:?}");

    let whole = fixture("px4_flight.ulg");
    let stuck = with_a_stuck_output(&whole, whole.len() / 2);
    let found = screen(&stuck, &ScreenSettings::default()).unwrap();
    let first = &found.findings[0];
    assert_eq!(
        (first.id, first.gravity, first.at.unwrap().channel),
        ("output_off_mixer", Gravity::Critical, 1)
    );
    // the log is 22 to 33 s of a flight: fixtures/README.md
    assert!((first.span_s.unwrap().0 - 27.0).abs() < 2.0, "{first:?}");
    // the same of a service that gives its messages one after the other
    let of_service = diagnostics(&stuck, None);
    assert_eq!((of_service[0].id.as_str(), of_service[0].severity), ("output_off_mixer", Severity::Critical));
    assert_eq!(of_service[0].summary, first.sentence);
    assert_eq!(of_service[0].anchor.as_ref().unwrap().1, "output[1]");
    assert!(diagnostics(&fixture("px4_flight.ulg"), None).is_empty());
}

#[test]
fn bounds_are_kept_and_told() {
    let log = fixture("p04_identify_10_22s.tlog");
    let within = |bounds| screen(&log, &ScreenSettings { bounds, ..weighed(1.0) }).unwrap();
    let few = within(Bounds { searched: 900, ..Bounds::default() });
    assert!(is_told(&few, "with the most motion"), "{few:?}");
    let fewer = within(Bounds { searched: 100, ..Bounds::default() });
    assert!(fewer.findings.is_empty() && is_told(&fewer, "effects are not searched"), "{fewer:?}");
    let short = within(Bounds { bytes: log.len() / 2, ..Bounds::default() });
    assert!(is_told(&short, "are not looked at") && short.airborne_s < few.airborne_s, "{short:?}");
    // the end that was cut off here is no damage of the log; what is damaged before is
    assert!(!ids(&short).contains(&"data_lost"), "{short:?}");
    let mut damaged = log.clone();
    damaged[log.len() / 8..log.len() / 7].fill(0);
    let bounds = Bounds { bytes: log.len() / 2, ..Bounds::default() };
    let damaged = screen(&damaged, &ScreenSettings { bounds, ..weighed(1.0) }).unwrap();
    assert!(ids(&damaged).contains(&"data_lost"), "{damaged:?}");
    // the same bytes give the same
    assert_eq!(within(Bounds::default()), within(Bounds::default()));
}

#[test]
fn a_later_flight_is_told_on_the_clock_of_the_log() {
    let twice = flown_twice(&fixture("px4_flight.ulg"), 300);
    let stuck = with_a_stuck_output(&twice, twice.len() / 4 * 3);
    let found = screen(&stuck, &ScreenSettings::default()).unwrap();
    let first = &found.findings[0];
    let (from_s, to_s) = first.span_s.unwrap();
    assert!((from_s - 327.0).abs() < 2.0 && (to_s - 333.0).abs() < 2.0, "{first:?}");
    assert!(first.sentence.contains(&format!("from {from_s:.1} s on")), "{first:?}");
    // a flight for which the bounds have no room is told, and is no loss of the log
    let of_one = screen(&fixture("px4_flight.ulg"), &ScreenSettings::default()).unwrap();
    assert!((found.airborne_s - 2.0 * of_one.airborne_s).abs() < 6.0, "{found:?}");
    let bounds = Bounds { numbers: 10_000, ..Bounds::default() };
    let bounded = screen(&twice, &ScreenSettings { bounds, ..ScreenSettings::default() }).unwrap();
    assert!(is_told(&bounded, "s of flight at the end are not looked at"), "{bounded:?}");
    assert!(!ids(&bounded).contains(&"data_lost"), "{bounded:?}");
}

#[test]
fn whatever_the_bytes_are_something_is_said() {
    assert!(screen(b"", &ScreenSettings::default()).is_err());
    assert!(screen(&b"this is no log at all\n".repeat(50), &ScreenSettings::default()).is_err());
    let mut damaged = fixture("px4_flight.ulg");
    damaged.iter_mut().skip(4000).step_by(97).for_each(|byte| *byte ^= 0x5a);
    if let Ok(found) = screen(&damaged, &weighed(1.0)) {
        assert!(ids(&found).contains(&"data_lost"), "{found:?}");
    }
    assert!(diagnostics(b"ULog", None).is_empty());
}

#[cfg(target_os = "linux")]
#[test]
fn no_thread_is_begun() {
    // threads of other tests come and go: a process of its own
    let output = std::process::Command::new(std::env::current_exe().unwrap())
        .args(["--exact", "screen::in_a_process_of_its_own", "--ignored", "--test-threads", "1"])
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success() && said.contains("1 passed"), "{said}");
}

#[cfg(target_os = "linux")]
#[test]
#[ignore = "started by no_thread_is_begun"]
fn in_a_process_of_its_own() {
    let threads = || {
        let status = std::fs::read_to_string("/proc/self/status").unwrap();
        status.lines().find_map(|line| line.strip_prefix("Threads:")).unwrap().trim().parse::<u32>().unwrap()
    };
    let before = threads();
    for _ in 0..2 {
        screen(&fixture("p04_identify_10_22s.tlog"), &weighed(1.0)).unwrap();
        assert_eq!(threads(), before);
    }
}
