//! MuJoCo: a free body with one thrust a rotor.
//!
//! A `general` actuator at each hub: control is the thrust in newtons, gear its force along body z and its
//! reaction torque. `fullinertia` is xx yy zz xy xz yz about the centre of mass. Frames and units are ours.

use super::error::ExportError;
use super::notes::xml_comments;
use super::source::{Exported, Source};
use crate::text::markup;
use std::fmt::Write;

pub(super) fn write(mut source: Source<'_>) -> Result<Exported, ExportError> {
    let center = source.center_of_mass_m();
    let thrust_max_n = source.thrust_max_n();
    let lag_s = source.time_constant_s();
    let wind = ["north", "west", "up"].map(|axis| source.take("steady_wind", axis));
    let dynamics = lag_s.map_or_else(
        || "dyntype=\"none\"".to_owned(),
        |lag_s| format!("dyntype=\"filter\" dynprm=\"{lag_s}\""),
    );
    if lag_s.is_some() {
        source.note(
            "the lag acts on the thrust here and on the rotor speed in the model: the same for small changes",
        );
    }
    source.note("controls are thrusts in newtons: the law from command to thrust is the autopilot's side");
    if source.has("linear_drag") {
        source.note("MuJoCo's own fluid forces are not rotor drag: add the force -D v_body in a callback");
    }
    let mut sites = String::new();
    let mut actuators = String::new();
    for (number, rotor) in source.vehicle.rotors.iter().enumerate() {
        let p = rotor.position_m;
        let torque = rotor.spin.yaw_sign() * source.vehicle.propulsion.torque_per_thrust_m;
        let _ = writeln!(sites, "      <site name=\"rotor_{number}\" pos=\"{} {} {}\"/>", p.x, p.y, p.z);
        let _ = writeln!(
            actuators,
            "    <general name=\"rotor_{number}\" site=\"rotor_{number}\" gear=\"0 0 1 0 0 {torque}\" ctrllimited=\"true\" ctrlrange=\"0 {thrust_max_n}\" {dynamics}/>"
        );
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
        "  <option gravity=\"0 0 {}\" wind=\"{} {} {}\"/>\n",
        -source.vehicle.gravity_m_s2, wind[0], wind[1], wind[2]
    );
    let name = markup(&source.vehicle.name);
    Ok(source.finish(|notes| {
        format!(
            "{}<mujoco model=\"{name}\">\n{option}  <worldbody>\n    <body name=\"vehicle\">\n      <freejoint/>\n{inertial}{sites}    </body>\n  </worldbody>\n  <actuator>\n{actuators}  </actuator>\n</mujoco>\n",
            xml_comments(notes)
        )
    }))
}
