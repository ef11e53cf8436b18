//! `inspect` tells the truth about other people's logs: `fixtures/foreign_logs.toml` says what each is, by other readers.

use crate::support;

use std::path::Path;

use mavid::config::read_vehicle;
use mavid::draft::Given;
use mavid::inspect::{Inspection, Reading, inspect};
use mavid::log::{Input, OpenOptions};
use mavid::study::{IdentifyRequest, ReadSettings, Silent, VehicleGiven, identify};
use mavid::wire::SystemId;
use serde::Deserialize;

/// What a log is.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Fact {
    file: String,
    kind: Option<String>,
    system: Option<u32>,
    armed_s: Option<f64>,
    #[serde(default)]
    airborne_s: [f64; 2],
    commands_hz: Option<f64>,
    #[serde(default)]
    good_for: Vec<String>,
    why: Option<String>,
    refused: Option<String>,
}

#[derive(Deserialize)]
struct Facts {
    log: Vec<Fact>,
}

fn facts() -> Vec<Fact> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/foreign_logs.toml");
    toml::from_str::<Facts>(&std::fs::read_to_string(path).unwrap()).unwrap().log
}

/// How far an inspection is from the facts, sentence by sentence.
fn differences(fact: &Fact, found: &Inspection) -> Vec<String> {
    let mut wrong = Vec::new();
    let mut hold = |is_right: bool, what: String| {
        if !is_right {
            wrong.push(format!("{}: {what}", fact.file));
        }
    };
    let vehicle = &found.vehicle;
    hold(vehicle.kind == fact.kind.as_deref(), format!("kind {:?}, is {:?}", vehicle.kind, fact.kind));
    if fact.system.is_some() {
        hold(vehicle.system == fact.system, format!("system {:?}, is {:?}", vehicle.system, fact.system));
    }
    let armed_s: f64 = found.timeline.armed_s.iter().map(|(from_s, to_s)| to_s - from_s).sum();
    // HEARTBEAT tells it once a second
    let is = fact.armed_s.unwrap_or(0.0);
    hold((armed_s - is).abs() <= 1.3, format!("armed {armed_s:.1} s, is {is}"));
    let flight = &found.flight;
    let [least, most] = fact.airborne_s;
    let inside = (least - 0.05..=most + 0.05).contains(&flight.airborne_s);
    hold(inside, format!("in the air {:.1} s, is {least} to {most}", flight.airborne_s));
    let usable = flight.usable_s <= flight.airborne_s + 1e-6;
    hold(usable, format!("usable {:.1} s of {:.1}", flight.usable_s, flight.airborne_s));
    let spans = flight.segments.iter().all(|one| one.usable_s <= one.end_s - one.start_s + 1e-6);
    hold(spans, "a segment is usable for longer than it lasts".to_owned());
    let commands = found.streams.iter().filter(|stream| stream.quantity == "actuator_command");
    let rates = commands.filter(|stream| stream.state == "live" && stream.count > 9).map(|one| one.rate_hz);
    match (rates.reduce(f64::max), fact.commands_hz) {
        (Some(rate), Some(is)) => {
            hold((rate / is - 1.0).abs() < 0.1, format!("commands at {rate:.1} Hz, is {is}"));
        }
        (rate, is) => hold(rate.is_none() == is.is_none(), format!("commands {rate:?} Hz, is {is:?}")),
    }
    let good: Vec<&str> = found
        .identifiability
        .iter()
        .filter(|one| ["mass", "ixx", "iyy", "izz"].contains(&one.name) && one.status != "not_determined")
        .map(|one| one.name)
        .collect();
    // a vehicle that tips over is judged by its time in the air alone
    if fact.why.is_some() || !fact.good_for.is_empty() {
        hold(good == fact.good_for, format!("good for {good:?}, is for {:?}", fact.good_for));
    }
    if let Some(why) = &fact.why {
        hold(found.verdict.contains(why.as_str()), format!("{}: {why}", found.verdict));
    }
    wrong
}

/// Quantities of a log that is good for nothing are all refused, with a reason, and with what to do where a flight would help.
fn refusals(fact: &Fact, found: &Inspection) -> Vec<String> {
    assert_eq!(found.quantities.len(), 9, "{}", fact.file);
    let wrong = found.quantities.iter().filter(|quantity| {
        let is_refused = quantity.status == "no" && quantity.reason.is_some();
        let of_kind = fact.kind.as_deref() != Some("multirotor");
        let is_helped = of_kind || quantity.fly.is_some() || quantity.set.is_some();
        let is_untimed = fact.why.as_deref().is_some_and(|why| why.contains("no time"));
        fact.why.is_some() && !(is_refused && (is_helped || is_untimed))
    });
    wrong.map(|quantity| format!("{}: {quantity:?}", fact.file)).collect()
}

#[test]
fn the_same_story_with_a_vehicle_and_by_identify() {
    let Some(shared) = support::shared() else { return };
    let vehicle = Path::new(env!("CARGO_MANIFEST_DIR")).join("configs/x500.toml");
    let known = read_vehicle(&vehicle).unwrap().vehicle;
    for fact in facts().iter().filter(|fact| fact.refused.is_none()) {
        let log = shared.join(&fact.file);
        let inspected = |vehicle| inspect(&log, &OpenOptions::default(), vehicle, &mut |_| ()).unwrap();
        let (without, with) = (inspected(None), inspected(Some(&known)));
        assert_eq!(with.vehicle, without.vehicle, "{}", fact.file);
        assert_eq!(with.timeline, without.timeline, "{}", fact.file);
        assert_eq!(with.flight.airborne_s, without.flight.airborne_s, "{}", fact.file);
        assert!(with.flight.usable_s <= with.flight.airborne_s + 1e-6, "{}", fact.file);
        let Some(why) = &fact.why else { continue };
        assert!(with.quantities.iter().all(|quantity| quantity.status == "no"), "{}", fact.file);
        // with a file, and with what a person knows: the frame is asked for only where something was flown
        let weighed = Given { mass_kg: 2.0, size_m: Some(0.5), frame: None };
        for given in [VehicleGiven::File(vehicle.clone()), VehicleGiven::Weighed(weighed)] {
            let request = IdentifyRequest {
                vehicle: given,
                logs: vec![log.clone()],
                read: ReadSettings { system: fact.system.map(SystemId), ..ReadSettings::default() },
                ..IdentifyRequest::default()
            };
            let refusal = identify(&request, &Silent).err().unwrap().to_string();
            let words = match why.as_str() {
                "its messages carry no time" => "no time",
                other => other.trim_start_matches("it is "),
            };
            assert!(refusal.contains(words), "{}: {refusal}", fact.file);
        }
    }
}

#[test]
fn the_truth_about_every_foreign_log() {
    let Some(shared) = support::shared() else { return };
    let mut wrong = Vec::new();
    for fact in facts() {
        let found = inspect(&shared.join(&fact.file), &OpenOptions::default(), None, &mut |_| ());
        match (found, &fact.refused) {
            (Ok(found), None) => {
                wrong.extend(differences(&fact, &found));
                wrong.extend(refusals(&fact, &found));
            }
            (Err(error), Some(words)) => {
                let error = error.to_string();
                if !error.contains(words.as_str()) {
                    wrong.push(format!("{}: {error}", fact.file));
                }
            }
            (found, _) => wrong.push(format!("{}: read {}", fact.file, found.is_ok())),
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn a_drafted_vehicle_expects_no_outputs_and_the_setting_of_the_log_is_named() {
    let Some(shared) = support::shared() else { return };
    let request = IdentifyRequest {
        vehicle: VehicleGiven::Weighed(Given { mass_kg: 1.2, size_m: Some(0.4), frame: None }),
        logs: vec![shared.join("onboard/logs/copter_402_thin_quad.bin")],
        ..IdentifyRequest::default()
    };
    let refusal = identify(&request, &Silent).err().unwrap().to_string();
    assert!(refusal.contains("no actuator outputs. Next time set LOG_BITMASK = 411509"), "{refusal}");
    assert!(!refusal.contains("vehicle file"), "{refusal}");
}

#[test]
fn a_pause_between_two_flights_does_not_lower_the_rates_of_topics() {
    let Some(shared) = support::shared() else { return };
    let log = shared.join("onboard/logs/copter_364_2019_quad.bin");
    let found = inspect(&log, &OpenOptions::default(), None, &mut |_| ()).unwrap();
    let Reading::Onboard(reading) = &found.reading else { panic!("{:?}", found.reading) };
    for (name, hz) in [("AHR2", 10.0), ("ATT", 10.0), ("IMU", 25.0), ("GPS", 5.0)] {
        let topic = reading.topics.iter().find(|topic| topic.name == name && topic.instance == 0).unwrap();
        let rate_hz = topic.rate_hz.unwrap();
        assert!((rate_hz / hz - 1.0).abs() < 0.05, "{name} at {rate_hz} Hz");
    }
}

/// What is told of a log that somebody damaged, made from one that is sound.
fn told(name: &str, bytes: &[u8]) -> Inspection {
    inspect(Input::Bytes { name, bytes }, &OpenOptions::default(), None, &mut |_| ()).unwrap()
}

#[test]
fn a_log_without_its_beginning_is_told_so() {
    let Some(shared) = support::shared() else { return };
    let whole = std::fs::read(shared.join("onboard/sitl/ap11.bin")).unwrap();
    // some definitions are repeated later, those that matter are not
    let found = told("nohead.bin", &whole[20_000..]);
    assert!(found.verdict.contains("its beginning is missing. Give the whole log"), "{}", found.verdict);
    // a piece that begins within a message, and without a definition in it
    let mut piece: Vec<u8> = Vec::new();
    let mut at = 20_001;
    while at < whole.len() {
        if whole[at..].starts_with(b"\xa3\x95\x80") {
            at += 89;
        } else {
            piece.push(whole[at]);
            at += 1;
        }
    }
    let refused =
        inspect(Input::Bytes { name: "piece", bytes: &piece }, &OpenOptions::default(), None, &mut |_| ());
    let said = refused.unwrap_err().to_string();
    assert!(said.contains("without the definitions that begin it"), "{said}");
}

#[test]
fn pieces_in_a_wrong_order_do_not_lengthen_a_flight() {
    let Some(shared) = support::shared() else { return };
    let whole = std::fs::read(shared.join("onboard/sitl/px09.ulg")).unwrap();
    let (head, rest) = whole.split_at(65_536);
    let mut blocks: Vec<&[u8]> = rest.chunks(4096).collect();
    let count = blocks.len();
    (0..count).for_each(|index| blocks.swap(index, (index * 7919 + 31) % count));
    let shuffled = told("shuffled.ulg", &[head, &blocks.concat()].concat());
    let sound = told("px09.ulg", &whole);
    let [shuffled_s, sound_s] = [&shuffled, &sound].map(|found| found.flight.airborne_s);
    assert!(sound_s > 40.0 && shuffled_s <= sound_s + 1.0, "{shuffled_s} of {sound_s}");
}

#[test]
fn single_bits_do_not_ground_a_flight() {
    let Some(shared) = support::shared() else { return };
    let mut bytes = std::fs::read(shared.join("onboard/sitl/ap05.bin")).unwrap();
    let sound_s = told("ap05.bin", &bytes).flight.airborne_s;
    let count = bytes.len();
    let mut state = 1_u64;
    for _ in 0..count / 200 {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let draw = usize::try_from(state >> 33).unwrap();
        bytes[20_000 + draw % (count - 20_000)] ^= 1 << (state >> 30 & 7);
    }
    let found = told("flipped.bin", &bytes);
    assert!(
        found.flight.airborne_s > 0.5 * sound_s,
        "{} of {sound_s}: {}",
        found.flight.airborne_s,
        found.verdict
    );
    assert!(!found.verdict.contains("never in the air"), "{}", found.verdict);
}

#[test]
fn a_vehicle_file_that_does_not_lift_the_vehicle_contradicts_the_log() {
    let Some(shared) = support::shared() else { return };
    let folder = shared.join("onboard/sitl");
    let mut vehicle = read_vehicle(&folder.join("px4-v2.toml")).unwrap().vehicle;
    vehicle.body.mass_kg *= 9.0;
    let log = folder.join("px11.ulg");
    let found = inspect(&log, &OpenOptions::default(), Some(&vehicle), &mut |_| ()).unwrap();
    assert!(found.verdict.contains("its thrust contradicts the log"), "{}", found.verdict);
    assert!(found.quantities.iter().all(|quantity| quantity.fly.is_none()), "{:?}", found.quantities);
    assert!(found.advice[0].contains("the rotors give at most"), "{:?}", found.advice);
}
