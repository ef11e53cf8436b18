//! A line leads down to the ground.

use nalgebra::Vector3;

use crate::physics::equation::documented;
use crate::physics::{Bounds, Condition, Effect, Hook, Own, Parameter, Rotors, Wrench};

documented! {
    /// The lifted part of the line weighs `line_mass` per metre of height. Beyond `length` from its anchor at the origin
    /// of the world, the line pulls back like a spring:
    /// `F = -line_mass z (g + carried a_z) e_z - stiffness (|p| - length)+ p / |p|` at the centre of mass. `carried`, in
    /// the finer form, is the share of the line that moves up and down with the vehicle: 1 for a line that hangs free, 0
    /// (the default) for one that is paid out. a_z is the acceleration that the rotors give vehicle and line.
    #[derive(Debug, Clone, Copy)]
    pub struct Tether;
}

const PARAMETERS: &[Parameter] = &[
    Parameter { name: "line_mass", unit: "kg/m", bounds: Bounds::of(0.0, 0.5).by_mass() },
    Parameter { name: "stiffness", unit: "N/m", bounds: Bounds::of(0.0, 1000.0).by_mass() },
    Parameter { name: "length", unit: "m", bounds: Bounds::of(0.5, 500.0) },
];

const FINER: &[Parameter] = &[Parameter { name: "carried", unit: "-", bounds: Bounds::of(0.0, 1.0) }];

fn in_body(at: &Condition, world_n: Vector3<f64>) -> Wrench {
    let force_n = at.state.attitude.inverse_transform_vector(&world_n);
    Wrench { force_n, torque_nm: Vector3::zeros() }
}

/// Line off the ground, m.
fn lifted_m(at: &Condition) -> f64 {
    at.state.position_m.z.max(0.0)
}

/// World force for one kg/m of line that is not carried.
fn weight_per_mass(at: &Condition) -> Vector3<f64> {
    Vector3::z() * (-at.airframe.gravity_m_s2 * lifted_m(at))
}

/// What it takes to accelerate a line of `line_kg`, of which `carried` goes with the vehicle, world, N.
fn inertia_n(at: &Condition, rotors: &Rotors, line_kg: f64, carried: f64) -> Vector3<f64> {
    let lift_n = (at.state.attitude * at.thrust_wrench(&rotors.thrust_n).force_n).z;
    let weight_n = (at.airframe.mass_kg + line_kg) * at.airframe.gravity_m_s2;
    let moved_kg = at.airframe.mass_kg + carried * line_kg;
    Vector3::z() * (-carried * line_kg * (lift_n - weight_n) / moved_kg)
}

/// How far the line is stretched, outwards, world, m.
fn stretch(at: &Condition, length_m: f64) -> Vector3<f64> {
    let away_m = at.state.position_m.norm();
    if away_m > length_m { at.state.position_m * (1.0 - length_m / away_m) } else { Vector3::zeros() }
}

impl Effect for Tether {
    fn id(&self) -> &'static str {
        "tether"
    }

    fn sentence(&self) -> &'static str {
        "A line leads down to the ground: it weighs more the higher the vehicle, and holds it back when taut."
    }

    fn equation(&self) -> &'static str {
        Self::EQUATION
    }

    fn parameters(&self) -> &'static [Parameter] {
        PARAMETERS
    }

    fn finer_parameters(&self) -> &'static [Parameter] {
        FINER
    }

    fn hooks(&self) -> &'static [Hook] {
        &[Hook::Wrench]
    }

    fn wrench(&self, at: &Condition, rotors: &Rotors, own: &mut Own, sum: &mut Wrench) {
        let [line_kg_m, stiffness_n_m, length_m] = [own.parameters[0], own.parameters[1], own.parameters[2]];
        let carried = own.parameters.get(PARAMETERS.len()).copied().unwrap_or(0.0);
        let inertia_n = inertia_n(at, rotors, line_kg_m * lifted_m(at), carried);
        let weight_n = weight_per_mass(at) * line_kg_m;
        *sum += in_body(at, weight_n + inertia_n - stretch(at, length_m) * stiffness_n_m);
    }

    fn has_regressor(&self) -> bool {
        true
    }

    fn regressor(&self, at: &Condition, _rotors: &Rotors, parameters: &[f64], columns: &mut [Wrench]) {
        let [by_mass, by_stiffness, by_length] = columns else { return };
        let stretch = stretch(at, parameters[2]);
        *by_mass = in_body(at, weight_per_mass(at));
        *by_stiffness = in_body(at, -stretch);
        *by_length = in_body(at, stretch.try_normalize(0.0).unwrap_or_default() * parameters[1]);
    }
}
