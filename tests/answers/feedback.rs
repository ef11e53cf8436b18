//! Flights in turbulence: where nothing excites the rotation but the air, the torque answers the motion, and ordinary
//! regression finds the controller. Its inertia is no inertia and is not given.

use mavid::diagnose::{ExplainSettings, explain};
use mavid::estimate::{Finding, IdentifySettings, Nominal, Parameter, finding, identify};
use mavid::physics::{State, Wrench};
use mavid::signals::{ConditionSettings, Signals, ThrustPreference, condition};
use mavid::simulate::{
    Disturbance, FlightSettings, RandomTrajectory, Reference, Truth, random_vehicle, simulate_flight,
};
use nalgebra::{Matrix3, Vector3};
use std::f64::consts::TAU;

/// Places of Ixx, Iyy, Izz among the parameters.
const MOMENTS: [usize; 3] = [1, 4, 6];

/// Torque of the air: tones from 0.06 to 6 Hz with the spectrum of turbulence, of this angular acceleration each, rad/s^2.
fn turbulence(inertia: Matrix3<f64>, seed: u64, each_rad_s2: f64) -> Disturbance {
    let tones: Vec<(f64, Vector3<f64>)> = (1..40)
        .map(|tone| {
            let hz = 0.05 * 1.13_f64.powi(tone);
            let draw = |factor: f64| (f64::from(tone) * factor + seed as f64).sin();
            (hz, Vector3::new(draw(12.9), draw(78.2), draw(37.7)) / (1.0 + 2.0 * hz))
        })
        .collect();
    Disturbance::new(move |time_s: f64, _: &State| {
        let sum: Vector3<f64> = tones
            .iter()
            .enumerate()
            .map(|(tone, (hz, size))| size * (TAU * hz * time_s + 2.4 * tone as f64).sin())
            .sum();
        Wrench { force_n: Vector3::zeros(), torque_nm: inertia * sum * each_rad_s2 }
    })
}

/// A flight of the seed's vehicle, after `hover_s` of hover along its trajectory.
fn flown(seed: u64, hover_s: f64, each_rad_s2: f64) -> Signals {
    let pair = random_vehicle(seed);
    let inertia = pair.truth.body.inertia_kg_m2;
    let trajectory = RandomTrajectory::default().draw(seed).unwrap();
    let reference = Reference { trajectory, hover_s, ramp_s: 2.0 };
    let disturbance = Some(turbulence(inertia, seed, each_rad_s2));
    let truth = Truth { vehicle: pair.truth, effects: Vec::new(), disturbance };
    let settings = FlightSettings { seed, duration_s: 50.0, ..FlightSettings::default() };
    let flight = simulate_flight(truth, &pair.nominal, &reference, &settings).unwrap();
    let settings = ConditionSettings { thrust: ThrustPreference::Commands, ..ConditionSettings::default() };
    condition(&flight.recording, &pair.nominal, &settings).unwrap()
}

fn moments(signals: Signals, seed: u64) -> [Parameter; 3] {
    let found = identify(&[signals], &random_vehicle(seed).nominal, &IdentifySettings::default()).unwrap();
    MOMENTS.map(|index| found.best.result.parameters[index].clone())
}

#[test]
fn a_hover_in_turbulence_gives_no_inertia_by_any_method() {
    for (seed, each_rad_s2) in [(1, 0.6), (3, 6.0), (8, 6.0)] {
        let signals = flown(seed, 60.0, each_rad_s2);
        let found =
            identify(&[signals], &random_vehicle(seed).nominal, &IdentifySettings::default()).unwrap();
        for method in &found.methods {
            for index in MOMENTS {
                let Parameter { name, finding, .. } = &method.parameters[index];
                assert!(
                    matches!(finding, Finding::NotDetermined { .. }),
                    "{} of seed {seed}: {name} {finding:?}",
                    method.method.name()
                );
            }
        }
    }
}

#[test]
fn explain_says_how_little_of_that_torque_the_inertia_explains() {
    let found =
        explain(&[flown(1, 60.0, 0.6)], &random_vehicle(1).nominal, &ExplainSettings::default()).unwrap();
    let body = found.search.after.rigid_body();
    let nominal = Nominal::of(&random_vehicle(1).nominal);
    for index in MOMENTS {
        let judged = finding(&body, &nominal, index);
        let Finding::NotDetermined { reason } = judged else { panic!("{judged:?}") };
        assert!(
            reason.contains("of its size") || reason.contains("the rigid body explains only"),
            "{reason}"
        );
    }
}

/// Control is fast enough here that the rigid body explains 70 % of its torque with six tenths of the true inertia.
#[test]
fn what_depends_on_the_window_is_said_to_come_from_feedback() {
    let [ixx, iyy, _] = moments(flown(8, 60.0, 6.0), 8);
    for (parameter, axis) in [(ixx, "about x"), (iyy, "about y")] {
        let Finding::NotDetermined { reason } = parameter.finding else { panic!("{parameter:?}") };
        assert!(reason.contains("a window of twice the width gives 0."), "{reason}");
        assert!(reason.contains("feedback control") && reason.contains(axis), "{reason}");
    }
}

#[test]
fn a_trajectory_in_turbulence_determines_the_inertia() {
    for seed in [2, 6] {
        let inertia = random_vehicle(seed).truth.body.inertia_kg_m2;
        for (axis, parameter) in moments(flown(seed, 4.0, 0.3), seed).into_iter().enumerate() {
            let Finding::Determined { value, std } = parameter.finding else { panic!("{parameter:?}") };
            let truth = inertia[(axis, axis)];
            assert!((value - truth).abs() < 4.0 * std, "{}: {value} +- {std}, {truth}", parameter.name);
        }
    }
}
