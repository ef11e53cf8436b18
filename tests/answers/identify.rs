//! From recorded flights to parameters: fixtures, the shared flights where they are, and a twin of the paper.

use crate::support;

use mavid::config::{load_vehicle, read_trajectory};
use mavid::estimate::{
    Finding, Identification, IdentifySettings, LatencyKind, Method, Theta, apply_anchor, identified_vehicle,
    identify, inertia_of, is_physical, scale_of, theta_of,
};
use mavid::log::{self, OpenOptions};
use mavid::physics::RigidBodyModel;
use mavid::recording::{Quantity, Recording};
use mavid::signals::{ConditionSettings, SignalsError, ThrustPreference, condition};
use mavid::simulate::pid::{PidFlightSettings, simulate_pid_flight};
use mavid::study::{self, IdentifyRequest, Silent};
use mavid::vehicle::{Anchor, RigidBody, Vehicle};
use nalgebra::{SVector, Vector3};
use std::path::{Path, PathBuf};

fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures").join(name)
}

fn read(path: &Path) -> Recording {
    log::open(path, &OpenOptions::default()).unwrap().recording
}

fn identified(recording: &Recording, vehicle: &Vehicle, thrust: ThrustPreference) -> Identification {
    let settings = ConditionSettings { thrust, ..ConditionSettings::default() };
    let signals = condition(recording, vehicle, &settings).unwrap();
    identify(&[signals], vehicle, &IdentifySettings::default()).unwrap()
}

fn from_files(log: &Path, vehicle: &Path) -> Identification {
    identified(&read(log), &load_vehicle(vehicle).unwrap(), ThrustPreference::Measured)
}

/// Errors in percent of the parameter, of `sqrt(Iii Ijj)` for products.
fn errors_percent(estimate: &Theta, truth: &Theta) -> Theta {
    Theta::from_fn(|i, _| 100.0 * (estimate[i] - truth[i]) / scale_of(truth, i))
}

fn p01_truth() -> Theta {
    SVector::from([2.06, 0.0217, 0.0004, -0.0009, 0.0231, 0.0005, 0.0402])
}

fn mass_of(identification: &Identification) -> f64 {
    identification.best.result.estimated.theta[0]
}

#[test]
fn a_piece_of_the_first_case_gives_its_mass_and_inertia() {
    let found = from_files(&fixture("p01_identify_0_25s.tlog"), &fixture("p01_vehicle.toml"));
    let estimated = &found.best.result.estimated;
    let errors = errors_percent(&estimated.theta, &p01_truth());
    assert!(errors[0].abs() < 0.1, "{errors}");
    // 20 s of it: three standard errors, none above 4 %
    for i in 1..7 {
        let std = 100.0 * estimated.covariance[(i, i)].sqrt() / scale_of(&p01_truth(), i);
        assert!(errors[i].abs() < 3.0 * std && std < 4.0, "parameter {i}: {} +- {std}", errors[i]);
    }
    assert!(is_physical(&estimated.theta));
}

#[test]
fn commands_and_measured_speeds_agree() {
    let vehicle = load_vehicle(&fixture("p01_vehicle.toml")).unwrap();
    let recording = read(&fixture("p01_identify_0_25s.tlog"));
    let by_speed = identified(&recording, &vehicle, ThrustPreference::Measured);
    let by_command = identified(&recording, &vehicle, ThrustPreference::Commands);
    assert!((mass_of(&by_speed) / mass_of(&by_command) - 1.0).abs() < 2e-3);
    // a command is ahead of the rotor that follows it
    assert!(by_command.latency.unwrap().total_s > by_speed.latency.unwrap().total_s);
}

#[test]
fn a_lag_of_sixty_milliseconds_is_found_and_called_a_lag() {
    let found = from_files(&fixture("p04_identify_10_22s.tlog"), &fixture("p04_vehicle.toml"));
    let latency = found.latency.unwrap();
    assert!(matches!(latency.kind, LatencyKind::Lag | LatencyKind::Both { .. }), "{latency:?}");
    assert!((latency.total_s - 0.066).abs() < 0.02, "{latency:?}");
    let truth = SVector::from([1.0, 0.025, 0.0006, 0.0, 0.027, 0.0008, 0.031]);
    let errors = errors_percent(&found.best.result.estimated.theta, &truth);
    assert!(errors[0].abs() < 0.5 && errors.iter().all(|e| e.abs() < 8.0), "{errors}");
}

#[test]
fn pulse_widths_of_both_autopilots_give_the_mass() {
    for (log, vehicle, mass_kg) in [
        ("ap_baseline_70_79s.tlog", "ardupilot-quad.toml", 3.0),
        ("px4_baseline_40_46s.tlog", "px4-sih.toml", 1.0),
    ] {
        let found = from_files(&fixture(log), &fixture(vehicle));
        assert!((mass_of(&found) / mass_kg - 1.0).abs() < 0.03, "{log}: {}", mass_of(&found));
    }
}

#[test]
fn a_weighed_mass_moves_the_scale_to_the_thrust() {
    let mut vehicle = load_vehicle(&fixture("p01_vehicle.toml")).unwrap();
    vehicle.anchor = Anchor::Mass;
    vehicle.body.mass_kg = 2.06;
    // stated 4 % too strong
    vehicle.propulsion.thrust_coefficient = Some(8.55e-6 * 1.04);
    let mut found =
        identified(&read(&fixture("p01_identify_0_25s.tlog")), &vehicle, ThrustPreference::Measured);
    let scale = apply_anchor(&mut found, &vehicle).unwrap();
    let Finding::Determined { value, std } = scale.value else { unreachable!("{scale:?}") };
    assert!((value / 8.55e-6 - 1.0).abs() < 1e-3 && std < 1e-8, "{value} {std}");
    assert_eq!(found.best.result.parameters[0].finding, Finding::Given { value: 2.06 });
    let model = identified_vehicle(&vehicle, &found.best.result, Some(&scale));
    assert_eq!(model.propulsion.thrust_coefficient, Some(value));
    assert!((theta_of(&model.body)[1] / 0.0217 - 1.0).abs() < 0.06);
}

#[test]
fn a_log_without_actuators_says_what_to_request() {
    let vehicle = load_vehicle(&fixture("p01_vehicle.toml")).unwrap();
    let mut recording = read(&fixture("p01_identify_0_25s.tlog"));
    recording
        .streams
        .retain(|key, _| !matches!(key.quantity, Quantity::ActuatorCommand | Quantity::RotorSpeed));
    let error = condition(&recording, &vehicle, &ConditionSettings::default()).unwrap_err();
    assert!(matches!(error, SignalsError::NoActuators { .. }));
    assert!(error.to_string().contains("SERVO_OUTPUT_RAW"), "{error}");
}

#[test]
fn without_body_rates_inertia_is_not_a_number() {
    let vehicle = load_vehicle(&fixture("p01_vehicle.toml")).unwrap();
    let mut recording = read(&fixture("p01_identify_0_25s.tlog"));
    recording.streams.retain(|key, _| key.quantity != Quantity::AngularRate);
    let found = identified(&recording, &vehicle, ThrustPreference::Measured);
    for parameter in &found.best.result.parameters[1..] {
        assert!(matches!(&parameter.finding, Finding::NotDetermined { reason } if reason.contains("rates")));
    }
    assert!(matches!(found.best.result.parameters[0].finding, Finding::Determined { .. }));
}

/// Table 3's FMLS values fly Table 2's trajectory under the paper's PID for 50 s at 500 Hz.
#[test]
fn all_four_methods_recover_the_papers_vehicle() {
    let configs = Path::new(env!("CARGO_MANIFEST_DIR")).join("configs");
    let nominal = load_vehicle(&configs.join("qball2.toml")).unwrap();
    let trajectory = read_trajectory(&configs.join("trajectories/table2.toml")).unwrap().series;
    let truth = SVector::from([1.82245, 0.00749, -0.00051, -0.00003, 0.00976, -0.00098, 0.05130]);
    let body = RigidBody {
        mass_kg: truth[0],
        inertia_kg_m2: inertia_of(&truth),
        center_of_mass_m: Vector3::zeros(),
        gyroscopic: 1.0,
    };
    let model = RigidBodyModel::new(&body, nominal.gravity_m_s2).unwrap();
    let flight = simulate_pid_flight(&model, &trajectory, &PidFlightSettings::default(), None).unwrap();
    let found = identified(&flight.recording, &nominal, ThrustPreference::Measured);
    for method in [Method::Ls, Method::Gd, Method::Fmls, Method::Fmgd] {
        let result = found.methods.iter().find(|result| result.method == method).unwrap();
        let errors = errors_percent(&result.estimated.theta, &truth);
        assert!(errors.amax() < 0.2, "{}: {errors}", method.name());
    }
    // figures 4 and 5: a history for each of them, its end the estimate
    assert_eq!(found.histories.len(), 4);
    let (_, history) = &found.histories[0];
    assert!(history.time_s.len() > 150 && history.time_s[0] < 11.0);
}

#[test]
fn the_first_case_within_its_tolerances() {
    let Some(shared) = support::shared() else { return };
    let case = shared.join("cases/p01-nothing-missing");
    let found = from_files(&case.join("identify.tlog"), &case.join("vehicle.toml"));
    let errors = errors_percent(&found.best.result.estimated.theta, &p01_truth());
    assert!(errors[0].abs() < 0.5, "{errors}");
    assert!(errors.amax() < 3.0, "{errors}");
}

#[test]
fn every_shared_flight_is_identified_or_says_why_not() {
    let Some(shared) = support::shared() else { return };
    let mut count = 0;
    for folder in ["cases", "recordings"] {
        for vehicle_file in support::files(&shared.join(folder), "toml") {
            let here = vehicle_file.parent().unwrap();
            let vehicle = load_vehicle(&vehicle_file).unwrap();
            let logs = support::files(here, "tlog").into_iter().chain(support::files(here, "csv"));
            let prefix = match vehicle_file.file_stem().unwrap().to_str().unwrap() {
                "ardupilot-quad" => "ap_",
                "px4-sih" => "px4_",
                _ => "",
            };
            for log in logs {
                let name = log.file_name().unwrap().to_str().unwrap();
                if !name.starts_with(prefix) {
                    continue;
                }
                let found = identified(&read(&log), &vehicle, ThrustPreference::Measured);
                let mass = &found.best.result.parameters[0].finding;
                assert!(matches!(mass, Finding::Determined { .. }), "{}: {mass:?}", log.display());
                count += 1;
            }
        }
    }
    assert!(count >= 16 + 21 + 4, "{count}");
}

#[test]
fn the_autopilots_masses_from_pulse_widths() {
    let Some(shared) = support::shared() else { return };
    let folder = shared.join("recordings/autopilots");
    for (log, vehicle, mass_kg, weak) in [
        ("ap_baseline.tlog", "ardupilot-quad.toml", 3.0, false),
        ("ap_wind5E.tlog", "ardupilot-quad.toml", 3.0, false),
        ("px4_baseline.tlog", "px4-sih.toml", 1.0, false),
        ("px4_motor1_85.tlog", "px4-sih.toml", 1.0, true),
    ] {
        let request = IdentifyRequest {
            logs: vec![folder.join(log)],
            vehicle: folder.join(vehicle).into(),
            ..IdentifyRequest::default()
        };
        let study = study::identify(&request, &Silent).unwrap();
        let mass = study.body().estimated.theta[0];
        assert!((mass / mass_kg - 1.0).abs() < 0.02, "{log}: {mass}");
        assert_eq!(study.identification.best.method, Method::Joint);
        assert_eq!(study.beside.contains(&"weak_rotor"), weak, "{log}: {:?}", study.beside);
    }
}

/// Every stream of the recording at no more samples a second than this.
fn thinned(recording: &Recording, rate_hz: f64, only: impl Fn(Quantity) -> bool) -> Recording {
    let mut out = recording.clone();
    for (_, stream) in out.streams.iter_mut().filter(|(key, _)| only(key.quantity)) {
        let mut slot = f64::NEG_INFINITY;
        let kept: Vec<usize> = (0..stream.len())
            .filter(|index| {
                let own = (stream.time_s[*index] * rate_hz).floor();
                own > std::mem::replace(&mut slot, own)
            })
            .collect();
        stream.values = kept.iter().flat_map(|index| stream.sample(*index).to_vec()).collect();
        stream.time_s = kept.iter().map(|index| stream.time_s[*index]).collect();
    }
    out
}

#[test]
fn a_thin_link_leaves_forces_alone_or_is_refused_with_its_rates_and_one_that_suffices_is_not() {
    let (whole, vehicle) =
        (read(&fixture("p01_identify_0_25s.tlog")), load_vehicle(&fixture("p01_vehicle.toml")).unwrap());
    let conditioned = |recording: &Recording| condition(recording, &vehicle, &ConditionSettings::default());
    let all = match conditioned(&thinned(&whole, 7.0, |_| true)) {
        Err(error @ SignalsError::TooSlow { .. }) => error.to_string(),
        other => panic!("{:?}", other.map(|signals| signals.quality.notes)),
    };
    for said in [
        "body rates (HIGHRES_IMU) at 7.",
        "(ESC_STATUS) at 7.",
        "8 Hz are the least",
        "the log that the vehicle writes",
    ] {
        assert!(all.contains(said), "{said}: {all}");
    }
    let driven = |quantity| matches!(quantity, Quantity::RotorSpeed | Quantity::ActuatorCommand);
    let forces_alone = |recording: &Recording| {
        let quality = conditioned(recording).unwrap().quality;
        assert!(!quality.torques, "{:?}", quality.notes);
        quality.notes[0].text.clone()
    };
    let actuators = forces_alone(&thinned(&whole, 15.0, driven));
    assert!(actuators.contains("rotor speeds (ESC_STATUS) at 15.0 Hz"), "{actuators}");
    assert!(!actuators.contains("body rates"), "{actuators}");
    let turning = |quantity| matches!(quantity, Quantity::AngularRate | Quantity::Attitude);
    let rates = forces_alone(&thinned(&whole, 12.0, turning));
    assert!(rates.contains("body rates") && !rates.contains("ESC_STATUS"), "{rates}");
    // above the least rates the numbers stay within their standard errors
    let full = identified(&whole, &vehicle, ThrustPreference::Measured);
    let some = identified(&thinned(&whole, 42.0, |_| true), &vehicle, ThrustPreference::Measured);
    let (full, some) = (full.best.result.estimated, some.best.result.estimated);
    for index in [0, 1, 4, 6] {
        let std = (full.covariance[(index, index)] + some.covariance[(index, index)]).sqrt();
        let off = (some.theta[index] - full.theta[index]).abs() / std;
        assert!(off < 3.0, "parameter {index} is {off:.1} standard errors off");
    }
}
