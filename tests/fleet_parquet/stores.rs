//! Logs from a web server and from an object store, and tables in the store: the rows are those of files.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use mavid::fleet::{LogRows, PartsFolder};
use serde_json::Value;

use crate::server::Server;

fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures").join(name)
}

fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("fleet-stores-{name}"));
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

fn mavid(arguments: &[&str], server: &Server) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_mavid"));
    command.args(arguments).env_remove("HTTP_PROXY").env_remove("http_proxy").env("NO_PROXY", "127.0.0.1");
    command.env("AWS_ENDPOINT", format!("http://{}", server.address)).env("AWS_ALLOW_HTTP", "true");
    command.env("GOOGLE_BASE_URL", format!("http://{}", server.address)).env("GOOGLE_ALLOW_HTTP", "true");
    let open =
        r#"{"private_key": "none", "private_key_id": "none", "client_email": "none", "disable_oauth": true}"#;
    command.env("GOOGLE_SERVICE_ACCOUNT_KEY", open).env("AZURE_STORAGE_USE_EMULATOR", "true");
    command.env("AZURITE_BLOB_STORAGE_URL", format!("http://{}", server.address));
    command.env("AWS_ACCESS_KEY_ID", "key").env("AWS_SECRET_ACCESS_KEY", "secret").env("AWS_REGION", "here");
    command.output().unwrap()
}

fn said(output: &Output) -> String {
    format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr))
}

fn tally(output: &Output) -> Value {
    serde_json::from_slice(&output.stdout).unwrap_or_else(|error| panic!("{error}: {}", said(output)))
}

/// The rows without the addresses of their logs.
fn rows(out: &Path, from: &str, to: &str) -> LogRows {
    let mut rows = PartsFolder::open(out).unwrap().read_all().unwrap();
    rows.logs.iter_mut().for_each(|log| log.uri = log.uri.replace(from, to));
    rows.logs.sort_by(|a, b| a.uri.cmp(&b.uri));
    let moved = |text: &mut String| *text = text.replace(from, to);
    rows.logs.iter_mut().filter_map(|log| log.error.as_mut()).for_each(moved);
    rows.warnings.iter_mut().for_each(|warning| moved(&mut warning.text));
    rows
}

#[test]
fn a_web_server_gives_the_same_rows_as_files() {
    let (server, at) = (Server::start(), folder("web"));
    let names = ["p04_identify_10_22s.tlog", "px4_flight.ulg"];
    for name in names {
        server.put(&format!("/logs/{name}"), fs::read(fixture(name)).unwrap());
    }
    let head = format!("http://{}/logs", server.address);
    let addresses = names.map(|name| format!("{head}/{name}"));
    let (out, local) = (at.join("out"), at.join("local"));
    let all = [
        "fleet",
        &addresses[0],
        &addresses[1],
        "--out",
        out.to_str().unwrap(),
        "--depth",
        "balance",
        "--json",
    ];
    let output = mavid(&all, &server);
    assert_eq!((output.status.code(), &tally(&output)["logs"]), (Some(0), &2.into()), "{}", said(&output));
    let files = names.map(|name| fixture(name).display().to_string());
    let output = mavid(
        &["fleet", &files[0], &files[1], "--out", local.to_str().unwrap(), "--depth", "balance"],
        &server,
    );
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    let fixtures = fixture("").display().to_string();
    assert_eq!(rows(&out, &head, "logs"), rows(&local, fixtures.trim_end_matches('/'), "logs"));

    // what is there already is not even asked for but by its head
    server.requests();
    let output = mavid(&all, &server);
    assert_eq!(tally(&output)["done_before"], 2, "{}", said(&output));
    assert!(server.requests().iter().all(|request| request.starts_with("HEAD ")));

    for (address, expected) in [
        (format!("{head}/none.ulg"), "nothing of that name is there"),
        (format!("{head}/a.ulg?signature=x"), "with a query"),
        ("s3:///a.ulg".to_owned(), "without a bucket"),
    ] {
        let output = mavid(&["fleet", &address, "--out", at.join("refused").to_str().unwrap()], &server);
        assert_eq!(output.status.code(), Some(2), "{}", said(&output));
        assert!(said(&output).contains(expected), "{}", said(&output));
    }
}

#[test]
fn logs_and_tables_may_both_be_in_an_object_store() {
    let (server, at) = (Server::start(), folder("s3"));
    let whole = fs::read(fixture("px4_flight.ulg")).unwrap();
    server.put("/flights/2026/a.ulg", whole.clone());
    server.put("/flights/2026/deep/b.tlog", fs::read(fixture("p04_identify_10_22s.tlog")).unwrap());
    server.put("/flights/2026/deep/cut.ulg", whole[..whole.len() / 3].to_vec());
    server.put("/flights/2026/twin.ulg", whole.clone());
    server.put("/flights/2026/words.bin", b"this is no log at all\n".repeat(50));
    server.put("/flights/2026/notes.txt", b"not a log".to_vec());
    server.put("/flights/2025/old.ulg", whole);
    let all = ["fleet", "s3://flights/2026", "--out", "s3://tables/run", "--depth", "balance", "--json"];
    let output = mavid(&all, &server);
    let found = tally(&output);
    assert_eq!(
        (&found["logs"], &found["twins"], &found["errors"]),
        (&5.into(), &1.into(), &1.into()),
        "{found}"
    );
    assert_eq!(output.status.code(), Some(3), "{}", said(&output));

    // the same tables as of files, and nothing else is left
    let copy = at.join("copy");
    let kept = server.files.lock().unwrap().clone();
    for (path, bytes) in
        kept.iter().filter_map(|(path, bytes)| Some((path.strip_prefix("/tables/run/")?, bytes)))
    {
        assert!(!path.starts_with("_work"), "{path}");
        let path = copy.join(path);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, bytes).unwrap();
    }
    let logs = at.join("logs/2026");
    for (path, bytes) in
        kept.iter().filter_map(|(path, bytes)| Some((path.strip_prefix("/flights/2026/")?, bytes)))
    {
        fs::create_dir_all(logs.join(path).parent().unwrap()).unwrap();
        fs::write(logs.join(path), bytes).unwrap();
    }
    let local = at.join("local");
    let output = mavid(
        &["fleet", logs.to_str().unwrap(), "--out", local.to_str().unwrap(), "--depth", "balance"],
        &server,
    );
    assert_eq!(output.status.code(), Some(3), "{}", said(&output));
    assert_eq!(rows(&copy, "s3://flights/2026", "logs"), rows(&local, logs.to_str().unwrap(), "logs"));

    // again: nothing is read; a pattern takes a part; the report is written beside the tables
    server.requests();
    let again = tally(&mavid(&all, &server));
    assert_eq!((&again["done_before"], &again["parts"]), (&5.into(), &0.into()), "{again}");
    assert!(!server.requests().iter().any(|request| request.starts_with("GET /flights/2026/")));
    let part = tally(&mavid(
        &[
            "fleet",
            "s3://flights/*/*.ulg",
            "--out",
            at.join("part").to_str().unwrap(),
            "--depth",
            "inspect",
            "--json",
        ],
        &server,
    ));
    assert_eq!((&part["logs"], &part["twins"]), (&3.into(), &2.into()), "{part}");
    let report = mavid(&["fleet", "report", "s3://tables/run"], &server);
    assert!(matches!(report.status.code(), Some(0 | 3)), "{}", said(&report));
    assert!(server.files.lock().unwrap().contains_key("/tables/run/report.html"));
}

#[test]
fn stores_of_google_and_azure_give_the_same_rows_as_files() {
    let (server, at) = (Server::start(), folder("others"));
    let logs = at.join("logs");
    fs::create_dir_all(logs.join("deep")).unwrap();
    for (name, own) in [("p04_identify_10_22s.tlog", "a.tlog"), ("px4_flight.ulg", "deep/b.ulg")] {
        let bytes = fs::read(fixture(name)).unwrap();
        fs::write(logs.join(own), &bytes).unwrap();
        server.put(&format!("/flights/2026/{own}"), bytes.clone());
        server.put(&format!("/devstoreaccount1/flights/2026/{own}"), bytes);
    }
    let local = at.join("local");
    let run = |source: &str, out: &str| {
        let output = mavid(&["fleet", source, "--out", out, "--depth", "inspect"], &server);
        assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    };
    run(logs.to_str().unwrap(), local.to_str().unwrap());
    let expected = rows(&local, logs.to_str().unwrap(), "logs");
    assert_eq!(expected.logs.len(), 2);
    for scheme in ["gs", "az"] {
        let out = at.join(scheme);
        run(&format!("{scheme}://flights/2026/**/*"), out.to_str().unwrap());
        assert_eq!(rows(&out, &format!("{scheme}://flights/2026"), "logs"), expected);
    }
    // tables beside them
    run("gs://flights/2026", "gs://tables/run");
    let files = server.files.lock().unwrap();
    let parts =
        |table: &str| files.keys().filter(|path| path.starts_with(&format!("/tables/run/{table}/"))).count();
    assert_eq!((parts("logs"), parts("_parts"), parts("_work")), (1, 1, 0), "{:?}", files.keys());
}
