//! Words of others that want the terminal, or a line of their own: they reach neither, whatever brings them.

use crate::support;

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use mavid::config::{parse_vehicle, vehicle_to_toml};
use mavid::export::{Format, export};
use mavid::text::is_command;
use mavlink::dialects::ardupilotmega::{self as dialect, MavMessage as M};
use support::{header, heartbeat, tlog, v2};

/// ESC, C0, C1, line breaks, bidi overrides, and what ends a comment, a string or an element.
const EVIL: &str = "x\u{1b}[31m\nmavid: all is well\r\u{9b}2J\u{7}\u{202e} <script>alert(1)</script> --> ]]> \
                    \"quoted\" 'single' \"\"\" \\ % {0} \u{2028}";

fn folder(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("foreign-{name}"));
    let _ = std::fs::remove_dir_all(&path);
    std::fs::create_dir_all(&path).unwrap();
    path
}

/// As TOML writes it.
fn quoted(words: &str) -> String {
    let escaped = |letter: char| match letter {
        '"' | '\\' => format!("\\{letter}"),
        letter if is_command(letter) => format!("\\u{:04x}", u32::from(letter)),
        letter => letter.to_string(),
    };
    format!("\"{}\"", words.chars().map(escaped).collect::<String>())
}

fn evil_vehicle() -> String {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("configs/x500.toml");
    let text = std::fs::read_to_string(file).unwrap();
    let name = text.lines().find(|line| line.starts_with("name = ")).unwrap();
    let text = text.replacen(name, &format!("name = {}", quoted(EVIL)), 1);
    let rotor = text.lines().filter(|line| line.starts_with("name = ")).nth(1).unwrap().to_owned();
    text.replacen(&rotor, &format!("name = {}", quoted(&format!("rotor {EVIL}"))), 1)
}

/// Heartbeats, texts and parameters.
fn evil_log() -> Vec<u8> {
    let mut frames = vec![v2(header(1, 0), &heartbeat())];
    for (sequence, words) in
        (1..).zip([EVIL.as_bytes(), b"\x9b31m \xff\xfe raw\x1b]0;t\x07", b"a\nmavid: all is well"])
    {
        let mut text = [0; 50];
        let count = words.len().min(50);
        text[..count].copy_from_slice(&words[..count]);
        let statustext = M::STATUSTEXT(dialect::STATUSTEXT_DATA {
            severity: dialect::MavSeverity::MAV_SEVERITY_CRITICAL,
            text: text.into(),
            ..Default::default()
        });
        let mut name = [0; 16];
        name[..6].copy_from_slice(b"MOT_\x1b\n");
        name[6..].copy_from_slice(&text[..10]);
        let parameter = M::PARAM_VALUE(dialect::PARAM_VALUE_DATA {
            param_value: 1.0,
            param_count: 900,
            param_id: name.into(),
            param_type: dialect::MavParamType::MAV_PARAM_TYPE_REAL32,
            ..Default::default()
        });
        frames.extend([v2(header(1, sequence), &statustext), v2(header(1, sequence), &parameter)]);
    }
    tlog(&frames)
}

fn run(arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_mavid"));
    // log lines quote others as well
    command.args(arguments).env("RUST_LOG", "trace").stdin(Stdio::null()).output().unwrap()
}

/// Nothing but line breaks commands, and no line is the others'.
fn assert_harmless(what: &str, bytes: &[u8]) {
    let text = std::str::from_utf8(bytes).unwrap();
    let command = text.char_indices().find(|(_, letter)| *letter != '\n' && is_command(*letter));
    assert!(command.is_none(), "{what}: {command:?} in {text:?}");
    assert!(!text.lines().any(|line| line.trim().starts_with("mavid: all is well")), "{what}: {text}");
}

#[test]
fn no_output_of_a_command_obeys_others() {
    let folder = folder("outputs");
    // a path commands as well as any other text
    let file = |name: &str| folder.join(format!("a\u{1b}[31m\nmavid: all is well\u{9b}{name}"));
    let (vehicle, log, broken) = (file("v.toml"), file("l.tlog"), file("b.toml"));
    std::fs::write(&vehicle, evil_vehicle()).unwrap();
    std::fs::write(&log, evil_log()).unwrap();
    std::fs::write(&broken, "\"evil\\u001b[31m\\nmavid: all is well\" = 1\n").unwrap();
    let (vehicle, log) = (vehicle.to_str().unwrap(), log.to_str().unwrap());
    let broken = broken.to_str().unwrap();
    for arguments in [
        &["vehicle", vehicle][..],
        &["--json", "vehicle", vehicle],
        &["vehicle", broken],
        &["inspect", log, "--vehicle", vehicle],
        &["--json", "inspect", log, "--vehicle", vehicle],
        &["identify", log, "--vehicle", vehicle],
        &["export", vehicle, "--to", "mjcf"],
        &["plan", vehicle, "--check", log],
        &["inspect", "a\u{1b}[31m\nmavid: all is well"],
        &[
            "fly",
            "--connect",
            "x\u{1b}\nmavid: all is well",
            "--trajectory",
            log,
            "--vehicle",
            vehicle,
            "--out",
            "o",
        ],
        &["\u{1b}[31m\nmavid: all is well"],
    ] {
        let output = run(arguments);
        let what = format!("{arguments:?}");
        assert_harmless(&what, &output.stdout);
        assert_harmless(&what, &output.stderr);
        if arguments[0] == "--json" {
            serde_json::from_slice::<serde_json::Value>(&output.stdout).unwrap();
        }
    }
    let said = String::from_utf8(run(&["inspect", log]).stdout).unwrap();
    assert!(said.contains("MOT_\\u{1b}\\n"), "what came is still to be seen: {said}");
}

#[test]
fn exported_files_hold_a_name_and_nothing_of_it_acts() {
    let vehicle = parse_vehicle(&evil_vehicle(), "evil.toml").unwrap().vehicle;
    for format in [Format::Px4Sih, Format::ArdupilotSitl, Format::Sdf, Format::Mjcf, Format::Rotorpy] {
        let text = export(&vehicle, &[], None, format).unwrap().text;
        assert_harmless(&format!("{format:?}"), text.as_bytes());
        assert!(!text.contains("<script>") || !text.starts_with('<'), "{text}");
        let name = text.lines().find(|line| line.contains("all is well"));
        match format {
            // parameters and Python: the name is in comments, each of one line
            Format::Px4Sih | Format::Rotorpy => {
                assert!(
                    text.lines()
                        .filter(|line| line.contains("all is well"))
                        .all(|line| line.starts_with('#'))
                );
            }
            Format::Sdf | Format::Mjcf => {
                assert!(name.unwrap().contains("&lt;script&gt;") && !text.contains("alert(1)<"))
            }
            Format::ArdupilotSitl => assert_eq!(name, None),
        }
    }
    let again = parse_vehicle(&vehicle_to_toml(&vehicle).unwrap(), "again.toml").unwrap();
    assert_eq!(again.vehicle.name, vehicle.name);
    assert!(again.warnings.is_empty(), "what was shown once is shown the same: {:?}", again.warnings);
}
