//! `mavid sitl` and `mavid fly` as processes.

#![allow(dead_code, clippy::unwrap_used)] // no test uses all of it

use std::io::{BufRead, BufReader};
use std::net::TcpListener;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;

/// Long after everything that is waited for.
pub const LONG: Duration = Duration::from_secs(180);

const MAVID: &str = env!("CARGO_BIN_EXE_mavid");

/// ArduPilot's GUIDED makes a lively trajectory calm unless it is allowed more than its defaults.
const LIVELY: &[&str] =
    &["WP_ACC=10", "WP_ACC_Z=6", "WP_SPD_UP=4", "WP_SPD_DN=4", "PSC_NE_JERK=40", "PSC_D_JERK=40"];

/// A process that ends with its owner.
pub struct Running(pub Child);

impl Running {
    /// Asks it to end, by SIGTERM.
    pub fn terminate(&self) {
        let id = self.0.id().to_string();
        assert!(Command::new("kill").args(["-TERM", &id]).status().unwrap().success());
    }

    /// Its exit status, once it has ended; never one of a signal.
    pub fn ended(&mut self, what: &str) -> i32 {
        until(what, || self.0.try_wait().unwrap().is_some());
        self.0.wait().unwrap().code().unwrap()
    }
}

/// Waits until it is done, and fails by saying what is not.
pub fn until(what: &str, mut done: impl FnMut() -> bool) {
    let deadline = Instant::now() + LONG;
    while !done() {
        assert!(Instant::now() < deadline, "{what}");
        std::thread::sleep(Duration::from_millis(10));
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// A file that ships with the project.
pub fn config(name: &str) -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("configs").join(name).display().to_string()
}

/// An empty folder of this test.
pub fn folder(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("flights").join(name);
    let _ = std::fs::remove_dir_all(&path);
    std::fs::create_dir_all(&path).unwrap();
    path
}

/// A port that nobody has.
pub fn free_port() -> u16 {
    TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port()
}

/// Starts an X500 with rotor speeds telemetered; returns with the address at which it listens, as it says.
pub fn vehicle(autopilot: &str, listen: &str) -> (Running, String) {
    let mut command = Command::new(MAVID);
    command.args(["--json", "sitl", "--vehicle", &config("x500.toml"), "--autopilot", autopilot]);
    command.args(["--warm-up", "2", "--esc-telemetry", "--listen", listen]);
    if autopilot == "ardupilot" {
        command.args(LIVELY.iter().flat_map(|parameter| ["--param", parameter]));
    }
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::null()).spawn().unwrap();
    let lines = BufReader::new(child.stdout.take().unwrap()).lines();
    let running = Running(child);
    // the document's last line is a lone brace
    let said: Vec<String> = lines.map_while(Result::ok).take_while(|line| line != "}").collect();
    let document: Value = serde_json::from_str(&format!("{}}}", said.join("\n"))).unwrap();
    (running, document["listen"][0].as_str().unwrap().to_owned())
}

/// Flies it, from the check to the explanation.
pub fn fly(out: &Path, connect: &str, trajectory: &Path, further: &[&str]) -> Output {
    Command::new(MAVID)
        .args(["--json", "fly", "--plain", "--arm", "--connect", connect, "--vehicle", &config("x500.toml")])
        .args(["--trajectory", &trajectory.display().to_string(), "--out", &out.display().to_string()])
        .args(further)
        // what is set on a vehicle is noted there
        .env("MAVID_STATE_DIR", out.with_file_name("state"))
        .output()
        .unwrap()
}

/// A lively trajectory for it of this many periods of 6 s.
pub fn planned(name: &str, periods: u64) -> PathBuf {
    let path = folder(name).join("trajectory.toml");
    let status = Command::new(MAVID)
        .args(["plan", &config("x500.toml"), "--limits", &config("demo/limits.toml"), "--criterion", "d-opt"])
        .args(["--period", "6", "--repeats", &periods.to_string(), "--starts", "8"])
        .args(["--out", &path.display().to_string()])
        .stdout(Stdio::null())
        .status()
        .unwrap();
    assert!(status.success());
    path
}
