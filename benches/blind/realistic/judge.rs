//! Explains flights and judges what was said, by the rules of the practice flights.

use mavid::report::ExplanationDocument;
use mavid::study::{ExplainRequest, ReadSettings, Silent, VehicleGiven, explain};
use rayon::prelude::*;
use serde_json::Value;
use std::path::PathBuf;

use super::answers::{answer, put_down};
use crate::maker::realistic::case::RealCase;

/// A flight to be made and explained.
#[derive(Debug, Clone, Copy)]
pub struct Request {
    pub seed: u64,
    pub entries: &'static [&'static str],
}

/// A stated number and what it should be.
#[derive(Debug, Clone)]
pub struct Stated {
    pub name: String,
    pub value: f64,
    pub std: f64,
    pub truth: f64,
}

impl Stated {
    /// How far off, as a share of the truth and in standard errors.
    pub fn off(&self) -> (f64, f64) {
        let off = (self.value - self.truth).abs();
        (off / self.truth.abs(), off / self.std.max(1e-300))
    }
}

/// Of the rigid body: name, and its value without effects and with them over the truth, less one.
#[derive(Debug, Clone)]
pub struct Moved {
    pub name: &'static str,
    pub before: f64,
    pub after: Option<f64>,
}

/// What was said of a flight.
#[derive(Debug, Clone)]
pub struct Judged {
    pub entries: &'static [&'static str],
    pub verdict: String,
    /// named of what is concealed, and else in the set of a name
    pub named: Vec<String>,
    pub in_set: Vec<String>,
    pub missed: Vec<String>,
    /// names of what is not there, and all names
    pub others: Vec<String>,
    pub names: Vec<String>,
    pub right: bool,
    pub sizes: Vec<Stated>,
    pub bodies: Vec<Stated>,
    pub moved: Vec<Moved>,
    /// axes on which something is said to be missing, and on which it is
    pub axes: ([bool; 6], [bool; 6]),
}

/// Neither right nor false: the inertial unit sits askew.
const ASKEW: [&str; 2] = ["imu_misalignment", "frame_misalignment"];

/// As a document names them.
const AXES: [&str; 6] = ["force_x", "force_y", "force_z", "torque_x", "torque_y", "torque_z"];

/// Makes, explains and judges all, side by side; a line of each that is not right.
pub fn all(requests: &[Request]) -> Vec<Judged> {
    let tell_all = std::env::var_os("BLIND_TELL").is_some();
    requests
        .par_iter()
        .filter_map(|requests| {
            let told = format!("  seed {} {:?}", requests.seed, requests.entries);
            match one(*requests) {
                Ok((judged, line)) => {
                    if tell_all || !judged.right {
                        println!("{told}: {line}");
                    }
                    Some(judged)
                }
                Err(why) => {
                    println!("{told}: not flown or read: {why}");
                    None
                }
            }
        })
        .collect()
}

fn one(requests: Request) -> Result<(Judged, String), String> {
    let (case, flown) = RealCase::flown(requests.seed, requests.entries)?;
    let name = format!("mavid_blind_{}_{}_{}", std::process::id(), requests.seed, requests.entries.join("_"));
    let kept = std::env::var_os("BLIND_KEEP").map(PathBuf::from);
    let folder = kept.clone().unwrap_or_else(std::env::temp_dir).join(&name);
    put_down(&folder, &name, (&case, &flown));
    let request = ExplainRequest {
        logs: vec![folder.join("identify.tlog")],
        vehicle: VehicleGiven::File(folder.join("vehicle.toml")),
        holdout: vec![folder.join("holdout.tlog")],
        read: ReadSettings::default(),
        transient_s: ExplainRequest::TRANSIENT_S,
        design_next: false,
        next_limits: None,
    };
    let study = explain(&request, &Silent).map_err(|error| error.to_string());
    let said = serde_json::to_value(ExplanationDocument::new(&study?)).map_err(|error| error.to_string())?;
    let truth = answer(&case, &flown[0]);
    let judged = Judged {
        axes: (axes_said(&said), flown[0].visibility.where_it_is()),
        ..judged(requests.entries, &said, &truth)
    };
    if kept.is_none() || judged.right {
        let _ = std::fs::remove_dir_all(&folder);
    }
    let line = told(&judged, &case);
    Ok((judged, line))
}

/// One line of a flight.
fn told(judged: &Judged, case: &RealCase) -> String {
    let stated: Vec<String> = judged
        .sizes
        .iter()
        .chain(&judged.bodies)
        .map(|Stated { name, value, std, truth }| format!("{name} {value:.3e} +- {std:.1e} ({truth:.3e})"))
        .collect();
    let source = if case.senses.source.motion_capture { "capture" } else { "receiver" };
    let way = if case.mission { "mission" } else { "series" };
    format!(
        "{} {:?} missed {:?} false {:?}; {source} {way}; {}",
        judged.verdict,
        judged.names,
        judged.missed,
        judged.others,
        stated.join(", ")
    )
}

fn words(value: &Value) -> Vec<String> {
    let all = value.as_array().into_iter().flatten();
    all.filter_map(|word| word.as_str().map(str::to_owned)).collect()
}

/// Judges a document by an answer.
fn judged(entries: &'static [&'static str], said: &Value, truth: &Value) -> Judged {
    let expect = words(&truth["expect"]);
    let (may, want): (Vec<_>, Vec<_>) = expect.into_iter().partition(|id| id.ends_with('?'));
    let may: Vec<String> =
        may.iter().map(|id| id.trim_end_matches('?').to_owned()).chain(want.clone()).collect();
    let effects: Vec<(String, Vec<String>)> = said["effects"]
        .as_array()
        .into_iter()
        .flatten()
        .map(|effect| {
            (effect["id"].as_str().unwrap_or_default().to_owned(), words(&effect["confusable_with"]))
        })
        .collect();
    let names: Vec<String> =
        effects.iter().map(|(id, _)| id.clone()).filter(|id| !ASKEW.contains(&id.as_str())).collect();
    let is_false = |(id, set): &&(String, Vec<String>)| {
        names.contains(id) && !may.contains(id) && !set.iter().any(|other| may.contains(other))
    };
    let others: Vec<String> = effects.iter().filter(is_false).map(|(id, _)| id.clone()).collect();
    let in_a_set = |id: &String| effects.iter().any(|(_, set)| set.contains(id));
    let (named, left): (Vec<_>, Vec<_>) = want.iter().cloned().partition(|id| names.contains(id));
    let (in_set, missed): (Vec<_>, Vec<_>) = left.into_iter().partition(in_a_set);
    let verdict = said["verdict"].as_str().unwrap_or_default().to_owned();
    let silent = want.is_empty() && verdict == "unexplained";
    let scaled = want.iter().any(|id| id == "thrust_curve" || id == "battery_sag");
    Judged {
        entries,
        right: others.is_empty() && missed.is_empty() && !silent,
        sizes: sizes(said, truth),
        bodies: if scaled { Vec::new() } else { bodies(said, truth) },
        moved: if scaled { Vec::new() } else { moved(said, truth) },
        verdict,
        named,
        in_set,
        missed,
        others,
        names,
        axes: ([false; 6], [false; 6]),
    }
}

fn axes_said(said: &Value) -> [bool; 6] {
    AXES.map(|name| {
        let axes = said["localisation"]["axes"].as_array().into_iter().flatten();
        axes.into_iter()
            .any(|axis| axis["axis"].as_str() == Some(name) && axis["share_percent"].as_f64() >= Some(10.0))
    })
}

/// Parameters whose truth is the effect's one number.
const SAME: [(&str, &[&str]); 9] = [
    ("linear_drag", &["dx", "dy"]),
    ("quadratic_drag", &["cx", "cy"]),
    ("inflow", &["kz"]),
    ("translational_lift", &["kh"]),
    ("motor_lag", &["time_constant"]),
    ("transport_delay", &["delay"]),
    ("rotor_inertia", &["jr"]),
    ("blade_flapping", &["k"]),
    ("ground_effect", &["rho"]),
];

/// Truth of an effect's parameter, where it is one number.
fn truth_of(effect: &str, parameter: &str, truth: &Value) -> Option<f64> {
    let value = &truth["effects"][effect];
    let place = |names: &[&str]| {
        let place = names.iter().position(|name| *name == parameter)?;
        value[place].as_f64()
    };
    match effect {
        "weak_rotor" if parameter == "factor" => value["factor"].as_f64(),
        "mass_change" if parameter == "delta" => value["delta"].as_f64(),
        "com_offset" => place(&["x", "y"]),
        "steady_wind" => place(&["north", "west"]),
        "angular_damping" => place(&["bx", "by", "bz"]),
        _ => {
            let (_, names) = SAME.iter().find(|(id, _)| *id == effect)?;
            names.contains(&parameter).then(|| value.as_f64())?
        }
    }
}

fn sizes(said: &Value, truth: &Value) -> Vec<Stated> {
    let mut out = Vec::new();
    for effect in said["effects"].as_array().into_iter().flatten() {
        let id = effect["id"].as_str().unwrap_or_default();
        for parameter in effect["parameters"].as_array().into_iter().flatten() {
            let name = parameter["name"].as_str().unwrap_or_default();
            if let (Some(truth), Some(value)) = (truth_of(id, name, truth), parameter["value"].as_f64()) {
                let std = parameter["std"].as_f64().unwrap_or(0.0);
                out.push(Stated { name: format!("{id}.{name}"), value, std, truth });
            }
        }
    }
    out
}

/// Names of the rigid body in a document and in an answer.
const BODY: [(&str, &str); 4] = [("mass", "mass"), ("ixx", "Ixx"), ("iyy", "Iyy"), ("izz", "Izz")];

fn bodies(said: &Value, truth: &Value) -> Vec<Stated> {
    let one = |(name, long): &(&'static str, &str)| {
        let parameter = &said["parameters"][name];
        Some(Stated {
            name: (*name).to_owned(),
            value: parameter["value"].as_f64()?,
            std: parameter["std"].as_f64().unwrap_or(0.0),
            truth: truth["true"][long].as_f64()?,
        })
    };
    BODY.iter().filter_map(one).collect()
}

fn moved(said: &Value, truth: &Value) -> Vec<Moved> {
    let one = |(name, long): &(&'static str, &str)| {
        let (body, truth) = (&said["rigid_body"][name], truth["true"][long].as_f64()?);
        let off = |value: &Value| value.as_f64().map(|value| value / truth - 1.0);
        Some(Moved { name, before: off(&body["before"])?, after: off(&body["after"]) })
    };
    BODY.iter().filter_map(one).collect()
}
