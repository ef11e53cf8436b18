//! Gazebo: a model with the multicopter motor model of gz-sim.
//!
//! src/systems/multicopter_motor_model. Its motor: `T = motorConstant w^2`, reaction torque `momentConstant T`, drag `rotorDragCoefficient |w| v` at
//! the hub across the rotor axis, first-order lag up and down. Frames and units are ours.

use super::drag::RotorDrag;
use super::error::ExportError;
use super::notes::xml_comments;
use super::source::{Exported, FAST_S, Source};
use crate::text::markup;
use crate::vehicle::{Rotor, Spin};
use nalgebra::{Matrix3, Vector3};

const FORMAT: &str = "sdf";
/// kg and kg m^2 of a rotor's link, which the solver needs above zero.
const ROTOR_KG: f64 = 1e-3;
const ROTOR_KG_M2: f64 = 1e-7;

pub(super) fn write(mut source: Source<'_>) -> Result<Exported, ExportError> {
    let (coefficient, speed_max) = source.speeds(FORMAT)?;
    let hover = source.hover_rad_s(coefficient);
    let count = source.vehicle.rotors.len() as f64;
    let across = drag(&mut source);
    let lags_s = source.lags_s().unwrap_or((FAST_S, FAST_S));
    let wind = ["north", "west", "up"].map(|axis| source.take("steady_wind", axis));
    if wind.iter().any(|part| *part != 0.0) {
        source.note(format!(
            "wind belongs to the world, not to the model: <wind><linear_velocity>{} {} {}</linear_velocity></wind> for a world with x north and y west",
            wind[0], wind[1], wind[2]
        ));
    }
    let motor = Motor { coefficient, speed_max, lags_s, drag: across / (count * hover) };
    let (mut links, mut plugins) = (base_link(&mut source), String::new());
    let factors = source.rotor_factors();
    for (number, (rotor, factor)) in source.vehicle.rotors.iter().zip(factors).enumerate() {
        links.push_str(&rotor_link(number, rotor));
        let own = Motor { coefficient: coefficient * factor, ..motor };
        plugins.push_str(&own.plugin(number, rotor, source.vehicle.propulsion.torque_per_thrust_m));
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
    let drag = RotorDrag::of(source);
    drag.tell_at_hubs(source);
    source.refuse("inflow");
    let dz = source.take("linear_drag", "dz");
    if dz > 0.0 {
        source.note(format!(
            "drag along the rotor axis cannot be represented in the motor model: {dz:.4} N/(m/s)"
        ));
    }
    drag.even_across(source, "rotorDragCoefficient")
}

/// The body without its rotors' links: together they have the model's mass, centre of mass and inertia.
fn base_link(source: &mut Source<'_>) -> String {
    let whole_m = source.center_of_mass_m();
    let (body, rotors) = (&source.vehicle.body, &source.vehicle.rotors);
    let base_kg = body.mass_kg - ROTOR_KG * rotors.len() as f64;
    let hubs = rotors.iter().map(|rotor| rotor.position_m);
    let center = (whole_m * body.mass_kg - hubs.clone().sum::<Vector3<f64>>() * ROTOR_KG) / base_kg;
    let j = hubs.fold(body.inertia_kg_m2 - point_inertia_kg_m2(base_kg, &(center - whole_m)), |left, hub| {
        left - point_inertia_kg_m2(ROTOR_KG, &(hub - whole_m)) - Matrix3::from_diagonal_element(ROTOR_KG_M2)
    });
    format!(
        "    <link name=\"base_link\">\n      <inertial>\n        <pose>{} {} {} 0 0 0</pose>\n        <mass>{base_kg}</mass>\n        <inertia><ixx>{}</ixx><ixy>{}</ixy><ixz>{}</ixz><iyy>{}</iyy><iyz>{}</iyz><izz>{}</izz></inertia>\n      </inertial>\n    </link>\n",
        center.x,
        center.y,
        center.z,
        j[(0, 0)],
        j[(0, 1)],
        j[(0, 2)],
        j[(1, 1)],
        j[(1, 2)],
        j[(2, 2)]
    )
}

/// kg m^2 of a point of mass `m_kg` at `r_m`.
fn point_inertia_kg_m2(m_kg: f64, r_m: &Vector3<f64>) -> Matrix3<f64> {
    (Matrix3::from_diagonal_element(r_m.norm_squared()) - r_m * r_m.transpose()) * m_kg
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
    /// s, of a rotor that speeds up and of one that slows down
    lags_s: (f64, f64),
    /// N/(m/s) for each rad/s
    drag: f64,
}

impl Motor {
    /// `torque_m`: reaction torque over thrust, m.
    fn plugin(&self, number: usize, rotor: &Rotor, torque_m: f64) -> String {
        let Self { coefficient, speed_max, lags_s: (up_s, down_s), drag } = self;
        let spin = match rotor.spin {
            Spin::Cw => "cw",
            Spin::Ccw => "ccw",
        };
        format!(
            "    <plugin filename=\"gz-sim-multicopter-motor-model-system\" name=\"gz::sim::systems::MulticopterMotorModel\">\n      <jointName>rotor_{number}_joint</jointName>\n      <linkName>rotor_{number}</linkName>\n      <turningDirection>{spin}</turningDirection>\n      <timeConstantUp>{up_s}</timeConstantUp>\n      <timeConstantDown>{down_s}</timeConstantDown>\n      <maxRotVelocity>{speed_max}</maxRotVelocity>\n      <motorConstant>{coefficient:e}</motorConstant>\n      <momentConstant>{torque_m}</momentConstant>\n      <commandSubTopic>command/motor_speed</commandSubTopic>\n      <motorNumber>{number}</motorNumber>\n      <rotorDragCoefficient>{drag:e}</rotorDragCoefficient>\n      <rollingMomentCoefficient>0</rollingMomentCoefficient>\n      <rotorVelocitySlowdownSim>10</rotorVelocitySlowdownSim>\n      <motorType>velocity</motorType>\n    </plugin>\n"
        )
    }
}
