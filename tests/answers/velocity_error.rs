//! An autopilot's velocity is wrong slowly. With a drag that makes a slow force, which is no change of mass and no sagging
//! battery; a change of mass in the same flight is still named.

use mavid::diagnose::{ExplainSettings, Explanation, explain};
use mavid::note::Note;
use mavid::physics::ActiveEffect;
use mavid::recording::{Quantity, Recording};
use mavid::signals::{ConditionSettings, Signals, ThrustPreference, condition};
use mavid::simulate::{FlightSettings, RandomTrajectory, Reference, Truth, random_vehicle, simulate_flight};
use mavid::vehicle::Vehicle;

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

/// A flight with a drag and, as a share of the mass, a change of mass; the vehicle file with it.
fn flown(seed: u64, mass_change: Option<f64>) -> (Recording, Vehicle) {
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
    (simulate_flight(truth, &pair.nominal, &reference, &settings).unwrap().recording, pair.nominal)
}

fn conditioned(recording: &Recording, vehicle: &Vehicle) -> Signals {
    let how = ConditionSettings { thrust: ThrustPreference::Commands, ..ConditionSettings::default() };
    condition(recording, vehicle, &how).unwrap()
}

fn explained(seed: u64, mass_change: Option<f64>) -> Explanation {
    let (mut recording, vehicle) = flown(seed, mass_change);
    add_error(&mut recording);
    explain(&[conditioned(&recording, &vehicle)], &vehicle, &ExplainSettings::default()).unwrap()
}

/// Root mean square by which the vertical velocities of two flights differ on their grid, m/s.
fn apart_m_s(a: &Signals, b: &Signals) -> f64 {
    let (a, b) = (a.velocity.as_ref().unwrap(), b.velocity.as_ref().unwrap());
    let squares = a.iter().zip(b.iter()).map(|(a, b)| (a.z - b.z).powi(2));
    (squares.sum::<f64>() / a.len() as f64).sqrt()
}

#[test]
fn the_position_tells_the_error() {
    let (mut recording, vehicle) = flown(21, None);
    let right = conditioned(&recording, &vehicle);
    add_error(&mut recording);
    let apart = apart_m_s(&conditioned(&recording, &vehicle), &right);
    assert!(apart < 0.02, "{apart} m/s");
}

#[test]
fn a_position_that_contradicts_the_velocity_tells_nothing() {
    let (mut recording, vehicle) = flown(21, None);
    let right = conditioned(&recording, &vehicle);
    let positions = recording.streams.iter_mut().filter(|(key, _)| key.quantity == Quantity::Position);
    positions.for_each(|(_, stream)| stream.values.iter_mut().for_each(|value| *value *= 100.0));
    let found = conditioned(&recording, &vehicle);
    let contradicts = |note: &Note| note.text.contains("the position north changes by 100");
    assert!(found.quality.notes.iter().any(contradicts), "{:?}", found.quality.notes);
    let apart = apart_m_s(&found, &right);
    assert!(apart < 0.02, "{apart} m/s");
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
