//! One log in a process of its own: it is bounded, and whatever becomes of it, rows come out.

use std::io::{Read, Write};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::mpsc;
use std::thread;

use super::limits::Limits;
use mavid::fleet::{LogRows, LogTask, error_rows, rows_of_text};
use mavid::text;

/// Most bytes that are taken of what a process writes.
const MOST_ROWS: u64 = 256 << 20;
/// Of its words.
const MOST_WORDS: u64 = 1 << 14;

/// Studies a log in a process of its own. Where that is ended by its bounds or fails, the rows say so.
pub fn studied(task: &LogTask, limits: &Limits) -> LogRows {
    rows(task, limits).unwrap_or_else(|why| error_rows(task, &why))
}

fn rows(task: &LogTask, limits: &Limits) -> Result<LogRows, String> {
    let written = text::json_line(task).map_err(|error| error.to_string())?;
    let mut child = begin(limits).map_err(|error| format!("cannot start a process: {error}"))?;
    let (Some(mut stdin), Some(stdout), Some(stderr)) =
        (child.stdin.take(), child.stdout.take(), child.stderr.take())
    else {
        return Err(ended(child, "a process without its streams".to_owned()));
    };
    let (sender, receiver) = mpsc::channel();
    // they end with the process, which is ended below
    let told = thread::spawn(move || read(stderr, MOST_WORDS));
    thread::spawn(move || {
        // one that stops early closes its end: its status tells
        let _ = stdin.write_all(written.as_bytes());
        drop(stdin);
        // nobody listens any more where it took too long
        let _ = sender.send(read(stdout, MOST_ROWS));
    });
    let Ok(text) = receiver.recv_timeout(limits.patience()) else {
        let why = format!("expected rows within {} s, got none: it was ended", limits.patience().as_secs());
        return Err(ended(child, why));
    };
    let status = child.wait().map_err(|error| error.to_string())?;
    if status.success() {
        return rows_of_text(&text).map_err(|error| error.to_string());
    }
    Err(reason(status, &told.join().unwrap_or_default(), limits))
}

fn begin(limits: &Limits) -> std::io::Result<Child> {
    Command::new(std::env::current_exe()?)
        .arg("fleet-log")
        .args(["--time", &limits.time_s.to_string(), "--memory", &limits.memory_mb.to_string(), "--quiet"])
        // the logs are studied side by side: each by itself takes one core
        .env("RAYON_NUM_THREADS", "1")
        .env_remove("RUST_LOG")
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
}

/// What a stream says, as far as it is text.
fn read(stream: impl Read, most: u64) -> String {
    let mut bytes = Vec::new();
    let _ = stream.take(most).read_to_end(&mut bytes);
    String::from_utf8_lossy(&bytes).into_owned()
}

/// Ends a process, and passes on why.
fn ended(mut child: Child, why: String) -> String {
    let _ = child.kill();
    let _ = child.wait();
    why
}

/// Why a process failed.
fn reason(status: ExitStatus, words: &str, limits: &Limits) -> String {
    let said = words.lines().map(str::trim).find(|line| !line.is_empty()).map(text::clean);
    if said.as_ref().is_some_and(|said| said.contains("memory allocation") || said.contains("out of memory"))
    {
        return format!("expected a log that takes at most {} MB of memory, it took more", limits.memory_mb);
    }
    if is_out_of_time(status) {
        return format!("expected a log that takes at most {} s, it took more", limits.time_s);
    }
    match said {
        Some(said) => format!("the process that read it failed: {said}"),
        None => format!("the process that read it failed: {status}"),
    }
}

#[cfg(unix)]
fn is_out_of_time(status: ExitStatus) -> bool {
    use rustix::process::Signal;
    use std::os::unix::process::ExitStatusExt;
    // a bound on both sides ends it by the harder signal
    status.signal().is_some_and(|signal| [Signal::XCPU.as_raw(), Signal::KILL.as_raw()].contains(&signal))
}

#[cfg(not(unix))]
fn is_out_of_time(_: ExitStatus) -> bool {
    false
}
