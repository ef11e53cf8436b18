//! What goes to standard error: messages as ever, log lines where they are asked for, and nothing where it is to be quiet.

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Runs it with this RUST_LOG.
fn mavid(variable: &str, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_mavid"))
        .args(arguments)
        .env("RUST_LOG", variable)
        .current_dir(root())
        .stdin(Stdio::null())
        .output()
        .unwrap()
}

fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

/// A file of this test alone.
fn written(name: &str, text: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("log_lines-{name}"));
    std::fs::write(&path, text).unwrap();
    path
}

/// A vehicle that is too heavy to fly, which is said.
fn heavy(name: &str) -> String {
    let text = std::fs::read_to_string(root().join("configs/qball2.toml")).unwrap();
    written(name, &text.replace("mass = 1.79", "mass = 4.0")).to_str().unwrap().to_owned()
}

const IDENTIFY: [&str; 4] =
    ["identify", "fixtures/p01_identify_0_25s.tlog", "--vehicle", "fixtures/p01_vehicle.toml"];

fn is_log_line(line: &str) -> bool {
    ["ERROR", "WARN", "INFO", "DEBUG", "TRACE"].iter().any(|level| line.contains(&format!(" {level} ")))
}

#[test]
fn each_v_says_more_and_results_stay_as_they_are() {
    let silent = mavid("", &IDENTIFY);
    assert!(silent.status.success());
    assert!(!stderr(&silent).lines().any(is_log_line), "{}", stderr(&silent));
    let mut lines = 0;
    for (flag, level) in [("-v", " INFO "), ("-vv", " DEBUG ")] {
        for arguments in [[&[flag][..], &IDENTIFY].concat(), [&IDENTIFY[..], &[flag]].concat()] {
            let output = mavid("", &arguments);
            assert!(output.status.success());
            assert_eq!(output.stdout, silent.stdout, "{arguments:?}");
            let said = stderr(&output);
            assert!(said.contains(level) && said.contains(" identify"), "{arguments:?}: {said}");
            assert!(said.lines().filter(|line| is_log_line(line)).count() > lines, "{arguments:?}: {said}");
        }
        lines = stderr(&mavid("", &[&[flag][..], &IDENTIFY].concat())).lines().count();
    }
    let json = [&["--json"][..], &IDENTIFY].concat();
    let plain = mavid("", &json);
    let logged = mavid("", &[&["-vvv"][..], &json].concat());
    assert_eq!(plain.stdout, logged.stdout);
    serde_json::from_slice::<serde_json::Value>(&logged.stdout).unwrap();
}

#[test]
fn a_quiet_program_says_nothing_but_errors() {
    let heavy = heavy("heavy_quiet.toml");
    for json in [&[][..], &["--json"]] {
        let arguments = [&["vehicle", heavy.as_str()][..], json].concat();
        let ordinary = mavid("", &arguments);
        assert!(stderr(&ordinary).contains("warning: "), "{}", stderr(&ordinary));
        for flag in ["-q", "--quiet"] {
            let quiet = mavid("", &[&[flag][..], &arguments].concat());
            assert_eq!((quiet.status.code(), stderr(&quiet).as_str()), (Some(0), ""));
            assert_eq!(quiet.stdout, ordinary.stdout);
        }
    }
    let out = Path::new(env!("CARGO_TARGET_TMPDIR")).join("quiet_plan.toml");
    let circle = ["-q", "plan", "configs/qball2.toml", "--circle", "1.0,8", "--out", out.to_str().unwrap()];
    assert_eq!(stderr(&mavid("", &circle)), "");
    let failed = mavid("", &["-q", "vehicle", "no-such-file.toml"]);
    assert_eq!(failed.status.code(), Some(2));
    let said = stderr(&failed);
    assert!(said.starts_with("mavid: ") && said.lines().count() == 1, "{said}");
}

/// A verb that talks to vehicles, where log lines have a thread of their own.
#[test]
fn a_simulated_vehicle_says_what_its_link_does_and_is_quiet_where_it_is_to_be() {
    let sitl = ["sitl", "--json", "--listen", "udpout:127.0.0.1:9", "--speed", "100", "--duration", "1"];
    let ordinary = mavid("", &sitl);
    assert!(!stderr(&ordinary).is_empty() && !stderr(&ordinary).contains("INFO"), "{}", stderr(&ordinary));
    let logged = mavid("", &[&["-v"][..], &sitl].concat());
    let opened = "link opened address=udpout:127.0.0.1:9 connected=true";
    assert!(stderr(&logged).contains(opened), "{}", stderr(&logged));
    assert_eq!(stderr(&mavid("", &[&["-q"][..], &sitl].concat())), "");
    let of_links = stderr(&mavid("warn,mavid::link=info", &[&["-q"][..], &sitl].concat()));
    assert!(of_links.contains(opened) && of_links.lines().all(is_log_line), "{of_links}");
}

#[test]
fn the_variable_overrides_the_flag() {
    let off = mavid("off", &[&["-vvv"][..], &IDENTIFY].concat());
    assert!(!stderr(&off).lines().any(is_log_line), "{}", stderr(&off));
    let of_identification = mavid("mavid::estimate=info", &IDENTIFY);
    assert!(
        stderr(&of_identification)
            .lines()
            .filter(|line| is_log_line(line))
            .all(|line| { line.contains("mavid::estimate") })
            && stderr(&of_identification).contains("mavid::estimate"),
        "{}",
        stderr(&of_identification)
    );
    // messages are none of its business
    let heavy = heavy("heavy_off.toml");
    let messages = [mavid("", &["vehicle", &heavy]), mavid("off", &["vehicle", &heavy])];
    assert_eq!(messages[0].stderr, messages[1].stderr);
}

#[test]
fn a_wrong_variable_and_wrong_flags_are_told() {
    for wrong in ["mavid=loud", "loud", "mavid[=info", "a\u{1b}[31m=\nmavid: all is well"] {
        let output = mavid(wrong, &["vehicle", "configs/qball2.toml"]);
        let said = stderr(&output);
        assert_eq!((output.status.code(), output.stdout.as_slice()), (Some(2), &b""[..]), "{said}");
        assert!(said.starts_with("mavid: RUST_LOG: expected a level (off, error, warn, info"), "{said}");
        assert!(said.contains("TARGET=LEVEL") && said.lines().count() == 1, "{said}");
        assert!(!said.contains('\u{1b}'), "{said}");
    }
    for flags in [&["-q", "-v", "vehicle"][..], &["-v", "vehicle", "-q"]] {
        let output = mavid("", &[flags, &["configs/qball2.toml"]].concat());
        assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
        assert!(stderr(&output).contains("expected one of --quiet and --verbose"), "{}", stderr(&output));
    }
}

/// What vehicles and files call themselves stands in fields of log lines.
#[test]
fn nothing_in_a_log_line_obeys_others() {
    let name = "a\u{1b}[31m\nmavid: all is well\u{9b}\u{202e}.toml";
    let missing = root().join(name);
    let listen =
        ["-vvv", "sitl", "--listen", "pty:/nowhere/x\u{1b}[31m\nmavid: all is well", "--duration", "1"];
    for arguments in [&["-vvv", "identify", name, "--vehicle", missing.to_str().unwrap()][..], &listen] {
        let said = stderr(&mavid("", arguments));
        let commands = |letter: char| letter != '\n' && mavid::text::is_command(letter);
        assert!(!said.is_empty() && !said.contains(commands), "{said:?}");
        assert!(!said.lines().any(|line| line.starts_with("mavid: all is well")), "{said}");
    }
}
