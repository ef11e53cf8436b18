//! The logs of a vehicle by its folders.

use std::time::Duration;

use mavlink::dialects::ardupilotmega::MavMessage;

use super::ftp::{Answer, Ftp, Question};
use super::peer::Peer;
use super::remote::{LogSelection, Place, RemoteLog};
use super::{Dialogue, FetchError};
use crate::autopilot::Autopilot;
use crate::text;
use crate::wire::Frame;
use crate::wire::file_transfer::{operation, refusal};

/// Where the logs are, by autopilot.
const PX4_ROOTS: &[&str] = &["/fs/microsd/log", "/log"];
const ARDUPILOT_ROOTS: &[&str] = &["/APM/LOGS", "/logs"];
/// Entries of a folder, folders, and letters of a name, at most: a vehicle may say anything.
const ENTRIES: usize = 4096;
const FOLDERS: usize = 1024;
const LETTERS: usize = 64;
/// Tries of each request.
const TRIES: u32 = 12;

/// A folder whose entries are asked for.
#[derive(Debug)]
struct Folder {
    path: String,
    /// entries that came, also those that are no use
    count: u32,
    question: Question,
}

impl Folder {
    fn new(path: String) -> Self {
        let question = Question::new(operation::LIST, 0, &path);
        Self { path, count: 0, question }
    }
}

/// Lists the logs.
#[derive(Debug)]
pub(super) struct FtpList {
    ftp: Ftp,
    autopilot: Autopilot,
    selection: LogSelection,
    roots: std::slice::Iter<'static, &'static str>,
    open: Option<Folder>,
    /// folders below the root that are still to be listed, the next one last
    folders: Vec<String>,
    found: Vec<(String, u64)>,
    /// entries with impossible names
    pub(super) left_out: usize,
}

/// A name that can be one: no path in it, nothing that commands, not too long.
fn is_possible(name: &str) -> bool {
    let is_dots = matches!(name, "" | "." | "..");
    !is_dots && name.len() <= LETTERS && !name.contains(['/', '\\']) && !name.chars().any(text::is_command)
}

fn is_log(name: &str) -> bool {
    let lower = name.to_ascii_lowercase();
    lower.ends_with(".ulg") || lower.ends_with(".bin")
}

impl FtpList {
    pub(super) fn new(peer: Peer, autopilot: Autopilot, selection: LogSelection) -> Self {
        let roots = if autopilot == Autopilot::Px4 { PX4_ROOTS } else { ARDUPILOT_ROOTS };
        let mut roots = roots.iter();
        let open = roots.next().map(|root| Folder::new((*root).to_owned()));
        let (folders, found) = (Vec::new(), Vec::new());
        Self { ftp: Ftp::new(peer), autopilot, selection, roots, open, folders, found, left_out: 0 }
    }

    fn entries(&mut self, folder: &mut Folder, data: &[u8]) -> usize {
        let before = folder.count;
        for entry in data.split(|byte| *byte == 0).filter(|entry| !entry.is_empty()) {
            folder.count += 1;
            let entry = String::from_utf8_lossy(entry).into_owned();
            let mut letters = entry.chars();
            let kind = letters.next();
            let (name, size) = letters.as_str().split_once('\t').unwrap_or((letters.as_str(), "0"));
            let path = format!("{}/{name}", folder.path);
            match kind {
                Some('D' | 'F') if !is_possible(name) => {
                    self.left_out += usize::from(!matches!(name, "." | ".."));
                }
                Some('D') if self.folders.len() < FOLDERS && self.is_root(&folder.path) => {
                    self.folders.push(path)
                }
                Some('F') if is_log(name) && self.found.len() < ENTRIES => {
                    // a size that is no number is nought: opening the file tells
                    self.found.push((path, size.trim().parse().unwrap_or(0)));
                }
                _ => {}
            }
        }
        usize::try_from(folder.count - before).unwrap_or(0)
    }

    fn is_root(&self, path: &str) -> bool {
        PX4_ROOTS.contains(&path) || ARDUPILOT_ROOTS.contains(&path)
    }

    /// A folder is over: which one is next?
    fn open_next_folder(&mut self, is_root: bool) {
        if is_root {
            // days before those folders that have none, the newest last
            self.folders.sort_by_key(|path| {
                (
                    path.rsplit('/')
                        .next()
                        .is_some_and(|name| name.starts_with(|c: char| c.is_ascii_digit())),
                    path.clone(),
                )
            });
            if self.selection == LogSelection::All {
                self.folders.reverse();
            }
        }
        let is_enough = self.selection == LogSelection::Last && !self.found.is_empty();
        self.open = if is_enough { None } else { self.folders.pop().map(Folder::new) };
    }

    fn answer(&mut self, mut folder: Folder, answer: Answer) -> Result<(), FetchError> {
        let is_root = self.is_root(&folder.path);
        match answer {
            Answer::Data(data) if folder.count < u32::try_from(ENTRIES).unwrap_or(u32::MAX) => {
                if self.entries(&mut folder, &data) == 0 {
                    self.open_next_folder(is_root);
                    return Ok(());
                }
                folder.question = Question::new(operation::LIST, folder.count, &folder.path);
                self.open = Some(folder);
            }
            Answer::Data(_) | Answer::Refused(refusal::END) => self.open_next_folder(is_root),
            Answer::Refused(_) if !is_root => self.open_next_folder(false),
            Answer::Refused(code) => match self.roots.next() {
                Some(root) => self.open = Some(Folder::new((*root).to_owned())),
                None => {
                    let asked = format!("the folder {}", folder.path);
                    return Err(FetchError::Refused { asked, why: refusal::words(code).to_owned() });
                }
            },
        }
        Ok(())
    }

    /// The logs, oldest first.
    pub(super) fn logs(&self) -> Vec<RemoteLog> {
        let mut found = self.found.clone();
        found.sort();
        let all_known = self.selection == LogSelection::All;
        let log = |(index, (path, size)): (u32, (String, u64))| {
            let stem = path.rsplit('/').next().and_then(|name| name.split('.').next()).unwrap_or_default();
            let own = if self.autopilot == Autopilot::Px4 { None } else { stem.parse().ok() };
            let id = own.or(all_known.then_some(index));
            RemoteLog { id, place: Place::Path(path.clone()), size, time_s: None }
        };
        (0..).zip(found).map(log).collect()
    }
}

impl Dialogue for FtpList {
    fn poll(&mut self, now: Duration) -> Result<Option<MavMessage>, FetchError> {
        let Some(mut folder) = self.open.take() else { return Ok(None) };
        if let Some(answer) = folder.question.answer() {
            self.answer(folder, answer)?;
            return self.poll(now);
        }
        let expected = format!("the list of {}", folder.path);
        let message = folder.question.poll(now, &mut self.ftp, (&expected, TRIES, None));
        self.open = Some(folder);
        message
    }

    fn take(&mut self, now: Duration, frame: &Frame<'_>) {
        if let Some(folder) = &mut self.open {
            folder.question.take(now, &mut self.ftp, frame);
        }
    }

    fn is_done(&self) -> bool {
        self.open.is_none()
    }
}
