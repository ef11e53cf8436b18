//! What `mavid log` says, for programs and for people.

use mavid::fetch::{Checked, Place, RemoteLog, local_name};
use mavid::onboard::{Download, Listed, Session};
use mavid::text;
use serde::Serialize;

use super::hint::link_options;
use crate::cli::VehicleLinkArgs;

/// The document of `mavid log list`.
#[derive(Debug, Serialize)]
pub struct ListDocument {
    schema: u32,
    system: u32,
    autopilot: &'static str,
    protocol: &'static str,
    logs: Vec<LogLine>,
    /// entries whose names cannot be those of files
    left_out: usize,
}

#[derive(Debug, Serialize)]
struct LogLine {
    id: Option<u32>,
    name: Option<String>,
    bytes: u64,
    time_utc_s: Option<u32>,
}

/// The document of `mavid log fetch`.
#[derive(Debug, Serialize)]
pub struct FetchDocument {
    schema: u32,
    system: u32,
    autopilot: &'static str,
    protocol: &'static str,
    id: Option<u32>,
    log: String,
    bytes: u64,
    /// bytes that an earlier download had brought
    resumed_bytes: u64,
    duration_s: f64,
    /// `crc32`, `length`, or `growing`
    checked: &'static str,
    crc32: Option<u32>,
}

fn name(log: &RemoteLog) -> Option<String> {
    match &log.place {
        Place::Path(path) => Some(local_name(path)),
        Place::Number(_) => None,
    }
}

impl ListDocument {
    /// Of the logs of a vehicle.
    pub fn new(session: &Session, listed: &Listed) -> Self {
        let line = |log: &RemoteLog| LogLine {
            id: log.id,
            name: name(log),
            bytes: log.size,
            time_utc_s: log.time_s,
        };
        Self {
            schema: 1,
            system: session.vehicle.system.0,
            autopilot: session.stack.id,
            protocol: listed.protocol.id(),
            logs: listed.logs.iter().map(line).collect(),
            left_out: listed.left_out,
        }
    }

    /// For people.
    pub fn page(&self, link: &VehicleLinkArgs) -> String {
        let mut lines = vec![format!(
            "system {}, {}: {}",
            self.system,
            self.autopilot,
            match self.logs.len() {
                1 => "1 log".to_owned(),
                count => format!("{count} logs, oldest first"),
            }
        )];
        for log in &self.logs {
            let id = log.id.map_or_else(|| "-".to_owned(), |id| id.to_string());
            let name = log.name.clone().unwrap_or_default();
            // a vehicle without a clock says 0
            let time = log.time_utc_s.filter(|time_s| *time_s > 0);
            let time = time.map_or_else(String::new, |time_s| text::utc(u64::from(time_s) * 1_000_000));
            let line = format!("{id:>6}  {:>10.2} MB  {time}  {name}", log.bytes as f64 / 1e6);
            lines.push(line.trim_end().to_owned());
        }
        if self.left_out > 0 {
            lines.push(format!(
                "{} entries are left out: their names cannot be those of files",
                self.left_out
            ));
        }
        if let Some(last) = self.logs.last() {
            let id = last.id.map_or_else(|| "--last".to_owned(), |id| format!("--id {id}"));
            lines.push(format!("next: mavid log fetch {} {id}", link_options(link)));
        }
        lines.join("\n")
    }
}

impl FetchDocument {
    /// Of a log that was fetched.
    pub fn new(session: &Session, log: &RemoteLog, done: &Download) -> Self {
        let (checked, crc32) = match done.checked {
            Checked::Sum(sum) => ("crc32", Some(sum)),
            Checked::Length | Checked::NoAnswer => ("length", None),
            Checked::Grown(_) => ("growing", None),
        };
        Self {
            schema: 1,
            system: session.vehicle.system.0,
            autopilot: session.stack.id,
            protocol: done.protocol.id(),
            id: log.id,
            log: text::path(&done.path),
            bytes: done.bytes,
            resumed_bytes: done.resumed,
            duration_s: done.took.as_secs_f64(),
            checked,
            crc32,
        }
    }
}

/// A log that was fetched, for people.
pub fn page(done: &Download) -> String {
    let seconds = done.took.as_secs_f64().max(1e-3);
    let rate_kb_s = (done.bytes - done.resumed.min(done.bytes)) as f64 / seconds / 1e3;
    let resumed = match done.resumed {
        0 => String::new(),
        bytes => format!(" after {:.2} MB of an earlier download", bytes as f64 / 1e6),
    };
    let next = match done.bytes {
        0 => "it is empty: the vehicle wrote nothing into it".to_owned(),
        _ => format!("next: mavid inspect {}", text::path(&done.path)),
    };
    format!(
        "{}: {:.2} MB in {seconds:.1} s by {}, {rate_kb_s:.0} kB/s{resumed}\n{}\n{next}",
        text::path(&done.path),
        done.bytes as f64 / 1e6,
        done.protocol.words(),
        checked_words(done.checked)
    )
}

/// How a log was checked, in words.
pub(super) fn checked_words(checked: Checked) -> String {
    match checked {
        Checked::Sum(sum) => format!("its length and checksum ({sum:#010x}) are those of the vehicle"),
        Checked::Length => "its length is that of the vehicle; the vehicle offers no checksum".to_owned(),
        Checked::NoAnswer => {
            "its length is that of the vehicle; the vehicle did not answer for the checksum".to_owned()
        }
        Checked::Grown(bytes) => format!(
            "the vehicle still writes on it ({bytes} bytes now): only the part that existed at the start was fetched. It \
             has no checksum"
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_log_is_one_log() {
        let log = |id| LogLine { id: Some(id), name: None, bytes: 2_000_000, time_utc_s: None };
        let connect = "udpin:0.0.0.0:14550".to_owned();
        let link = VehicleLinkArgs { connect, system_id: None, signing_key_file: None };
        let page = |logs: Vec<LogLine>| {
            let (schema, system, autopilot, protocol) = (1, 1, "px4", "ftp");
            ListDocument { schema, system, autopilot, protocol, logs, left_out: 0 }.page(&link)
        };
        assert!(page(vec![log(7)]).starts_with("system 1, px4: 1 log\n"), "{}", page(vec![log(7)]));
        let dated = LogLine { time_utc_s: Some(1_700_000_000), ..log(7) };
        assert!(page(vec![dated]).contains("2.00 MB  2023-11-14 22:13:20 UTC"));
        let two = page(vec![log(7), log(8)]);
        assert!(two.starts_with("system 1, px4: 2 logs, oldest first\n"), "{two}");
        assert!(two.ends_with("next: mavid log fetch --connect udpin:0.0.0.0:14550 --id 8"), "{two}");
    }
}
