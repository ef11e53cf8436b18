//! An autopilot's velocity is wrong slowly. With a drag that makes a slow force, which is no change of mass and no sagging
//! battery; a change of mass in the same flight is still named.

use mavid::diagnose::{ExplainSettings, Explanation, explain};
use mavid::physics::ActiveEffect;
use mavid::recording::{Quantity, Recording};
use mavid::signals::{ConditionSettings, ThrustPreference, condition};
use mavid::simulate::{FlightSettings, RandomTrajectory, Reference, Truth, random_vehicle, simulate_flight};

/// Adds a slow error to the vertical velocity: 0.17 m/s rms.
fn add_error(recording: &mut Recording) {
    for (key, stream) in &mut recording.streams {
        if key.quantity != Quantity::Velocity {
            continue;
        }
        for (time_s, velocity_m_s) in stream.time_s.iter().zip(stream.values.chunks_exact_mut(3)) {
            velocity_m_s[2] += 0.2 * (time_s / 4.1).sin() + 0.14 * (time_s / 2.3 + 1.0).sin();
        }
    }
}

fn explained(seed: u64, mass_change: Option<f64>) -> Explanation {
    let pair = random_vehicle(seed);
    let size = pair.truth.size();
    let drag = 0.7 * size.mass_kg;
    let named = |id: &str, values: &[(&str, f64)]| ActiveEffect::named(id, values, &size).unwrap();
    let mut effects = vec![named("linear_drag", &[("dx", drag), ("dy", drag), ("dz", drag)])];
    effects.extend(
        mass_change.map(|share| named("mass_change", &[("time", 22.0), ("delta", share * size.mass_kg)])),
    );
    let trajectory = RandomTrajectory::default().draw(seed).unwrap();
    let reference = Reference { trajectory, hover_s: 4.0, ramp_s: 2.0 };
    let truth = Truth { vehicle: pair.truth, effects, disturbance: None };
    let settings = FlightSettings { seed, duration_s: 40.0, ..FlightSettings::default() };
    let mut recording = simulate_flight(truth, &pair.nominal, &reference, &settings).unwrap().recording;
    add_error(&mut recording);
    let how = ConditionSettings { thrust: ThrustPreference::Commands, ..ConditionSettings::default() };
    let signals = condition(&recording, &pair.nominal, &how).unwrap();
    explain(&[signals], &pair.nominal, &ExplainSettings::default()).unwrap()
}

fn names(found: &Explanation) -> Vec<&str> {
    found.named.iter().map(|named| named.id).collect()
}

#[test]
fn a_slow_error_of_the_velocity_is_not_named() {
    for seed in [21, 22, 23] {
        let found = explained(seed, None);
        assert_eq!(names(&found), ["linear_drag"], "seed {seed}");
    }
}

#[test]
fn a_change_of_mass_beside_it_is_named() {
    let found = explained(21, Some(-0.12));
    assert!(names(&found).contains(&"mass_change"), "{:?}", names(&found));
}
