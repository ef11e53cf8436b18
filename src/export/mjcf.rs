//! MuJoCo: a free body with one thrust a rotor.
//!
//! A `general` actuator at each hub: control is the thrust in newtons, gear its force along body z and its
//! reaction torque. Of a weak rotor, control is the thrust that it would have, and the force of the gear its factor.
//! `fullinertia` is xx yy zz xy xz yz about the centre of mass. Frames and units are ours.
//!
//! An actuator at a site measures the velocity of that site along its gear, so that one with no gain and the bias
//! `0 0 -d` is a drag in body axes. A drag at all hubs is one at their mean, and a damping of the rotation by how far
//! they are from it. What no actuator makes is a callback's ([`super::callback`]).

use super::callback::{HeldDrag, callback};
use super::drag::{RotorDrag, damping, mean};
use super::error::ExportError;
use super::notes::xml_comments;
use super::source::{Exported, Source};
use crate::text::markup;
use nalgebra::Vector3;
use std::fmt::Write;

/// s, a step of the simulation.
const STEP_S: f64 = 0.002;

pub(super) fn write(mut source: Source<'_>) -> Result<Exported, ExportError> {
    let center = source.center_of_mass_m();
    let (mut sites, mut actuators) = (String::new(), String::new());
    thrusts(&mut source, &mut sites, &mut actuators);
    let resistance = Resistance::of(&mut source);
    resistance.write(&mut sites, &mut actuators);
    let factors = source.rotor_factors();
    let drag = HeldDrag { force: resistance.drag, place_m: resistance.place_m };
    if let Some(callback) = callback(&mut source, &drag, &factors) {
        source.call_back(callback);
    }
    let body = &source.vehicle.body;
    let j = &body.inertia_kg_m2;
    let inertial = format!(
        "      <inertial pos=\"{} {} {}\" mass=\"{}\" fullinertia=\"{} {} {} {} {} {}\"/>\n",
        center.x,
        center.y,
        center.z,
        body.mass_kg,
        j[(0, 0)],
        j[(1, 1)],
        j[(2, 2)],
        j[(0, 1)],
        j[(0, 2)],
        j[(1, 2)]
    );
    let option = format!(
        "  <option timestep=\"{STEP_S}\" integrator=\"RK4\" gravity=\"0 0 {}\"/>\n",
        -source.vehicle.gravity_m_s2
    );
    let name = markup(&source.vehicle.name);
    Ok(source.finish(|notes| {
        format!(
            "{}<mujoco model=\"{name}\">\n{option}  <worldbody>\n    <body name=\"vehicle\">\n      <freejoint/>\n{inertial}{sites}    </body>\n  </worldbody>\n  <actuator>\n{actuators}  </actuator>\n</mujoco>\n",
            xml_comments(notes)
        )
    }))
}

/// A site and an actuator a rotor.
fn thrusts(source: &mut Source<'_>, sites: &mut String, actuators: &mut String) {
    let thrust_max_n = source.thrust_max_n();
    let dynamics = source.mean_lag_s().map_or_else(
        || "dyntype=\"none\"".to_owned(),
        |lag_s| format!("dyntype=\"filterexact\" dynprm=\"{lag_s}\""),
    );
    if source.lags_s().is_some() {
        source.note(
            "the lag acts on the thrust here and on the rotor speed in the model: the same for small changes",
        );
    }
    source.note("controls are thrusts in newtons: the law from command to thrust is the autopilot's side");
    let factors = source.rotor_factors();
    if factors.iter().any(|factor| (factor - 1.0).abs() > 0.0) {
        source.note("the thrust of a weak rotor is its control times the force of its gear: its control is that of a rotor that is not weak");
    }
    for (number, (rotor, factor)) in source.vehicle.rotors.iter().zip(factors).enumerate() {
        let p = rotor.position_m;
        let torque = factor * rotor.spin.yaw_sign() * source.vehicle.propulsion.torque_per_thrust_m;
        let _ = writeln!(sites, "      <site name=\"rotor_{number}\" pos=\"{} {} {}\"/>", p.x, p.y, p.z);
        let _ = writeln!(
            actuators,
            "    <general name=\"rotor_{number}\" site=\"rotor_{number}\" gear=\"0 0 {factor} 0 0 {torque}\" ctrllimited=\"true\" ctrlrange=\"0 {thrust_max_n}\" {dynamics}/>"
        );
    }
}

/// What holds the body back.
struct Resistance {
    /// N/(m/s), body axes
    drag: Vector3<f64>,
    /// m, where it acts, in the frame of the rotor positions
    place_m: Vector3<f64>,
    /// N m/(rad/s), body axes
    damping: Vector3<f64>,
}

impl Resistance {
    fn of(source: &mut Source<'_>) -> Self {
        let (center_m, arms_m) = (source.center_of_mass_m(), source.arms_m());
        let middle_m = mean(&arms_m);
        let about_middle_m: Vec<_> = arms_m.iter().map(|arm| arm - middle_m).collect();
        let drag = RotorDrag::of(source);
        let own = Vector3::from(["bx", "by", "bz"].map(|axis| source.take("angular_damping", axis)));
        drag.tell_no_growth(source);
        if drag.force.norm() > 0.0 && source.has("steady_wind") {
            source.note("MuJoCo's wind does not reach this drag, which an actuator makes: the callback adds its share");
        }
        // the share of the whole that acts at the hubs
        let share = if drag.force.norm() > 0.0 { drag.at_hubs.norm() / drag.force.norm() } else { 1.0 };
        let damping = own + damping(&drag.at_hubs, &about_middle_m);
        Self { drag: drag.force, place_m: center_m + middle_m * share, damping }
    }

    /// One actuator for each axis that is held back.
    fn write(&self, sites: &mut String, actuators: &mut String) {
        let p = self.place_m;
        let parts = [("drag", 0, self.drag), ("damping", 3, self.damping)];
        if parts.iter().all(|(_, _, sizes)| sizes.norm() == 0.0) {
            return;
        }
        let _ = writeln!(sites, "      <site name=\"resistance\" pos=\"{} {} {}\"/>", p.x, p.y, p.z);
        for (name, first, sizes) in parts {
            for ((place, axis), size) in ["x", "y", "z"].iter().enumerate().zip(&sizes) {
                if *size == 0.0 {
                    continue;
                }
                let mut gear = ["0"; 6];
                gear[first + place] = "1";
                let _ = writeln!(
                    actuators,
                    "    <general name=\"{name}_{axis}\" site=\"resistance\" gear=\"{}\" gainprm=\"0\" biastype=\"affine\" biasprm=\"0 0 -{size}\"/>",
                    gear.join(" ")
                );
            }
        }
    }
}
