//! What follows from a vehicle's file.

use crate::config::{LoadedVehicle, effects_of};
use crate::note::Note;
use crate::physics::ActiveEffect;
use crate::text;
use crate::vehicle::{Actuator, Anchor, Spin, ThrustLaw, Vehicle};
use serde::Serialize;

/// What follows from the file.
#[derive(Debug, Serialize)]
pub struct VehicleSummary {
    /// version of the document
    pub schema: u32,
    /// as written
    pub name: String,
    /// as written
    pub mass_kg: f64,
    /// at `gravity_m_s2`
    pub weight_n: f64,
    /// where it flies
    pub gravity_m_s2: f64,
    /// kg m^2, body FLU, row by row
    pub inertia_kg_m2: [[f64; 3]; 3],
    /// kg m^2, ascending
    pub principal_moments_kg_m2: [f64; 3],
    /// what a command means
    pub actuator: String,
    /// one rotor
    pub thrust_law: String,
    /// N m for each N
    pub torque_per_thrust_m: f64,
    /// in the order of the file
    pub rotors: Vec<RotorSummary>,
    /// all rotors at u = 1
    pub thrust_max_n: f64,
    /// of that thrust
    pub thrust_to_weight: f64,
    /// equal share a rotor; none where full thrust does not lift the weight
    pub hover_command: Option<f64>,
    /// what is trusted, and what is identified
    pub anchor: String,
    /// how many the file holds
    pub effects: usize,
    /// each of them, one line: its id and its parameters, with unit
    pub effect_lines: Vec<String>,
    /// what is possible but hardly meant
    pub warnings: Vec<Note>,
}

/// One rotor and its column of the mixer.
#[derive(Debug, Serialize)]
pub struct RotorSummary {
    /// as written
    pub name: String,
    /// seen from above
    pub spin: &'static str,
    /// hub, m, body FLU
    pub position_m: [f64; 3],
    /// force and torque at the centre of mass per newton of this rotor's thrust
    pub wrench_per_thrust: [f64; 4],
}

/// What follows from a vehicle's file.
#[must_use]
pub fn vehicle_summary(loaded: &LoadedVehicle) -> VehicleSummary {
    let vehicle = &loaded.vehicle;
    let inertia = &vehicle.body.inertia_kg_m2;
    let mut moments: [f64; 3] = inertia.symmetric_eigenvalues().into();
    moments.sort_by(f64::total_cmp);
    let rotors = rotors(vehicle);
    let count = rotors.len() as f64;
    let weight_n = vehicle.body.mass_kg * vehicle.gravity_m_s2;
    let thrust_max_n = count * vehicle.propulsion.thrust_from_command_n(1.0);
    let hover = vehicle.propulsion.command_from_thrust(weight_n / count);
    VehicleSummary {
        schema: 1,
        name: vehicle.name.clone(),
        mass_kg: vehicle.body.mass_kg,
        weight_n,
        gravity_m_s2: vehicle.gravity_m_s2,
        inertia_kg_m2: std::array::from_fn(|row| std::array::from_fn(|column| inertia[(row, column)])),
        principal_moments_kg_m2: moments,
        actuator: actuator(vehicle),
        thrust_law: thrust_law(vehicle),
        torque_per_thrust_m: vehicle.propulsion.torque_per_thrust_m,
        rotors,
        thrust_max_n,
        thrust_to_weight: thrust_max_n / weight_n,
        hover_command: (thrust_max_n > weight_n).then_some(hover),
        anchor: match vehicle.anchor {
            Anchor::Thrust => "thrust: the mass is identified".to_owned(),
            Anchor::Mass => "mass: the thrust coefficient is identified".to_owned(),
        },
        effects: loaded.model.effects.len(),
        effect_lines: effect_lines(loaded),
        warnings: loaded.warnings.clone(),
    }
}

/// Those of a file were checked when it was read.
fn effect_lines(loaded: &LoadedVehicle) -> Vec<String> {
    let effects =
        effects_of(&loaded.model.effects, &loaded.vehicle.name, &loaded.vehicle).unwrap_or_default();
    effects.iter().map(|active| effect_line(active, &loaded.vehicle)).collect()
}

fn effect_line(active: &ActiveEffect, vehicle: &Vehicle) -> String {
    let effect = active.effect();
    let known = effect.parameters().iter().chain(effect.finer_parameters());
    let values: Vec<String> = known
        .zip(active.parameters())
        .map(|(parameter, value)| match (parameter.unit, vehicle.rotor_of(*value)) {
            (_, Some(index)) if parameter.is_rotor() => vehicle.motor_words(index),
            ("-", _) => format!("{} {}", parameter.name, text::compact(*value)),
            (unit, _) => format!("{} {} {unit}", parameter.name, text::compact(*value)),
        })
        .collect();
    format!("{}: {}", effect.id(), values.join(", "))
}

fn rotors(vehicle: &Vehicle) -> Vec<RotorSummary> {
    let matrix = vehicle.mixer().matrix;
    let mut rotors = Vec::with_capacity(vehicle.rotors.len());
    for (rotor, column) in vehicle.rotors.iter().zip(matrix.column_iter()) {
        rotors.push(RotorSummary {
            name: rotor.name.clone(),
            spin: if rotor.spin == Spin::Cw { "cw" } else { "ccw" },
            position_m: rotor.position_m.into(),
            // + 0.0 turns a negative zero into zero
            wrench_per_thrust: std::array::from_fn(|row| column[row] + 0.0),
        });
    }
    rotors
}

fn actuator(vehicle: &Vehicle) -> String {
    match vehicle.propulsion.actuator {
        Actuator::Speed => "u in 0..1, fraction of the largest rotor speed".to_owned(),
        Actuator::Thrust => "u in 0..1 through the thrust law".to_owned(),
        Actuator::Pwm(None) => "duty cycle in 0..1".to_owned(),
        Actuator::Pwm(Some(range)) => {
            format!("pulse width, u = 0 at {} us and u = 1 at {} us", range.min_us, range.max_us)
        }
    }
}

fn thrust_law(vehicle: &Vehicle) -> String {
    match vehicle.propulsion.law {
        ThrustLaw::Speed { speed_max_rad_s } => {
            let coefficient = vehicle.propulsion.thrust_coefficient.unwrap_or(f64::NAN);
            format!("{coefficient:.4e} N/(rad/s)^2 * (u * {speed_max_rad_s} rad/s)^2")
        }
        ThrustLaw::Curve { thrust_max_n, expo } => {
            let [linear, quadratic] = [1.0 - expo, expo].map(text::compact);
            format!("{} N * ({linear} u + {quadratic} u^2)", text::compact(thrust_max_n))
        }
    }
}
