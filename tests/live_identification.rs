//! Identification on the live stream: against the offline methods on the same flight, and in bounded memory.

#![allow(clippy::unwrap_used, reason = "a test ends where it fails")]

use mavid::config::load_vehicle;
use mavid::estimate::{Finding, IdentifySettings, Method, THETA, identify};
use mavid::fly::live::{LiveIdentification, LiveSettings};
use mavid::fly::parameters::Parameters;
use mavid::log::{Event, LoadOptions, Recording, Source, StreamId, load, stream_tlog};
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
    load(&fixture("p01_identify_0_25s.tlog"), &LoadOptions::default()).unwrap().recording
}

/// Every sample in the order of its time, `shift_s` later.
fn samples(recording: &Recording, shift_s: f64) -> Vec<(StreamId, f64, Vec<f64>)> {
    let mut all = Vec::new();
    for (key, stream) in &recording.streams {
        let source = *Source::ALL.iter().find(|source| source.name() == key.source).unwrap();
        let id = StreamId { quantity: key.quantity, source, instance: key.instance };
        for index in 0..stream.len() {
            all.push((id, stream.time_s[index] + shift_s, stream.sample(index).to_vec()));
        }
    }
    all.sort_by(|a, b| a.1.total_cmp(&b.1));
    all
}

fn feed(live: &mut LiveIdentification, samples: &[(StreamId, f64, Vec<f64>)]) {
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
        eprintln!("{index}: live {now} +- {std}, offline {whole} best {}", offline.best.result.estimated.theta[index]);
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
