//! The Python module of the wheel, called as a notebook calls it.

use std::path::Path;
use std::process::Command;

use mavid::physics::effects::ALL;
use serde_json::json;

use crate::python;
use crate::require::{Needed, skip};

/// It needs no packages.
#[test]
fn python_is_told_where_the_program_was_expected() {
    let module = Path::new(env!("CARGO_MANIFEST_DIR")).join("python");
    let ask = "import mavid\ntry:\n    mavid.effects()\nexcept mavid.MavidError as error:\n    print(error.status, error)";
    let ran = Command::new(python::interpreter())
        .args(["-c", ask])
        .env("PYTHONPATH", module)
        .env("MAVID", "/nowhere/mavid")
        .output();
    let Ok(ran) = ran else { return skip(Needed::Tables, "no Python") };
    let said = String::from_utf8_lossy(&ran.stdout);
    assert!(
        said.starts_with("127 expected the path of the program in the environment variable MAVID"),
        "{said}{ran:?}"
    );
    assert!(said.contains("'/nowhere/mavid'") && said.contains("correct the variable"), "{said}");
}

#[test]
fn python_gets_dictionaries_arrays_and_a_table() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let fixture = |name: &str| root.join("fixtures").join(name).display().to_string();
    let given = json!({
        "program": env!("CARGO_BIN_EXE_mavid"),
        "module": root.join("python").display().to_string(),
        "log": fixture("p04_identify_10_22s.tlog"),
        "vehicle": fixture("p04_vehicle.toml"),
    });
    let found = match python::ask("call_from_python.py", &[], &given) {
        Ok(found) => found,
        Err(why) => return skip(Needed::Tables, &why),
    };
    // the file says 1.05 kg, the vehicle had 1.0 kg: fixtures/README.md
    let (mass, std) = (found["mass"].as_f64().unwrap(), found["mass_std"].as_f64().unwrap());
    assert!((mass - 1.0).abs() < 0.01 && (0.0..0.01).contains(&std), "{found}");
    assert!(found["verdict"] == "explained" && found["rows"].as_u64() > Some(7), "{found}");
    assert_eq!(found["rates"][0], found["times"]);
    assert_eq!((&found["rates"][1], &found["columns"]), (&json!(3), &json!(["x", "y", "z"])));
    assert_eq!(found["effects"].as_u64(), Some(ALL.len() as u64));
    assert!(
        found["refusal"][0] == 2 && found["refusal"][1].as_str().unwrap().contains("no-such-file"),
        "{found}"
    );
}
