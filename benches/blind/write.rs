//! Puts flights down as cases, with their answers apart.

use std::collections::BTreeMap;
use std::path::Path;

use rayon::prelude::*;
use serde_json::{Map, Value, json};

use crate::maker::catalogue::Case;

/// Writes `folder/<case>/{vehicle.toml,identify.tlog,holdout.tlog}` and `folder/answers.json`.
pub fn write(folder: &Path, cases: &[Case]) {
    let numbered: Vec<(String, &Case)> =
        cases.iter().enumerate().map(|(place, case)| (format!("b{place:04}"), case)).collect();
    let answers: BTreeMap<String, Value> = numbered
        .par_iter()
        .filter_map(|(name, case)| {
            let flights = [case.fly(0).ok()?, case.fly(1).ok()?];
            let at = folder.join(name);
            std::fs::create_dir_all(&at).expect("a folder for the case");
            std::fs::write(at.join("vehicle.toml"), case.craft.file(name)).expect("room for the vehicle");
            for (which, file) in ["identify.tlog", "holdout.tlog"].into_iter().enumerate() {
                let bytes = case.log(&flights[which], which as u64);
                std::fs::write(at.join(file), bytes).expect("room for the flight");
            }
            Some((name.clone(), answer(case)))
        })
        .collect();
    println!("{} of {} cases in {}", answers.len(), cases.len(), folder.display());
    let text = serde_json::to_string_pretty(&answers).expect("answers as JSON");
    std::fs::write(folder.join("answers.json"), text).expect("room for the answers");
}

/// What was concealed.
fn answer(case: &Case) -> Value {
    let mut effects: Map<String, Value> = Map::new();
    for (id, name, value) in &case.truth {
        let entry = effects.entry((*id).to_owned()).or_insert_with(|| json!({}));
        entry[*name] = json!(value);
    }
    let inertia = &case.craft.inertia;
    json!({
        "expect": case.expect,
        "effects": effects,
        "vehicle": {
            "mass": case.craft.mass,
            "Ixx": inertia[(0, 0)], "Iyy": inertia[(1, 1)], "Izz": inertia[(2, 2)],
            "Ixy": inertia[(0, 1)], "Ixz": inertia[(0, 2)], "Iyz": inertia[(1, 2)],
            "k_eta": case.craft.thrust_coefficient,
            "k_m": case.craft.torque_coefficient,
        },
    })
}
