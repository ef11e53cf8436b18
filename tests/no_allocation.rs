//! A step of a simulation takes no memory from the heap, whatever acts.

#![allow(clippy::unwrap_used, reason = "a test ends where it fails")]

use mavid::physics::effects::ALL;
use mavid::physics::{ActiveEffect, Bounds, Input, Model, State};
use mavid::simulate::{GroundContact, GroundSettings, Plant, random_vehicle};
use nalgebra::Vector3;

#[test]
fn no_step_allocates() {
    let mut vehicle = random_vehicle(1).truth;
    // as many rotors as fit
    let more = vehicle.rotors.clone();
    vehicle.rotors.extend(more);
    let size = vehicle.size();
    let middle = |effect: &'static dyn mavid::physics::Effect| {
        let within = |bounds: Bounds| {
            let (least, greatest) = bounds.at(&size);
            0.7 * least + 0.3 * greatest
        };
        let values: Vec<f64> = effect.parameters().iter().map(|p| within(p.bounds)).collect();
        ActiveEffect::new(effect, &values).unwrap()
    };
    let model = Model::new(&vehicle, ALL.iter().map(|effect| middle(*effect)).collect()).unwrap();
    assert_eq!(model.own_state_count(), 14);
    let ground = GroundContact::new(&model.airframe, GroundSettings::default());
    let push = |_: f64, state: &State| ground.wrench(state);
    let mut input = Input::from_commands(&model.airframe, 0.0, &[0.5; 8]);
    input.battery_voltage_v = Some(15.0);
    let start = State::at_rest(Vector3::new(0.1, 0.2, 0.05), 0.3);
    let mut plant = Plant::new(&model, Some(&push), &start, &input).unwrap();
    let used = allocation_counter::measure(|| {
        for _ in 0..1000 {
            plant.step(&input, 1e-3);
            std::hint::black_box(plant.evaluate(&input));
        }
    });
    assert_eq!(used.count_total, 0);
    // and the counter counts
    assert!(allocation_counter::measure(|| drop(std::hint::black_box(vec![1.0; 100]))).count_total > 0);
}
