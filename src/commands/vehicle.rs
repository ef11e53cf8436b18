//! `mavid vehicle FILE`: checks a vehicle file and says what it means.

use std::fmt::Write;

use mavid::config::{LoadedVehicle, read_vehicle};
use mavid::vehicle::{Actuator, Anchor, Spin, ThrustLaw, Vehicle};
use serde::Serialize;

use super::{CommandError, Outcome, output};
use crate::cli::VehicleArgs;

/// Names of the mixer's rows.
const WRENCH: [&str; 4] = ["force_z_n", "torque_x_nm", "torque_y_nm", "torque_z_nm"];

/// What follows from the file.
#[derive(Debug, Serialize)]
struct Summary {
    schema: u32,
    name: String,
    mass_kg: f64,
    weight_n: f64,
    gravity_m_s2: f64,
    /// kg m^2, body FLU, row by row
    inertia_kg_m2: [[f64; 3]; 3],
    /// kg m^2, ascending
    principal_moments_kg_m2: [f64; 3],
    actuator: String,
    thrust_law: String,
    torque_per_thrust_m: f64,
    rotors: Vec<RotorSummary>,
    /// all rotors at u = 1
    thrust_max_n: f64,
    thrust_to_weight: f64,
    /// equal share a rotor; none where full thrust does not lift the weight
    hover_command: Option<f64>,
    anchor: String,
    effects: usize,
    warnings: Vec<String>,
}

/// One rotor and its column of the mixer.
#[derive(Debug, Serialize)]
struct RotorSummary {
    name: String,
    spin: &'static str,
    position_m: [f64; 3],
    /// force and torque at the centre of mass per newton of this rotor's thrust
    wrench_per_thrust: [f64; 4],
}

/// Runs the verb.
pub fn run(json: bool, args: &VehicleArgs) -> Result<Outcome, CommandError> {
    let summary = summarize(read_vehicle(&args.file)?);
    output::warnings(&args.file, &summary.warnings);
    if json {
        output::json(&summary)?
    } else {
        output::text(&page(&summary))?
    }
    Ok(Outcome::Done)
}

fn summarize(loaded: LoadedVehicle) -> Summary {
    let vehicle = &loaded.vehicle;
    let inertia = &vehicle.body.inertia_kg_m2;
    let mut moments: [f64; 3] = inertia.symmetric_eigenvalues().into();
    moments.sort_by(f64::total_cmp);
    let rotors = rotors(vehicle);
    let count = rotors.len() as f64;
    let weight_n = vehicle.body.mass_kg * vehicle.gravity_m_s2;
    let thrust_max_n = count * vehicle.propulsion.thrust_from_command_n(1.0);
    let hover = vehicle.propulsion.command_from_thrust(weight_n / count);
    Summary {
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
        warnings: loaded.warnings,
    }
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
            format!("{thrust_max_n} N * ({} u + {expo} u^2)", 1.0 - expo)
        }
    }
}

/// The summary for people.
fn page(summary: &Summary) -> String {
    let [small, middle, large] = summary.principal_moments_kg_m2;
    let hover = summary.hover_command.map_or("none: it cannot lift itself".to_owned(), |u| format!("{u:.4}"));
    let mut page = format!(
        "{}\n  mass                {} kg, weight {:.3} N at {} m/s^2\n  principal moments   {small:.4e}, {middle:.4e}, {large:.4e} kg m^2\n",
        summary.name, summary.mass_kg, summary.weight_n, summary.gravity_m_s2
    );
    let lines = [
        ("actuator", summary.actuator.clone()),
        ("one rotor's thrust", summary.thrust_law.clone()),
        ("torque per thrust", format!("{:.5} m", summary.torque_per_thrust_m)),
        (
            "full thrust",
            format!("{:.3} N, {:.2} of the weight", summary.thrust_max_n, summary.thrust_to_weight),
        ),
        ("hover command u", hover),
        ("anchor", summary.anchor.clone()),
    ];
    for (name, value) in lines {
        // writing to a String cannot fail
        let _ = writeln!(page, "  {name:<20}{value}");
    }
    let _ = writeln!(page, "  mixer, per newton of each rotor (body FLU, at the centre of mass)");
    let _ = writeln!(
        page,
        "    {:<20}{:>5}{:>12}{:>13}{:>13}{:>13}",
        "rotor", "spin", WRENCH[0], WRENCH[1], WRENCH[2], WRENCH[3]
    );
    for rotor in &summary.rotors {
        let [fz, tx, ty, tz] = rotor.wrench_per_thrust;
        let _ =
            writeln!(page, "    {:<20}{:>5}{fz:>12.4}{tx:>13.5}{ty:>13.5}{tz:>13.5}", rotor.name, rotor.spin);
    }
    page.truncate(page.trim_end().len());
    page
}
