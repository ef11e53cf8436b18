//! What MuJoCo's XML cannot hold, as a callback in Python: forces of the body and of the rotors that are no actuator's.
//!
//! `mjcb_passive` adds to the forces of the free joint: along the world at the body's origin, and torques in body axes. Thrusts are the
//! actuators' own, without those of weak rotors. The laws are those of the effects ([`crate::physics::effects`]).

use super::program::EffectsProgram;
use super::source::{Callback, Source};
use crate::physics::effects::GroundEffect;
use nalgebra::Vector3;
use std::fmt::Write;

/// The effects that the callback makes.
const HELD: [&str; 6] =
    ["quadratic_drag", "steady_wind", "thrust_tilt", "translational_lift", "blade_flapping", "ground_effect"];

/// A drag that the XML holds, which knows no wind.
pub(super) struct HeldDrag {
    /// N/(m/s), body axes
    pub(super) force: Vector3<f64>,
    /// m, where it acts, in the frame of the rotor positions
    pub(super) place_m: Vector3<f64>,
}

/// The callback of a model; none where the XML holds all that it could make.
pub(super) fn callback(source: &mut Source<'_>, drag: &HeldDrag, factors: &[f64]) -> Option<Callback> {
    let ids: Vec<&'static str> = HELD.into_iter().filter(|id| source.has(id)).collect();
    if ids.is_empty() || (source.has("ground_effect") && source.vehicle.propulsion.rotor_radius_m.is_none()) {
        return None;
    }
    let title = title(source, &ids);
    let body = format!("import mujoco\nimport numpy as np\n\n{}{LAWS}", values(source, drag, factors));
    let program = EffectsProgram { title, body };
    Some(Callback { ids, whither: "the callback in Python beside the file makes it", program })
}

fn title(source: &Source<'_>, ids: &[&str]) -> String {
    // no quote ends the text of the module
    let name = source.vehicle.name.replace(['"', '\\'], "'");
    format!("{name}: what MuJoCo's XML cannot hold: {}.", ids.join(", "))
}

fn values(source: &mut Source<'_>, drag: &HeldDrag, factors: &[f64]) -> String {
    let (center, arms) = (source.center_of_mass_m(), source.arms_m());
    let vector = |v: &Vector3<f64>| format!("np.array([{:?}, {:?}, {:?}])", v.x, v.y, v.z);
    let three = |id: &str, names: [&str; 3]| {
        Vector3::from(names.map(|name| source.value(id, name).unwrap_or_default()))
    };
    let one = |id: &str, name: &str, missing: f64| {
        source.value(id, name).filter(|_| source.has(id)).unwrap_or(missing)
    };
    let hubs: Vec<String> =
        arms.iter().map(|arm| format!("[{:?}, {:?}, {:?}]", arm.x, arm.y, arm.z)).collect();
    let lines = [
        ("CENTER", vector(&center), "centre of mass, m"),
        ("HUBS", format!("np.array([{}])", hubs.join(", ")), "from the centre of mass, m"),
        ("FACTORS", format!("np.array({factors:?})"), "thrust over that of a rotor that is not weak"),
        ("THRUST_MAX", format!("{:?}", source.thrust_max_n()), "N, one rotor"),
        ("THRUST_HOVER", format!("{:?}", source.airframe.hover_thrust_n), "N, one rotor"),
        ("RADIUS", format!("{:?}", source.vehicle.propulsion.rotor_radius_m.unwrap_or(1.0)), "m"),
        ("WIND", vector(&three("steady_wind", ["north", "west", "up"])), "m/s, world"),
        ("DRAG", vector(&drag.force), "N/(m/s), which the XML makes without wind"),
        ("DRAG_PLACE", vector(&(drag.place_m - center)), "from the centre of mass, m"),
        ("QUADRATIC", vector(&three("quadratic_drag", ["cx", "cy", "cz"])), "N/(m/s)^2"),
        ("BY_FACE", format!("{:?}", one("quadratic_drag", "by_face", 0.0)), "share"),
        (
            "TILT",
            format!(
                "np.array([{:?}, {:?}, 0.0])",
                one("thrust_tilt", "y", 0.0),
                -one("thrust_tilt", "x", 0.0)
            ),
            "sideways force over thrust",
        ),
        ("LIFT", format!("{:?}", one("translational_lift", "kh", 0.0)), "N/(m/s)^2"),
        ("FLAPPING", format!("{:?}", one("blade_flapping", "k", 0.0)), "N m/(m/s)"),
        (
            "GROUND",
            format!(
                "({:?}, {:?}, {:?}, {:?})",
                one("ground_effect", "rho", 0.0),
                one("ground_effect", "ca", 0.0),
                one("ground_effect", "cb", 1.0),
                one("ground_effect", "levelling", 1.0)
            ),
            "rho, ca, cb, levelling",
        ),
        ("LEAST_RADII", format!("{:?}", GroundEffect::LEAST_RADII), "least height over the ground"),
    ];
    let mut text = String::new();
    for (name, value, words) in lines {
        // writing to a String cannot fail
        let _ = writeln!(text, "{name} = {value}  # {words}");
    }
    text
}

const LAWS: &str = r#"

def force_and_torque(thrust, air, spin, height, turned):
    """About the centre of mass: N and N m. `air` is its velocity through the air, `height` its height over the ground."""
    force, torque = np.zeros(3), np.zeros(3)
    speed = (1 - BY_FACE) * np.linalg.norm(air) + BY_FACE * np.abs(air)
    force -= QUADRATIC * speed * air
    blown = DRAG * (turned.T @ WIND)
    force += blown
    torque += np.cross(DRAG_PLACE, blown)
    rho, ca, cb, levelling = GROUND
    for hub, push in zip(HUBS, thrust):
        through = air + np.cross(spin, hub)
        radii = max((height + levelling * (turned @ hub)[2]) / RADIUS, LEAST_RADII)
        gain = 1 / (1 - rho / (16 * radii**2)) - 1 + ca * np.exp(-cb * radii)
        lift = LIFT / len(HUBS) * (through[0] ** 2 + through[1] ** 2) + push * gain
        one = push * TILT + np.array([0.0, 0.0, lift])
        force += one
        torque += np.cross(hub, one)
        turns = np.sqrt(max(push, 0.0) / THRUST_HOVER)
        torque += FLAPPING / len(HUBS) * turns * np.array([-through[1], through[0], 0.0])
    return force, torque


def install(model):
    """From now on MuJoCo adds the effects to the body `vehicle` of this model. Other models keep theirs."""
    body = model.body("vehicle").id

    def add(data):
        turned, spin = data.xmat[body].reshape(3, 3), data.qvel[3:6]
        velocity = turned.T @ data.qvel[:3] + np.cross(spin, CENTER)
        height = (data.qpos[:3] + turned @ CENTER)[2]
        told = data.act if model.na else data.ctrl
        thrust = FACTORS * np.clip(told[: len(HUBS)], 0.0, THRUST_MAX)
        force, torque = force_and_torque(thrust, velocity - turned.T @ WIND, spin, height, turned)
        data.qfrc_passive[:3] += turned @ force
        data.qfrc_passive[3:6] += torque + np.cross(CENTER, force)

    # MuJoCo has one callback for all models: it goes through what was installed
    first = mujoco.get_mjcb_passive()
    installed = getattr(first, "installed", None)
    if installed is None:
        installed = []

        def passive(given, data):
            if first is not None:
                first(given, data)
            for of, added in installed:
                if of is given:
                    added(data)

        passive.installed = installed
        mujoco.set_mjcb_passive(passive)
    installed[:] = [one for one in installed if one[0] is not model] + [(model, add)]
"#;
