//! What was concealed, in the form of the practice flights' answers, and flights put down as cases.

use std::collections::BTreeMap;
use std::path::Path;

use rayon::prelude::*;
use serde_json::{Map, Value, json};

use crate::maker::hidden::Inflow;
use crate::maker::realistic::case::{EFFECTS, RealCase, SEVERAL};
use crate::maker::realistic::flight::Flown;
use crate::maker::rotors::induced;

/// The answer of a case.
pub fn answer(case: &RealCase, flown: &Flown) -> Value {
    let inside = &case.case;
    let mut expect: Vec<String> = inside.expect.iter().map(|id| (*id).to_owned()).collect();
    let count = expect.len();
    if case.lag_may_be_named() {
        expect.push("motor_lag?".to_owned());
    }
    let craft = &inside.craft;
    let inertia = &craft.inertia;
    let source = &case.senses.source;
    let errors = &flown.errors;
    json!({
        "effects": effects(case, flown),
        "expect": expect,
        "count": count,
        "true": {
            "mass": craft.mass,
            "Ixx": inertia[(0, 0)], "Iyy": inertia[(1, 1)], "Izz": inertia[(2, 2)],
            "Ixy": inertia[(0, 1)], "Ixz": inertia[(0, 2)], "Iyz": inertia[(1, 2)],
            "k_eta": craft.thrust_coefficient, "k_m": craft.torque_coefficient,
        },
        "motor_time_constant": inside.hidden.lag.0,
        "stack": if case.streams.ardupilot { "ardupilot" } else { "px4" },
        "position_source": if source.motion_capture { "mocap" } else { "gps" },
        "path": if case.mission { "mission" } else { "fourier" },
        "estimator": {
            "velocity_rms": (errors.velocity.norm_squared() / 3.0).sqrt(),
            "attitude_rms_deg": errors.attitude,
            "tilt_rms_deg": errors.tilt,
            "position_rms": errors.position,
            "rate_rms": errors.rates,
        },
        "sensors": {
            "accel_noise": case.senses.unit.white[0], "gyro_noise": case.senses.unit.white[1],
            "vibration": case.senses.unit.vibration, "gyro_cut": case.senses.unit.cut,
            "pos_rate": source.rate, "pos_delay": source.late, "pos_delay_assumed": source.believed_late,
        },
        "telemetry": {
            "attitude": case.streams.attitude, "position": case.streams.position,
            "imu": case.streams.inertial, "actuator": case.streams.commands, "esc": case.streams.speeds,
            "skew_attitude": case.streams.skew_attitude, "skew_position": case.streams.skew_position,
        },
        "seen": flown.visibility.axes,
        "draw": [inside.seed, case.draw],
    })
}

/// Sizes as the practice flights state them: a number where the effect has one.
fn effects(case: &RealCase, flown: &Flown) -> Map<String, Value> {
    let inside = &case.case;
    let mut effects: Map<String, Value> = Map::new();
    for id in inside.expect.iter().filter(|id| **id != "unexplained") {
        let of = |name: &str| {
            let found = inside.truth.iter().find(|(other, parameter, _)| other == id && *parameter == name);
            found.map_or(f64::NAN, |(.., value)| *value)
        };
        let value = match *id {
            "linear_drag" => json!(of("dx")),
            "quadratic_drag" => json!(of("cx")),
            "inflow" => json!(of("kz")),
            "motor_lag" => json!(of("time_constant")),
            "transport_delay" => json!(of("delay")),
            "rotor_inertia" => json!(of("jr")),
            // the disc leans away from the wind: against the torque that a positive coefficient means
            "blade_flapping" => json!(-of("k")),
            "ground_effect" => json!(of("rho")),
            "translational_lift" => json!(lift(case, flown)),
            "weak_rotor" => json!({
                "rotor": inside.hidden.weak.map_or(0, |(rotor, _)| rotor), "factor": of("factor"),
            }),
            "mass_change" => json!({ "time": of("time"), "delta": of("delta") }),
            "com_offset" => json!([of("x"), of("y"), 0.0]),
            "steady_wind" => json!([of("north"), of("west"), 0.0]),
            "angular_damping" => json!([of("bx"), of("by"), of("bz")]),
            "thrust_tilt" => json!([of("x").to_degrees(), of("y").to_degrees()]),
            "battery_sag" => json!({ "exponent": of("exponent") }),
            "thrust_curve" => json!({ "slope": of("slope") }),
            _ => json!({}),
        };
        effects.insert((*id).to_owned(), value);
    }
    effects
}

/// N/(m/s)^2 by which this maker's thrust grows with the speed along the discs.
fn lift(case: &RealCase, flown: &Flown) -> f64 {
    let craft = &case.case.craft;
    let Some(Inflow::Edgewise(share)) = case.case.hidden.inflow else { return f64::NAN };
    let squares = flown.ticks.iter().map(|tick| tick.truth.velocity.xy().norm_squared());
    let mean = squares.sum::<f64>() / flown.ticks.len() as f64;
    let thrust = |along: f64| induced(craft, share, craft.hover_speed(), (0.0, along));
    4.0 * (thrust(mean.sqrt()) - thrust(0.0)) / mean
}

/// What the `place`th of a mixed lot conceals: nothing, one, two or four, in the shares of the practice flights.
pub fn mixed(place: u64) -> Vec<&'static str> {
    let at = |of: u64, length: usize| usize::try_from(of).unwrap_or(0) % length;
    match place % 7 {
        0 => Vec::new(),
        3 => SEVERAL[at(place / 7, 4)].to_vec(),
        5 => SEVERAL[4 + at(place / 7, 4)].to_vec(),
        // 4 of every 7, by turns
        other => {
            let turn = [0, 0, 1, 0, 2, 0, 3][at(other, 7)];
            vec![EFFECTS[at(4 * (place / 7) + turn, EFFECTS.len())]]
        }
    }
}

/// Writes `folder/<case>/{vehicle.toml,identify.tlog,holdout.tlog}` and `folder/answers.json`.
pub fn write(folder: &Path, seed: u64, flights: u64) {
    let answers: BTreeMap<String, Value> = (0..flights)
        .into_par_iter()
        .filter_map(|place| {
            let name = format!("r{:03}", place + 1);
            let made = RealCase::flown(seed + place, &mixed(place));
            let (case, flown) = made.map_err(|why| println!("  {name}: {why}")).ok()?;
            put_down(&folder.join(&name), &name, (&case, &flown));
            Some((name, answer(&case, &flown[0])))
        })
        .collect();
    println!("{} of {flights} cases in {}", answers.len(), folder.display());
    let text = serde_json::to_string_pretty(&answers).expect("answers as JSON");
    std::fs::write(folder.join("answers.json"), text).expect("room for the answers");
}

/// Vehicle file and both logs in a folder.
pub fn put_down(at: &Path, name: &str, (case, flown): (&RealCase, &[Flown; 2])) {
    std::fs::create_dir_all(at).expect("a folder for the case");
    std::fs::write(at.join("vehicle.toml"), case.case.craft.file(name)).expect("room for the vehicle");
    for (flight, file) in [(0, "identify.tlog"), (1, "holdout.tlog")] {
        let bytes = case.log(&flown[usize::from(flight > 0)], flight);
        std::fs::write(at.join(file), bytes).expect("room for the flight");
    }
}
