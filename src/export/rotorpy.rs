//! RotorPy's parameter dictionary.
//!
//! `T = k_eta w^2`, reaction `k_m w^2`, hub force `-w diag(k_d, k_d, k_z) v`, hub moment `-k_flap w v x e_z`,
//! `T += k_h v_xy^2`, body drag `-|v| diag(c_D) v`, lag `tau_m`; hubs from the centre of mass. Frames and units
//! are ours; the sign of a rotor is that of its reaction torque.

use super::drag::RotorDrag;
use super::error::ExportError;
use super::notes::line_comments;
use super::source::{Exported, FAST_S, Source};
use crate::text::line_comment;
use nalgebra::Vector3;
use std::fmt::Write;

const FORMAT: &str = "rotorpy";

pub(super) fn write(mut source: Source<'_>) -> Result<Exported, ExportError> {
    let (coefficient, speed_max) = source.speeds(FORMAT)?;
    let count = source.vehicle.rotors.len() as f64;
    let hover = source.hover_rad_s(coefficient);
    let radius_m = source.vehicle.propulsion.rotor_radius_m;
    if radius_m.is_none() {
        source.note("the rotors' radius is not known; RotorPy uses it for drawing: 0.1 m");
    }
    let drag = RotorDrag::of(&mut source);
    let across = drag.even_across(&mut source, "k_d");
    drag.tell_at_hubs(&mut source);
    if source.take("quadratic_drag", "by_face") > 0.05 {
        source.note("RotorPy's drag of the body goes with the whole airspeed, the model's along an axis with the speed along it");
    }
    let lag_s = source.mean_lag_s().unwrap_or(FAST_S);
    let per_rotor = |whole: f64| whole / (count * hover);
    let body = source.vehicle.body.clone();
    let j = &body.inertia_kg_m2;
    let values = [
        ("mass", body.mass_kg),
        ("Ixx", j[(0, 0)]),
        ("Iyy", j[(1, 1)]),
        ("Izz", j[(2, 2)]),
        ("Ixy", j[(0, 1)]),
        ("Iyz", j[(1, 2)]),
        ("Ixz", j[(0, 2)]),
        ("rotor_radius", radius_m.unwrap_or(0.1)),
        ("c_Dx", source.take("quadratic_drag", "cx")),
        ("c_Dy", source.take("quadratic_drag", "cy")),
        ("c_Dz", source.take("quadratic_drag", "cz")),
        ("k_eta", coefficient),
        ("k_m", coefficient * source.vehicle.propulsion.torque_per_thrust_m),
        ("k_d", per_rotor(across)),
        ("k_z", per_rotor(drag.force.z)),
        ("k_h", source.take("translational_lift", "kh") / count),
        ("k_flap", per_rotor(source.take("blade_flapping", "k"))),
        ("tau_m", lag_s),
        ("rotor_speed_min", 0.0),
        ("rotor_speed_max", speed_max),
        ("motor_noise_std", 0.0),
    ];
    let arms = source.arms_m();
    let wind = ["north", "west", "up"].map(|axis| source.take("steady_wind", axis));
    if wind.iter().any(|part| *part != 0.0) {
        source.note(format!(
            "wind is the simulation's, not the vehicle's: ConstantWind({}, {}, {}) for x north, y west",
            wind[0], wind[1], wind[2]
        ));
    }
    let directions: Vec<String> =
        source.vehicle.rotors.iter().map(|rotor| format!("{}", rotor.spin.yaw_sign())).collect();
    let title = line_comment("#", &format!("{}: RotorPy parameters, SI", source.vehicle.name));
    Ok(source.finish(|notes| {
        let head = format!("{title}{}import numpy as np\n\n", line_comments("#", notes));
        head + &dictionary(&values, &arms, &directions)
    }))
}

/// The assignment of the dictionary; hubs (m, body) from the centre of mass.
fn dictionary(values: &[(&str, f64)], arms: &[Vector3<f64>], directions: &[String]) -> String {
    let mut text = "quad_params = {\n".to_owned();
    for (key, value) in values {
        let _ = writeln!(text, "    '{key}': {value:?},");
    }
    let _ = writeln!(text, "    'num_rotors': {},\n    'rotor_pos': {{", arms.len());
    for (number, arm) in (1..).zip(arms) {
        let _ = writeln!(text, "        'r{number}': np.array([{:?}, {:?}, {:?}]),", arm.x, arm.y, arm.z);
    }
    let _ = writeln!(
        text,
        "    }},\n    'rotor_directions': np.array([{}]),\n    'rI': np.array([0.0, 0.0, 0.0]),\n}}",
        directions.join(", ")
    );
    text
}
