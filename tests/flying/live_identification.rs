//! Identification on the live stream: against the offline methods on the same flight, and in bounded memory.

use mavid::config::load_vehicle;
use mavid::estimate::{Finding, IdentifySettings, Method, THETA, identify};
use mavid::fly::live::{LiveIdentification, LiveSettings};
use mavid::fly::parameters::Parameters;
use mavid::log::{self, OpenOptions};
use mavid::recording::{Event, Recording, StreamKey};
use mavid::signals::{ConditionSettings, condition};
use mavid::vehicle::{Anchor, Vehicle};
use std::path::{Path, PathBuf};

fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures").join(name)
}

fn vehicle() -> Vehicle {
    load_vehicle(&fixture("p01_vehicle.toml")).unwrap()
}

fn recording() -> Recording {
    log::open(&fixture("p01_identify_0_25s.tlog"), &OpenOptions::default()).unwrap().recording
}

/// Every sample in the order of its time, `shift_s` later.
fn samples(recording: &Recording, shift_s: f64) -> Vec<(StreamKey, f64, Vec<f64>)> {
    let mut all = Vec::new();
    for (key, stream) in &recording.streams {
        for index in 0..stream.len() {
            all.push((*key, stream.time_s[index] + shift_s, stream.sample(index).to_vec()));
        }
    }
    all.sort_by(|a, b| a.1.total_cmp(&b.1));
    all
}

fn feed(live: &mut LiveIdentification, samples: &[(StreamKey, f64, Vec<f64>)]) {
    for (stream, time_s, values) in samples {
        live.take(&Event::Sample { stream: *stream, time_s: *time_s, values });
    }
}

fn live(vehicle: &Vehicle) -> LiveIdentification {
    LiveIdentification::new(vehicle, &Parameters::default(), &LiveSettings::default())
}

#[test]
fn it_ends_where_the_offline_least_squares_does() {
    let vehicle = vehicle();
    let mut live = live(&vehicle);
    feed(&mut live, &samples(&recording(), 0.0));
    let estimate = live.estimate().unwrap();
    assert!(estimate.used_s > 15.0, "{} s", estimate.used_s);

    let signals = condition(&recording(), &vehicle, &ConditionSettings::default()).unwrap();
    let offline = identify(&[signals], &vehicle, &IdentifySettings::default()).unwrap();
    let filtered = offline.methods.iter().find(|method| method.method == Method::Fmls).unwrap();
    for index in 0..THETA {
        let (now, whole) = (estimate.estimated.theta[index], filtered.estimated.theta[index]);
        let std = estimate.estimated.covariance[(index, index)].sqrt();
        assert!((now - whole).abs() < 2.5 * std, "parameter {index}: live {now} +- {std}, offline {whole}");
    }
}

#[test]
fn errors_shrink_as_the_flight_goes_on() {
    let vehicle = vehicle();
    let mut live = live(&vehicle);
    let samples = samples(&recording(), 0.0);
    let mut stds = Vec::new();
    for part in samples.chunks(samples.len().div_ceil(3)) {
        feed(&mut live, part);
        stds.push(live.estimate().unwrap().estimated.covariance[(1, 1)].sqrt());
    }
    assert!(stds[2] < stds[0], "{stds:?}");
}

#[test]
fn a_weighed_vehicle_keeps_its_mass() {
    let mut weighed = vehicle();
    weighed.anchor = Anchor::Mass;
    weighed.body.mass_kg = 2.0;
    let mut live = live(&weighed);
    feed(&mut live, &samples(&recording(), 0.0));
    let estimate = live.estimate().unwrap();
    assert_eq!(estimate.parameters[0].finding, Finding::Given { value: 2.0 });
    // thrust and inertia shrink together: 2.06 kg fly as 2 kg
    let Finding::Determined { value: izz, .. } = estimate.parameters[6].finding else { unreachable!() };
    assert!((izz - 0.0402 * 2.0 / 2.06).abs() < 0.002, "{izz}");
}

#[test]
fn nothing_counts_on_the_ground_or_before_the_trajectory() {
    let vehicle = vehicle();
    let mut live = live(&vehicle);
    live.set_active(false);
    assert!(live.waits_for().contains("attitude") && live.waits_for().contains("actuator command"));
    feed(&mut live, &samples(&recording(), 0.0));
    assert!(live.estimate().is_none());
    assert_eq!(live.waits_for(), "waits for the trajectory");
    live.set_active(true);
    assert!(live.waits_for().contains("without a gap"), "{}", live.waits_for());
}

#[test]
fn a_restarted_clock_and_gaps_do_not_disturb_it() {
    let vehicle = vehicle();
    let (mut whole, mut broken) = (live(&vehicle), live(&vehicle));
    let all = samples(&recording(), 0.0);
    feed(&mut whole, &all);
    // a second without any frame in the middle, then the same flight again on a restarted clock
    let holed: Vec<_> = all.iter().filter(|(_, time_s, _)| !(12.0..13.0).contains(time_s)).cloned().collect();
    feed(&mut broken, &holed);
    broken.take(&Event::ClockReset { stamp_s: 0.0, time_s: 30.0 });
    feed(&mut broken, &samples(&recording(), -3.0));
    let (whole, broken) = (whole.estimate().unwrap(), broken.estimate().unwrap());
    assert!(broken.used_s > 1.5 * whole.used_s, "{} {}", broken.used_s, whole.used_s);
    for index in 0..THETA {
        let std = whole.estimated.covariance[(index, index)].sqrt();
        let moved = broken.estimated.theta[index] - whole.estimated.theta[index];
        assert!(moved.abs() < std, "parameter {index} moved by {moved}, its error is {std}");
    }
}

#[test]
fn it_takes_no_memory_as_it_goes_on() {
    let vehicle = vehicle();
    let mut live = live(&vehicle);
    let all = samples(&recording(), 0.0);
    let length_s = 25.0;
    feed(&mut live, &all);
    live.estimate().unwrap();
    // the flight again and again: once sources are chosen nothing is taken from the heap
    let again = |n: u32| samples(&recording(), f64::from(n) * length_s);
    let parts: Vec<_> = (1..=3).map(again).collect();
    let used = allocation_counter::measure(|| parts.iter().for_each(|part| feed(&mut live, part)));
    assert_eq!(used.count_total, 0);
    assert!(live.estimate().unwrap().used_s > 60.0);
}
