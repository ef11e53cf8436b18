//! Gazebo: a model with the multicopter motor model of gz-sim.
//!
//! Its motor: `T = motorConstant w^2`, reaction torque `momentConstant T`, drag `rotorDragCoefficient |w| v` across
//! the rotor axis, first-order lag up and down. Frames and units are ours.

use super::error::ExportError;
use super::notes::xml_comments;
use super::source::{Exported, Source};
use crate::text::markup;
use crate::vehicle::{Rotor, Spin};

const FORMAT: &str = "sdf";
/// kg and kg m^2 of a rotor's link, which the solver needs above zero.
const ROTOR_KG: f64 = 1e-3;
const ROTOR_KG_M2: f64 = 1e-7;
/// s, a lag that is nearly none.
const FAST_S: f64 = 0.001;

pub(super) fn write(mut source: Source<'_>) -> Result<Exported, ExportError> {
    let (coefficient, speed_max) = source.speeds(FORMAT)?;
    let hover = source.hover_rad_s(FORMAT)?;
    let count = source.vehicle.rotors.len() as f64;
    let across = drag(&mut source);
    let lag_s = source.time_constant_s().unwrap_or(FAST_S);
    let wind = ["north", "west", "up"].map(|axis| source.take("steady_wind", axis));
    if wind.iter().any(|part| *part != 0.0) {
        source.note(format!(
            "wind belongs to the world, not to the model: <wind><linear_velocity>{} {} {}</linear_velocity></wind> for a world with x north and y west",
            wind[0], wind[1], wind[2]
        ));
    }
    let motor = Motor { coefficient, speed_max, lag_s, drag: across / (count * hover) };
    let (mut links, mut plugins) = (base_link(&mut source), String::new());
    for (number, rotor) in source.vehicle.rotors.iter().enumerate() {
        links.push_str(&rotor_link(number, rotor));
        plugins.push_str(&motor.plugin(number, rotor, source.vehicle.propulsion.torque_per_thrust_m));
    }
    source.note(format!("the rotors' links weigh {ROTOR_KG} kg each, taken off the body; collision and visual shapes are for you to add"));
    let name = markup(&source.vehicle.name);
    Ok(source.finish(|notes| {
        format!(
            "<?xml version=\"1.0\"?>\n{}<sdf version=\"1.9\">\n  <model name=\"{name}\">\n{links}{plugins}  </model>\n</sdf>\n",
            xml_comments(notes)
        )
    }))
}

/// Across the rotor axis, N/(m/s), of the whole vehicle.
fn drag(source: &mut Source<'_>) -> f64 {
    let drag = ["dx", "dy", "dz"].map(|axis| source.take("linear_drag", axis));
    let across = 0.5 * (drag[0] + drag[1]);
    if (drag[0] - drag[1]).abs() > 0.05 * across {
        source.note(format!(
            "drag is the same along x and y here: the mean of {:.4} and {:.4} N/(m/s)",
            drag[0], drag[1]
        ));
    }
    if drag[2] > 0.0 {
        source.note(format!(
            "drag along the rotor axis cannot be represented in the motor model: {:.4} N/(m/s)",
            drag[2]
        ));
    }
    across
}

/// The body without its rotors' links.
fn base_link(source: &mut Source<'_>) -> String {
    let center = source.center_of_mass_m();
    let body = &source.vehicle.body;
    let rotors_kg = ROTOR_KG * source.vehicle.rotors.len() as f64;
    let j = &body.inertia_kg_m2;
    format!(
        "    <link name=\"base_link\">\n      <inertial>\n        <pose>{} {} {} 0 0 0</pose>\n        <mass>{}</mass>\n        <inertia><ixx>{}</ixx><ixy>{}</ixy><ixz>{}</ixz><iyy>{}</iyy><iyz>{}</iyz><izz>{}</izz></inertia>\n      </inertial>\n    </link>\n",
        center.x,
        center.y,
        center.z,
        body.mass_kg - rotors_kg,
        j[(0, 0)],
        j[(0, 1)],
        j[(0, 2)],
        j[(1, 1)],
        j[(1, 2)],
        j[(2, 2)]
    )
}

/// A rotor's own link and its joint.
fn rotor_link(number: usize, rotor: &Rotor) -> String {
    let p = rotor.position_m;
    format!(
        "    <link name=\"rotor_{number}\">\n      <pose>{} {} {} 0 0 0</pose>\n      <inertial><mass>{ROTOR_KG}</mass><inertia><ixx>{ROTOR_KG_M2}</ixx><ixy>0</ixy><ixz>0</ixz><iyy>{ROTOR_KG_M2}</iyy><iyz>0</iyz><izz>{ROTOR_KG_M2}</izz></inertia></inertial>\n    </link>\n    <joint name=\"rotor_{number}_joint\" type=\"revolute\">\n      <parent>base_link</parent>\n      <child>rotor_{number}</child>\n      <axis><xyz>0 0 1</xyz><limit><lower>-1e16</lower><upper>1e16</upper></limit></axis>\n    </joint>\n",
        p.x, p.y, p.z
    )
}

/// What all motors have alike.
struct Motor {
    /// N/(rad/s)^2
    coefficient: f64,
    /// rad/s
    speed_max: f64,
    /// s
    lag_s: f64,
    /// N/(m/s) for each rad/s
    drag: f64,
}

impl Motor {
    /// `torque_m`: reaction torque over thrust, m.
    fn plugin(&self, number: usize, rotor: &Rotor, torque_m: f64) -> String {
        let Self { coefficient, speed_max, lag_s, drag } = self;
        let spin = match rotor.spin {
            Spin::Cw => "cw",
            Spin::Ccw => "ccw",
        };
        format!(
            "    <plugin filename=\"gz-sim-multicopter-motor-model-system\" name=\"gz::sim::systems::MulticopterMotorModel\">\n      <jointName>rotor_{number}_joint</jointName>\n      <linkName>rotor_{number}</linkName>\n      <turningDirection>{spin}</turningDirection>\n      <timeConstantUp>{lag_s}</timeConstantUp>\n      <timeConstantDown>{lag_s}</timeConstantDown>\n      <maxRotVelocity>{speed_max}</maxRotVelocity>\n      <motorConstant>{coefficient:e}</motorConstant>\n      <momentConstant>{torque_m}</momentConstant>\n      <commandSubTopic>command/motor_speed</commandSubTopic>\n      <motorNumber>{number}</motorNumber>\n      <rotorDragCoefficient>{drag:e}</rotorDragCoefficient>\n      <rollingMomentCoefficient>0</rollingMomentCoefficient>\n      <rotorVelocitySlowdownSim>10</rotorVelocitySlowdownSim>\n      <motorType>velocity</motorType>\n    </plugin>\n"
        )
    }
}
