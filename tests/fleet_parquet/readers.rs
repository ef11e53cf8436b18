//! Tables as Parquet and streams as MCAP, read by other people's programs.

use std::path::Path;
use std::process::Command;

use mavid::fleet::{PartsFolder, Schema};
use serde_json::json;

use crate::python::ask;
use crate::support::require::{Needed, skip};

#[test]
fn other_programs_read_the_tables_and_the_streams() {
    let at = Path::new(env!("CARGO_TARGET_TMPDIR")).join("fleet_parquet");
    let _ = std::fs::remove_dir_all(&at);
    let (out, streams) = (at.join("tables"), at.join("streams"));
    let fixture = |name: &str| Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures").join(name);
    let logs = [fixture("p01_identify_0_25s.tlog"), fixture("px4_flight.ulg")];
    let run = |arguments: &[&str]| {
        let output = Command::new(env!("CARGO_BIN_EXE_mavid")).args(arguments).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    };
    let [first, second] = logs.each_ref().map(|log| log.to_str().unwrap());
    let given = ["--mass", "2.06", "--size", "0.5", "--frame", "quadrotor-x"];
    let all =
        ["fleet", first, second, "--out", out.to_str().unwrap(), "--depth", "balance", "--part-logs", "1"];
    run(&[&all[..], &given].concat());
    run(&["convert", second, "--to", "mcap", "--out", streams.to_str().unwrap()]);
    run(&["convert", second, "--to", "parquet", "--out", streams.to_str().unwrap()]);
    let rows = PartsFolder::open(&out).unwrap().read_all().unwrap();
    assert_eq!(rows.logs.len(), 2);

    let mcap = streams.join("flight.mcap");
    let given = [out.to_str().unwrap(), mcap.to_str().unwrap()];
    let read = match ask("read_tables.py", &given, &json!(null)) {
        Ok(read) => read,
        Err(why) => return skip(Needed::Tables, &why),
    };
    for table in Schema::current().tables {
        let found = &read[table.name];
        let count = &found["duckdb"];
        assert_eq!((count, count), (&found["polars"], &found["pandas"]), "{}", table.name);
        assert_eq!(found["version"], "1");
        for column in &table.columns {
            assert_eq!(found["columns"][column.name], column.unit, "{}.{}", table.name, column.name);
        }
    }
    assert_eq!(read["legs"]["duckdb"], rows.legs.len());
    let mean = rows.legs.iter().map(|leg| leg.lean[0]).sum::<f64>() / rows.legs.len() as f64;
    assert!((read["mean_lean_x"].as_f64().unwrap() - mean).abs() < 1e-9);
    let topics = read["topics"].as_object().unwrap();
    assert!(topics.iter().any(|(topic, _)| topic.starts_with("/attitude/")), "{topics:?}");
    assert_eq!(topics["/pose"][0], "foxglove.PoseInFrame");
}
