//! What the program knows of effects, and what it guesses of a table of unknown columns.

use std::path::Path;
use std::process::{Command, Output};

use mavid::config::{effects_of, load_csv_mapping, load_vehicle, parse_csv_mapping, parse_effect_tables};
use mavid::log::csv::CsvMapping;
use mavid::log::{self, OpenOptions};
use mavid::physics::effects::ALL;
use mavid::recording::{Quantity, Recording};

fn mavid(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_mavid")).args(arguments).output().unwrap()
}

fn said(arguments: &[&str]) -> String {
    let output = mavid(arguments);
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn every_effect_is_told_and_its_table_is_read_back() {
    let x500 = load_vehicle(&Path::new(env!("CARGO_MANIFEST_DIR")).join("configs/x500.toml")).unwrap();
    let document: serde_json::Value = serde_json::from_str(&said(&["effects", "--json"])).unwrap();
    let effects = document["effects"].as_array().unwrap();
    assert_eq!(effects.len(), ALL.len());
    for effect in effects {
        let id = effect["id"].as_str().unwrap();
        assert!(effect["equation"].as_str().unwrap().len() > 40, "{id}: {}", effect["equation"]);
        assert_eq!(effect["usual"].as_array().unwrap().len(), 4, "{id}");
        assert!(effect["parameters"].as_array().unwrap().iter().all(|one| one["unit"].is_string()), "{id}");
        let table = parse_effect_tables(effect["table"].as_str().unwrap(), id).unwrap();
        assert_eq!(effects_of(&table, id, &x500).unwrap()[0].effect().id(), id);
    }
    // all tables at once are one file for --effects
    let tables = parse_effect_tables(&said(&["effects", "--table"]), "tables").unwrap();
    assert_eq!(effects_of(&tables, "tables", &x500).unwrap().len(), ALL.len());
}

#[test]
fn one_effect_is_told_with_its_size_on_a_vehicle() {
    let page = said(&["effects", "linear_drag"]);
    for part in ["at each hub", "N/(m/s)", "palm-sized", "[[effect]]", "confused with"] {
        assert!(page.contains(part), "{part} is not in\n{page}");
    }
    // 0.3 N/(m/s) per kg: 1.79 kg
    let qball2 = Path::new(env!("CARGO_MANIFEST_DIR")).join("configs/qball2.toml").display().to_string();
    let table = said(&["effects", "linear_drag", "--table", "--vehicle", &qball2]);
    assert!(table.contains("dx = 0.537 "), "{table}");
    // lengths are of the vehicle: its arm is 46 mm, and 5 cm are concealed on one of 2 kg
    let crazyflie = Path::new(env!("CARGO_MANIFEST_DIR")).join("configs/crazyflie.toml");
    let small = load_vehicle(&crazyflie).unwrap();
    let of_small = ["effects", "--json", "--vehicle", &crazyflie.display().to_string()];
    let document: serde_json::Value = serde_json::from_str(&said(&of_small)).unwrap();
    for effect in document["effects"].as_array().unwrap() {
        let id = effect["id"].as_str().unwrap();
        let table = parse_effect_tables(effect["table"].as_str().unwrap(), id).unwrap();
        let acting = effects_of(&table, id, &small).unwrap();
        if id == "imu_offset" {
            assert!(
                acting[0].parameters().iter().all(|length| length.abs() < 0.5 * small.size().arm_m),
                "{table:?}"
            );
        }
    }
    let sag = said(&["effects", "battery_sag"]);
    assert!(sag.contains("size concealed in the tests; not known by class"), "{sag}");
    let weak = said(&["effects", "weak_rotor"]);
    let counted = "in files, counted from 0 in the vehicle file's order: motor 1 is 0";
    assert_eq!(weak.matches(counted).count(), 2, "{weak}");
    // which rotor it is has no usual size
    let usual = weak.split_once("usual size, by class of vehicle").unwrap().1;
    let usual = usual.split_once("confused with").unwrap().0;
    assert!(usual.contains("factor") && !usual.contains("rotor"), "{usual}");
    let flapping = said(&["effects", "blade_flapping"]);
    assert!(!flapping.contains("palm-sized"), "{flapping}");
    assert_eq!(said(&["effects", "Weak Rotor"]), weak, "by its name");
    let unknown = mavid(&["effects", "weak roter"]);
    assert_eq!(unknown.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&unknown.stderr).contains("expected one of linear_drag, "));
    assert!(String::from_utf8_lossy(&unknown.stderr).contains("the nearest is a weak rotor (weak_rotor)"));
}

/// A command that does not need the effects refuses them as well.
#[test]
fn a_models_effects_are_listed_and_checked_when_it_is_read() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let model = root.join("fixtures/models/first_explain.toml");
    let page = said(&["vehicle", &model.display().to_string()]);
    assert!(page.contains("  effects\n    linear_drag: dx "), "{page}");
    let text = std::fs::read_to_string(&model).unwrap().replace("linear_drag", "linear_dragg");
    let wrong = Path::new(env!("CARGO_TARGET_TMPDIR")).join("knowledge-wrong-effect.toml");
    std::fs::write(&wrong, text).unwrap();
    let refused = mavid(&["vehicle", &wrong.display().to_string()]);
    let stderr = String::from_utf8_lossy(&refused.stderr);
    assert_eq!(refused.status.code(), Some(2), "{stderr}");
    assert!(stderr.contains("`effect[0].id`: expected one of linear_drag, "), "{stderr}");
}

/// What a flight of ten seconds would be in a table with these columns.
fn table(name: &str, header: &str, row: impl Fn(f64) -> String) -> String {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("knowledge-{name}.csv"));
    let rows: String = (0..1000).map(|index| row(0.01 * f64::from(index)) + "\n").collect();
    std::fs::write(&path, format!("{header}\n{rows}")).unwrap();
    path.display().to_string()
}

/// The recording that the proposed mapping gives, and the proposal's document.
fn proposed(table: &str) -> (Recording, serde_json::Value) {
    let map = table.replace(".csv", ".toml");
    let document: serde_json::Value =
        serde_json::from_str(&said(&["csv-map", table, "--out", &map, "--json"])).unwrap();
    let columns = load_csv_mapping(Path::new(&map)).unwrap();
    let options = OpenOptions { columns, ..OpenOptions::default() };
    (log::open(Path::new(table), &options).unwrap().recording, document)
}

/// The mean of one value of a quantity.
fn mean(recording: &Recording, quantity: Quantity, slot: usize) -> f64 {
    let (_, stream) = recording.streams.iter().find(|(key, _)| key.quantity == quantity).unwrap();
    let values: Vec<f64> = (0..stream.len()).map(|index| stream.sample(index)[slot]).collect();
    values.iter().sum::<f64>() / values.len() as f64
}

#[test]
fn a_mapping_is_proposed_by_names_units_and_gravity() {
    // a logger of PX4's axes: microseconds, z down, degrees
    let down =
        table("down", "TimeUS,PosN,PosE,PosD,Roll,Pitch,Yaw,GyrX,GyrY,GyrZ,AccX,AccY,AccZ,C1,note", |t| {
            let turn = 40.0 * (6.0 * t).sin();
            format!(
                "{},1,2,-3,0.5,1,{},{turn},0,0,0,0,-9.8,1500,{}",
                1e6 * t,
                90.0 + turn,
                if t > 1.0 { "x" } else { "" }
            )
        });
    let (recording, document) = proposed(&down);
    assert!((mean(&recording, Quantity::SpecificForce, 2) - 9.8).abs() < 1e-9, "{document}");
    assert!((mean(&recording, Quantity::Position, 2) - 3.0).abs() < 1e-9, "{document}");
    let end_s =
        recording.streams.values().filter_map(|stream| stream.time_s.last()).copied().fold(0.0, f64::max);
    assert!((end_s - 9.99).abs() < 1e-6, "{end_s}");
    let unused = document["unused_columns"].as_array().unwrap();
    assert!(unused.iter().any(|column| column == "note"), "{document}");
    // a logger of z up: seconds, g, quaternion with w last, commands of 16 bits
    let up = table(
        "up",
        "t;x;y;z;q[0];q[1];q[2];q[3];gyro.x;gyro.y;gyro.z;acc.x;acc.y;acc.z;m1;m2;m3;m4;vbat",
        |t| format!("{t};0;0;1.5;0.01;0.02;0.1;0.99;0.1;0.2;0.3;0;0;1;30000;31000;29000;60000;11900"),
    );
    let (recording, document) = proposed(&up);
    assert!((mean(&recording, Quantity::SpecificForce, 2) - 9.806_65).abs() < 1e-6, "{document}");
    assert!(mean(&recording, Quantity::Attitude, 0) > 0.9, "{document}");
    assert!((mean(&recording, Quantity::ActuatorCommand, 3) - 60_000.0 / 65_535.0).abs() < 1e-9);
    assert!((mean(&recording, Quantity::BatteryVoltage, 0) - 11.9).abs() < 1e-9);
    let unsure = document["unsure"].to_string();
    assert!(
        unsure.contains("w is taken to be the last") && unsure.contains("full scale is 65535"),
        "{unsure}"
    );
}

#[test]
fn axes_are_those_of_each_groups_own_names() {
    let mixed = "time_s,pos_e,pos_n,pos_u,vel_n,vel_e,vel_d";
    let (recording, document) = proposed(&table("mixed", mixed, |t| format!("{t},1,2,3,4,5,6")));
    // the program's axes are north, west, up
    for (quantity, expected) in
        [(Quantity::Position, [2.0, -1.0, 3.0]), (Quantity::Velocity, [4.0, -5.0, -6.0])]
    {
        let found = [0, 1, 2].map(|slot| mean(&recording, quantity, slot));
        assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-9), "{quantity:?} {found:?}");
    }
    assert!(!document["unsure"].to_string().contains("the axes"), "{document}");
    // z alone shows that it is down, and is no name
    let (_, document) = proposed(&table("unnamed", "time_s,pos_x,pos_y,pos_z,vel_x,vel_y,vel_z", |t| {
        format!("{t},1,2,-9,1,0,0")
    }));
    assert!(document["unsure"].to_string().contains("z is down by the sign of the heights"), "{document}");
}

#[test]
fn the_columns_of_the_built_in_mapping_are_proposed_as_they_are() {
    let mapping =
        std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("configs/csv/default.toml"))
            .unwrap();
    let own = parse_csv_mapping(&mapping, "default.toml").unwrap();
    let names = |of: &CsvMapping| -> Vec<(Quantity, Vec<String>)> {
        let numbered =
            |column: &String| (1..=4).map(|n| column.replace("{n}", &n.to_string())).collect::<Vec<_>>();
        let columns = |columns: &[String]| match columns {
            [pattern] if pattern.contains("{n}") => numbered(pattern),
            columns => columns.to_vec(),
        };
        let mut names: Vec<_> =
            of.quantities.iter().map(|one| (one.quantity, columns(&one.columns))).collect();
        names.sort();
        names
    };
    // roll and yaw are the attitude of a logger that has no more
    let wanted: Vec<_> =
        names(&own).into_iter().filter(|(quantity, _)| *quantity != Quantity::RollYaw).collect();
    let header = wanted.iter().flat_map(|(_, columns)| columns.clone()).collect::<Vec<_>>();
    let cells =
        header.iter().map(|name| if name.ends_with("_z_m_s2") { ",9.8" } else { ",0.5" }).collect::<String>();
    let path = table("own", &format!("time_s,{}", header.join(",")), |t| format!("{t}{cells}"));
    let (_, document) = proposed(&path);
    let found = parse_csv_mapping(document["mapping"].as_str().unwrap(), "found").unwrap();
    assert_eq!(names(&found), wanted);
    assert_eq!(document["unused_columns"].as_array().unwrap().len(), 0, "{document}");
}

#[test]
fn body_rates_of_short_names_are_proposed_with_a_unit_to_be_confirmed() {
    for (name, rates, size, unit, other) in
        [("rad", "gx,gy,gz", 2.0, "rad/s", "deg/s"), ("deg", "p,q,r", 120.0, "deg/s", "rad/s")]
    {
        let path = table(&format!("short-{name}"), &format!("t,{rates},ax,ay,az"), |t| {
            format!("{t},{},0,0,0,0,9.8", size * (6.0 * t).sin())
        });
        let (recording, document) = proposed(&path);
        let (mapping, unsure) = (document["mapping"].as_str().unwrap(), document["unsure"].to_string());
        assert!(
            mapping.contains("name = \"angular_rate\"") && mapping.contains(&format!("unit = \"{unit}\""))
        );
        assert!(unsure.contains(&format!("the unit {unit}: the names say none")), "{unsure}");
        assert!(unsure.contains(&format!("Confirm it, or write {other}")), "{unsure}");
        assert_eq!(document["unused_columns"].as_array().unwrap().len(), 0, "{document}");
        assert!(mean(&recording, Quantity::AngularRate, 0).abs() < 0.3);
    }
}

#[test]
fn a_table_without_a_time_is_refused_with_its_columns() {
    let path = table("timeless", "a,b,c", |_| "1,2,3".to_owned());
    let output = mavid(&["csv-map", &path]);
    assert_eq!(output.status.code(), Some(2));
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(said.contains("expected a column of times") && said.contains("a, b, c"), "{said}");
}
