use super::*;
use crate::physics::{RIGID_STATES, RigidBodyModel, State, Wrench};
use crate::vehicle::RigidBody;
use nalgebra::{Matrix3, UnitQuaternion, Vector3};

type Vector = SVector<f64, RIGID_STATES>;

fn body() -> RigidBodyModel {
    let inertia = Matrix3::new(0.012, -0.0008, 0.0001, -0.0008, 0.015, -0.0006, 0.0001, -0.0006, 0.022);
    let body = RigidBody { mass_kg: 1.8, inertia_kg_m2: inertia, center_of_mass_m: Vector3::zeros() };
    RigidBodyModel::new(&body, 9.81).unwrap()
}

fn free(model: RigidBodyModel) -> impl FnMut(f64, &Vector) -> Vector {
    move |_, vector| {
        let mut out = Vector::zeros();
        model.derivative(&State::read(vector), &Wrench::zero()).write(&mut out);
        out
    }
}

fn tumbling() -> Vector {
    let state = State {
        position_m: Vector3::new(0.0, 0.0, 100.0),
        velocity_m_s: Vector3::new(1.0, -2.0, 3.0),
        attitude: UnitQuaternion::from_euler_angles(0.2, -0.4, 1.0),
        rates_rad_s: Vector3::new(0.1, 6.0, -0.2),
    };
    let mut vector = Vector::zeros();
    state.write(&mut vector);
    vector
}

fn rk4(from: &Vector, end_s: f64, steps: u32) -> Vector {
    let mut f = free(body());
    let step_s = end_s / f64::from(steps);
    (0..steps).fold(*from, |state, step| rk4_step(&mut f, f64::from(step) * step_s, &state, step_s))
}

#[test]
fn free_fall_is_a_parabola() {
    let end = State::read(&rk4(&tumbling(), 2.0, 200));
    // 100 + 3 * 2 - 9.81 * 2^2 / 2
    assert!((end.position_m - Vector3::new(2.0, -4.0, 86.38)).norm() < 1e-9);
    assert!((end.velocity_m_s - Vector3::new(1.0, -2.0, 3.0 - 19.62)).norm() < 1e-9);
}

#[test]
fn torque_free_tumbling_keeps_energy_and_angular_momentum() {
    let model = body();
    let energy = |s: &State| s.rates_rad_s.dot(&(model.inertia_kg_m2 * s.rates_rad_s)) / 2.0;
    let momentum = |s: &State| s.attitude * (model.inertia_kg_m2 * s.rates_rad_s);
    let start = State::read(&tumbling());
    let end = State::read(&rk4(&tumbling(), 5.0, 5000));
    assert!((energy(&end) / energy(&start) - 1.0).abs() < 1e-8);
    assert!((momentum(&end) - momentum(&start)).norm() / momentum(&start).norm() < 1e-7);
    // about the middle axis it does tumble: the rates did change
    assert!((end.rates_rad_s - start.rates_rad_s).norm() > 0.5);
}

#[test]
fn rk4_is_of_fourth_order() {
    let exact = rk4(&tumbling(), 1.0, 4096);
    let error = |steps| (rk4(&tumbling(), 1.0, steps) - exact).norm();
    let order = (error(64) / error(128)).log2();
    assert!((order - 4.0).abs() < 0.3, "order {order}");
}

#[test]
fn dormand_prince_agrees_with_rk4() {
    let tolerance = Tolerance { absolute: 1e-11, relative: 1e-11, ..Tolerance::default() };
    let adaptive = dormand_prince(&mut free(body()), (0.0, 2.0), &tumbling(), &tolerance).unwrap();
    assert!((adaptive - rk4(&tumbling(), 2.0, 8000)).norm() < 1e-8);
}

#[test]
fn dormand_prince_follows_an_exponential_to_its_tolerance() {
    let mut decay = |_: f64, x: &SVector<f64, 1>| x * -3.0;
    for tolerance in [1e-6, 1e-9, 1e-12] {
        let settings = Tolerance { absolute: tolerance, relative: tolerance, ..Tolerance::default() };
        let end = dormand_prince(&mut decay, (0.0, 1.0), &SVector::from([1.0]), &settings).unwrap();
        assert!((end[0] - (-3.0_f64).exp()).abs() < 10.0 * tolerance);
    }
}

#[test]
fn dormand_prince_gives_up_at_a_pole() {
    // x' = x^2 from 1 ends at t = 1
    let mut blow_up = |_: f64, x: &SVector<f64, 1>| x.component_mul(x);
    let end = dormand_prince(&mut blow_up, (0.0, 2.0), &SVector::from([1.0]), &Tolerance::default());
    assert!(matches!(end, Err(SimulateError::StepTooSmall { .. })));
}
