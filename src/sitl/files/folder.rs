//! The vehicle's files by their paths.

use crate::sitl::logger::{LogFile, LogStore};

/// What is at a path.
#[derive(Debug)]
pub(super) enum Place<'a> {
    File(&'a LogFile),
    /// entries as a listing has them: `D` and the name, or `F`, the name, a tab and the size
    Folder(Vec<String>),
}

fn folder_entry(name: &str) -> String {
    format!("D{name}")
}

fn file_entry(log: &LogFile) -> String {
    format!("F{}\t{}", log.place().1, log.size())
}

/// The folders above the logs, one below the other, and those of each day.
pub(super) fn find<'a>(store: &'a LogStore, path: &str) -> Option<Place<'a>> {
    let parts: Vec<&str> = path.split('/').filter(|part| !part.is_empty()).collect();
    let root: Vec<&str> = store.root().split('/').filter(|part| !part.is_empty()).collect();
    if parts.len() < root.len() {
        let is_above = root.starts_with(&parts);
        return is_above.then(|| Place::Folder(vec![folder_entry(root[parts.len()])]));
    }
    let below = parts.strip_prefix(&root[..])?;
    match below {
        [] => Some(Place::Folder(entries(store))),
        [name] => {
            let within: Vec<String> =
                store.all().filter(|log| log.place().0.as_deref() == Some(name)).map(file_entry).collect();
            let file = store.all().find(|log| log.place() == (None, (*name).to_owned()));
            match file {
                Some(log) => Some(Place::File(log)),
                None => (!within.is_empty()).then_some(Place::Folder(within)),
            }
        }
        [day, name] => {
            let place = (Some((*day).to_owned()), (*name).to_owned());
            store.all().find(|log| log.place() == place).map(Place::File)
        }
        _ => None,
    }
}

/// The folder of all logs: a folder a day, or the logs.
fn entries(store: &LogStore) -> Vec<String> {
    let mut entries: Vec<String> = Vec::new();
    for log in store.all() {
        let entry = match log.place().0 {
            Some(day) => folder_entry(&day),
            None => file_entry(log),
        };
        if !entries.contains(&entry) {
            entries.push(entry);
        }
    }
    entries
}
