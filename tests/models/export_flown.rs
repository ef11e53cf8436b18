//! Exported models are flown in the simulators that they were written for, `RotorPy` and `MuJoCo`: the simulator moves as
//! mavid's own under the same commands, and the recording of its flight identifies the model. Skipped, with a message,
//! where a simulator is missing (`tests/peers/setup.sh` installs them).

#![allow(clippy::print_stdout, reason = "with --nocapture these are the figures of the documentation")]

use crate::python;
use crate::support;

use mavid::config::load_vehicle;
use mavid::physics::effects::by_id;
use mavid::physics::{ActiveEffect, Input, Model, State};
use mavid::simulate::{Plant, RandomTrajectory, Reference};
use mavid::vehicle::Vehicle;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;
use serde_json::{Value, json};
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::Command;
use support::Needed;

/// s, of the controller and the log.
const PERIOD_S: f64 = 0.01;
/// Periods of the flight: 34 s.
const PERIODS: u32 = 3400;
/// Periods that both simulators fly from one state: 2 s.
const WINDOW: usize = 200;

/// A quadrotor, as the file of a vehicle.
fn file(mass: f64, inertia: &str) -> String {
    let rotors = [(0.13, -0.15, "ccw"), (-0.12, 0.15, "ccw"), (0.13, 0.15, "cw"), (-0.12, -0.15, "cw")];
    let mut text = format!(
        "name = \"flown\"\n[body]\nmass = {mass}\ninertia = {inertia}\ncenter_of_mass = [0.004, -0.003, 0.005]\n\
         [propulsion]\nactuator = \"speed\"\nspeed_max = 900.0\nthrust_coefficient = 8.0e-6\n\
         torque_coefficient = 1.2e-7\nrotor_radius = 0.11\n"
    );
    for (number, (x, y, spin)) in rotors.iter().enumerate() {
        let _ =
            writeln!(text, "[[rotor]]\nname = \"{number}\"\nposition = [{x}, {y}, 0.025]\nspin = \"{spin}\"");
    }
    text
}

const INERTIA: &str = "{ xx = 0.0112, yy = 0.0135, zz = 0.0218, xy = 0.0003, xz = -0.0002, yz = 0.0001 }";
const MASS_KG: f64 = 1.3;
/// dx, dy, dz
const DRAG: [f64; 3] = [0.35, 0.35, 0.25];

/// A simulator, and what it has of the model.
struct Peer {
    /// of the test's folder
    name: &'static str,
    format: &'static str,
    needed: Needed,
    /// share of the drag that grows with the rotors' speed
    with_speed: f64,
    /// with values, beside the drag
    effects: &'static [(&'static str, &'static [(&'static str, f64)])],
    /// of its flight
    periods: u32,
    /// greatest distance after [`WINDOW`] periods from one state, m and rad
    apart: (f64, f64),
}

/// A folder for one test, with the model and what is believed of it beforehand.
struct Case {
    folder: PathBuf,
    vehicle: Vehicle,
    effects: Vec<ActiveEffect>,
}

impl Case {
    fn new(peer: &Peer) -> Self {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("export-flown-{}", peer.name));
        let _ = std::fs::remove_dir_all(&folder);
        std::fs::create_dir_all(&folder).unwrap();
        let nominal = file(1.2, "{ xx = 0.0100, yy = 0.0150, zz = 0.0200 }");
        std::fs::write(folder.join("nominal.toml"), nominal).unwrap();
        let shares = [("at_hubs", 1.0), ("with_speed", peer.with_speed)];
        let drag = [("dx", DRAG[0]), ("dy", DRAG[1]), ("dz", DRAG[2]), shares[0], shares[1]];
        let all = [&[("linear_drag", &drag[..])], peer.effects].concat();
        let (mut model, mut effects) = (file(MASS_KG, INERTIA), Vec::new());
        for (id, values) in all {
            let _ = writeln!(model, "[[effect]]\nid = \"{id}\"");
            values.iter().for_each(|(name, value)| writeln!(model, "{name} = {value}").unwrap());
            let values: Vec<f64> = values.iter().map(|(_, value)| *value).collect();
            effects.push(ActiveEffect::new(by_id(id).unwrap(), &values).unwrap());
        }
        std::fs::write(folder.join("model.toml"), model).unwrap();
        let vehicle = load_vehicle(&folder.join("nominal.toml")).unwrap();
        let vehicle = Vehicle { body: load_body(&folder), ..vehicle };
        Self { folder, vehicle, effects }
    }

    fn path(&self, name: &str) -> String {
        self.folder.join(name).display().to_string()
    }

    /// What the program says, as JSON.
    fn mavid(arguments: &[&str]) -> Value {
        let output = Command::new(env!("CARGO_BIN_EXE_mavid")).args(arguments).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        serde_json::from_slice(&output.stdout).unwrap()
    }

    /// The peer's flight of the exported model.
    fn fly(&self, peer: &Peer) -> Result<Vec<Row>, String> {
        let exported = Self::mavid(&["export", &self.path("model.toml"), "--to", peer.format, "--json"]);
        let (body, propulsion) = (&self.vehicle.body, &self.vehicle.propulsion);
        let trajectory = RandomTrajectory::default().draw(7).unwrap();
        let reference = Reference { trajectory, hover_s: 2.0, ramp_s: 2.0 };
        let wanted: Vec<Vec<f64>> = (0..peer.periods)
            .map(|period| {
                let at = reference.at(f64::from(period) * PERIOD_S);
                let vectors = [at.position_m, at.velocity_m_s, at.acceleration_m_s2];
                let all = vectors.iter().flat_map(|vector| vector.iter().copied());
                all.chain([at.yaw_rad, at.yaw_rate_rad_s]).collect()
            })
            .collect();
        let rotors = &self.vehicle.rotors;
        let hubs: Vec<[f64; 3]> =
            rotors.iter().map(|rotor| (rotor.position_m - body.center_of_mass_m).into()).collect();
        let signs: Vec<f64> = rotors.iter().map(|rotor| rotor.spin.yaw_sign()).collect();
        let given = json!({
            "format": peer.format, "text": exported["text"], "callback": exported["callback"], "period_s": PERIOD_S, "reference": wanted,
            "thrust_coefficient": propulsion.thrust_coefficient, "noise": [0.02, 0.02], "seed": 5,
            "believed": {
                "mass": body.mass_kg, "gravity": self.vehicle.gravity_m_s2, "inertia": body.inertia_kg_m2.as_slice(),
                "hubs": hubs, "yaw_signs": signs, "torque_per_thrust": propulsion.torque_per_thrust_m,
                "thrust_max": propulsion.full_thrust_n(),
            },
        });
        let answer = python::ask("fly_export.py", &[], &given)?;
        Ok(answer.as_array().unwrap().iter().map(|row| Row::new(&python::numbers(row), propulsion)).collect())
    }
}

fn load_body(folder: &Path) -> mavid::vehicle::RigidBody {
    let whole = folder.join("whole.toml");
    std::fs::write(&whole, file(MASS_KG, INERTIA)).unwrap();
    load_vehicle(&whole).unwrap().body
}

/// A period of the peer's flight.
struct Row {
    state: State,
    specific_force_m_s2: Vector3<f64>,
    commands: Vec<f64>,
}

impl Row {
    fn new(row: &[f64], propulsion: &mavid::vehicle::Propulsion) -> Self {
        let vector = |from: usize| Vector3::from_column_slice(&row[from..from + 3]);
        let attitude = Quaternion::new(row[6], row[7], row[8], row[9]);
        Self {
            state: State {
                position_m: vector(0),
                velocity_m_s: vector(3),
                attitude: UnitQuaternion::from_quaternion(attitude),
                rates_rad_s: vector(10),
            },
            specific_force_m_s2: vector(13),
            commands: row[16..].iter().map(|thrust_n| propulsion.command_from_thrust(*thrust_n)).collect(),
        }
    }
}

/// Greatest distance (m) and angle (rad) of mavid's own simulation from the peer's, [`WINDOW`] periods after both were in one
/// state. The rotors go on: they have followed the same commands from the beginning.
fn apart(case: &Case, rows: &[Row]) -> (f64, f64) {
    let model = Model::new(&case.vehicle, case.effects.clone()).unwrap();
    let input = |row: &Row| Input::from_commands(&model.airframe, 0.0, &row.commands);
    let hover = case.vehicle.propulsion.command_from_thrust(model.airframe.hover_thrust_n);
    let still = Input::from_commands(&model.airframe, 0.0, &[hover; 4]);
    let mut plant = Plant::new(&model, None, &rows[0].state, &still).unwrap();
    let mut worst = (0.0_f64, 0.0_f64);
    for (at, row) in rows.iter().enumerate() {
        if at.is_multiple_of(WINDOW) {
            let ours = plant.state();
            worst.0 = worst.0.max((ours.position_m - row.state.position_m).norm());
            worst.1 = worst.1.max(ours.attitude.angle_to(&row.state.attitude));
            plant.set_state(&row.state);
        }
        (0..10).for_each(|_| plant.step(&input(row), PERIOD_S / 10.0));
    }
    worst
}

/// The flight as a log with the noise of sensors.
fn log(rows: &[Row]) -> String {
    let mut random = Pcg64Mcg::seed_from_u64(11);
    let mut noisy = |vector: Vector3<f64>, size: f64| {
        vector.map(|value| {
            let drawn: f64 = StandardNormal.sample(&mut random);
            value + size * drawn
        })
    };
    let mut text = "time_s".to_owned();
    let three =
        |stem: &str, unit: &str| ["x", "y", "z"].map(|axis| format!(",{stem}_{axis}_{unit}")).concat();
    text += &three("position", "m");
    text += &three("velocity", "m_s");
    text += ",attitude_w,attitude_x,attitude_y,attitude_z";
    text += &three("rate", "rad_s");
    text += &three("specific_force", "m_s2");
    text += ",motor_1_command,motor_2_command,motor_3_command,motor_4_command\n";
    for (number, row) in rows.iter().enumerate() {
        let turned = row.state.attitude * UnitQuaternion::from_scaled_axis(noisy(Vector3::zeros(), 1e-3));
        let q = turned.quaternion();
        let vectors = [
            noisy(row.state.position_m, 2e-3),
            noisy(row.state.velocity_m_s, 0.01),
            noisy(row.state.rates_rad_s, 5e-3),
            noisy(row.specific_force_m_s2, 0.05),
        ];
        let cells = |vector: &Vector3<f64>| format!(",{:.6},{:.6},{:.6}", vector.x, vector.y, vector.z);
        let _ = write!(text, "{:.3}{}{}", number as f64 * PERIOD_S, cells(&vectors[0]), cells(&vectors[1]));
        let _ = write!(text, ",{:.7},{:.7},{:.7},{:.7}", q.w, q.i, q.j, q.k);
        let _ = write!(text, "{}{}", cells(&vectors[2]), cells(&vectors[3]));
        row.commands.iter().for_each(|u| write!(text, ",{u:.6}").unwrap());
        text.push('\n');
    }
    text
}

/// The exported model comes back from the peer's flight: trajectory, mass, inertia and drag.
fn comes_back(peer: &Peer) {
    let case = Case::new(peer);
    let rows = match case.fly(peer) {
        Ok(rows) => rows,
        Err(why) => return support::skip(peer.needed, &why),
    };
    let (away_m, turned_rad) = apart(&case, &rows);
    println!("{}: after 2 s at most {away_m:.2e} m and {turned_rad:.2e} rad apart", peer.name);
    assert!(away_m < peer.apart.0 && turned_rad < peer.apart.1, "{away_m} m, {turned_rad} rad");
    std::fs::write(case.folder.join("flight.csv"), log(&rows)).unwrap();
    let with: Vec<&str> = ["linear_drag"].into_iter().chain(peer.effects.iter().map(|(id, _)| *id)).collect();
    let with = with.join(",");
    let (flight, nominal) = (case.path("flight.csv"), case.path("nominal.toml"));
    let said = Case::mavid(&["identify", &flight, "--vehicle", &nominal, "--with", &with, "--json"]);
    let body = &case.vehicle.body;
    let check = |of: &Value, name: &str, truth: f64, share: f64| {
        let value = of["value"].as_f64().unwrap();
        println!(
            "{}: {name} {value:.5}, exported {truth}, {:+.2} %",
            peer.name,
            100.0 * (value / truth - 1.0)
        );
        assert_eq!(of["status"], "determined", "{name}: {of}");
        assert!((value / truth - 1.0).abs() < share, "{name}: {value}, exported {truth}");
    };
    let parameters = &said["with"]["parameters"];
    check(&parameters["mass"], "mass", body.mass_kg, 0.01);
    for (axis, name) in ["ixx", "iyy", "izz"].iter().enumerate() {
        check(&parameters[*name], name, body.inertia_kg_m2[(axis, axis)], 0.03);
    }
    let effects = said["with"]["effects"].as_array().unwrap();
    let drag = effects.iter().find(|effect| effect["id"] == "linear_drag").unwrap();
    let of_drag = drag["parameters"].as_array().unwrap();
    for (name, truth) in ["dx", "dy", "dz"].iter().zip(DRAG) {
        check(of_drag.iter().find(|one| one["name"] == *name).unwrap(), name, truth, 0.05);
    }
}

/// What `MuJoCo`'s file cannot hold is in the callback beside it: with both it moves as the model does.
#[test]
fn mujoco_with_the_callback_flies_as_the_model() {
    let peer = Peer {
        name: "mujoco-callback",
        format: "mjcf",
        needed: Needed::Mujoco,
        with_speed: 0.0,
        effects: &[
            ("quadratic_drag", &[("cx", 0.05), ("cy", 0.08), ("cz", 0.1), ("by_face", 0.4)]),
            ("steady_wind", &[("north", 1.5), ("west", -1.0), ("up", 0.2)]),
            ("thrust_tilt", &[("x", 0.01), ("y", -0.02)]),
            ("translational_lift", &[("kh", 0.03)]),
            ("blade_flapping", &[("k", 0.004)]),
            ("ground_effect", &[("rho", 3.0), ("ca", 0.1), ("cb", 1.0), ("levelling", 0.6)]),
        ],
        periods: 5 * u32::try_from(WINDOW).unwrap(),
        apart: (1e-5, 1e-5),
    };
    let case = Case::new(&peer);
    let rows = match case.fly(&peer) {
        Ok(rows) => rows,
        Err(why) => return support::skip(peer.needed, &why),
    };
    let (away_m, turned_rad) = apart(&case, &rows);
    println!("{}: after 2 s at most {away_m:.2e} m and {turned_rad:.2e} rad apart", peer.name);
    assert!(away_m < peer.apart.0 && turned_rad < peer.apart.1, "{away_m} m, {turned_rad} rad");
}

#[test]
fn rotorpy_flies_as_the_model_and_gives_it_back() {
    comes_back(&Peer {
        name: "rotorpy",
        format: "rotorpy",
        needed: Needed::Peers,
        with_speed: 1.0,
        effects: &[("motor_lag", &[("time_constant", 0.03)])],
        periods: PERIODS,
        apart: (1e-5, 1e-5),
    });
}

#[test]
fn mujoco_flies_as_the_model_and_gives_it_back() {
    comes_back(&Peer {
        name: "mujoco",
        format: "mjcf",
        needed: Needed::Mujoco,
        with_speed: 0.0,
        effects: &[("angular_damping", &[("bx", 0.02), ("by", 0.02), ("bz", 0.02)])],
        periods: PERIODS,
        apart: (1e-5, 1e-5),
    });
}

/// What `MuJoCo` cannot hold, and the file says so: a drag that grows with the rotors' speed, and a lag of the speed.
#[test]
fn mujoco_gives_a_model_back_that_it_holds_about_hover_only() {
    comes_back(&Peer {
        name: "mujoco-hover",
        format: "mjcf",
        needed: Needed::Mujoco,
        with_speed: 1.0,
        effects: &[("motor_lag", &[("time_constant", 0.03)])],
        periods: PERIODS,
        apart: (0.15, 0.1),
    });
}
