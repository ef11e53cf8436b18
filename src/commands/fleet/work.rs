//! Batches of logs through processes, and out as parts.

use std::collections::{BTreeMap, HashMap, HashSet};
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;
use std::thread;
use std::time::UNIX_EPOCH;

use super::child::studied;
use super::limits::Limits;
use crate::commands::CommandError;
use mavid::fleet::{
    Listed, LogRows, LogSettings, LogTask, PartForm, PartList, PartsError, PartsFolder, Shard, Source,
    error_rows, hexadecimal, rows_of_text, rows_text, unread_name,
};
use mavid::study::Progress;
use sha2::{Digest, Sha256};

/// What all logs have in common.
#[derive(Debug)]
pub struct Work<'a> {
    pub folder: &'a PartsFolder,
    pub settings: &'a LogSettings,
    /// of the settings
    pub digest: &'a str,
    pub limits: Limits,
    pub form: PartForm,
    pub shard: Shard,
    pub jobs: usize,
    pub part_logs: usize,
    /// bytes of the largest log that is read
    pub most_bytes: u64,
}

/// What became of the logs.
#[derive(Debug, Clone, Default, PartialEq, Eq, serde::Serialize)]
pub struct Tally {
    /// all that were found
    pub logs: usize,
    /// in the tables from an earlier run
    pub done_before: usize,
    /// the same bytes as another log
    pub twins: usize,
    /// with at least one flight
    pub flown: usize,
    /// read, without a flight that can be used
    pub no_flight: usize,
    /// read, and not asked for flights
    pub inspected: usize,
    /// could not be read within the bounds
    pub errors: usize,
    /// rows that were written
    pub rows: usize,
    /// parts that were written
    pub parts: usize,
}

/// A log that is to be studied.
struct Ready {
    batch: usize,
    task: LogTask,
    listed: Listed,
    /// why it is not read
    refused: Option<String>,
}

impl Work<'_> {
    /// Studies all logs that are in no part yet.
    pub fn run(
        &self,
        sources: &[Source],
        lists: &[PartList],
        progress: &dyn Progress,
    ) -> Result<Tally, CommandError> {
        let done: HashSet<&str> =
            lists.iter().flat_map(|list| &list.logs).map(|log| log.sha256.as_str()).collect();
        let known: HashMap<&str, &Listed> =
            lists.iter().flat_map(|list| &list.logs).map(|log| (log.uri.as_str(), log)).collect();
        let mut tally = Tally { logs: sources.len(), ..Tally::default() };
        progress.steps(sources.len() as u64);
        let ready = self.ready(sources, (&done, &known), (&mut tally, progress));
        let next = AtomicUsize::new(0);
        let (sender, receiver) = mpsc::sync_channel(self.jobs);
        thread::scope(|scope| {
            for _ in 0..self.jobs.min(ready.len()) {
                let (sender, next, ready) = (sender.clone(), &next, &ready);
                scope.spawn(move || {
                    while let Some(one) = ready.get(next.fetch_add(1, Ordering::Relaxed)) {
                        // the other end is gone where a part could not be written
                        if sender.send((one, self.rows(one))).is_err() {
                            return;
                        }
                    }
                });
            }
            drop(sender);
            self.collect(&ready, receiver, (&mut tally, progress))
        })?;
        Ok(tally)
    }

    /// The logs that are to be studied, in batches: hashed, each of the same bytes once.
    fn ready(
        &self,
        sources: &[Source],
        (done, known): (&HashSet<&str>, &HashMap<&str, &Listed>),
        (tally, progress): (&mut Tally, &dyn Progress),
    ) -> Vec<Ready> {
        use rayon::prelude::*;
        let hashed: Vec<(Listed, Option<String>)> =
            sources.par_iter().map(|source| self.listed(source, known)).collect();
        let mut seen: HashSet<String> = HashSet::new();
        let mut ready: Vec<Ready> = Vec::new();
        for (source, (listed, refused)) in sources.iter().zip(hashed) {
            if done.contains(listed.sha256.as_str()) {
                tally.done_before += 1;
                progress.step();
            } else if !seen.insert(listed.sha256.clone()) {
                tally.twins += 1;
                progress.step();
            } else {
                let task = LogTask {
                    uri: source.uri.clone(),
                    path: source.path.clone(),
                    sha256: listed.sha256.clone(),
                    bytes: listed.bytes,
                    settings: self.settings.clone(),
                };
                ready.push(Ready { batch: ready.len() / self.part_logs, task, listed, refused });
            }
        }
        ready
    }

    /// A log with its hash; of one that an earlier run read, and that was not changed since, by its list.
    fn listed(&self, source: &Source, known: &HashMap<&str, &Listed>) -> (Listed, Option<String>) {
        let metadata = fs::metadata(&source.path);
        let bytes = metadata.as_ref().map_or(0, fs::Metadata::len);
        let modified = metadata.as_ref().ok().and_then(|metadata| metadata.modified().ok());
        let since = modified.and_then(|time| time.duration_since(UNIX_EPOCH).ok());
        let modified_ns = since.map_or(0, |since| u64::try_from(since.as_nanos()).unwrap_or(u64::MAX));
        let listed = |sha256| Listed { sha256, uri: source.uri.clone(), bytes, modified_ns };
        let is_same =
            |same: &&&Listed| (same.bytes, same.modified_ns) == (bytes, modified_ns) && modified_ns > 0;
        if let Some(same) = known.get(source.uri.as_str()).filter(is_same) {
            return ((*same).clone(), None);
        }
        let unread = |why: String| (listed(unread_name(&source.uri, bytes)), Some(why));
        match metadata {
            Ok(metadata) if !metadata.is_file() => return unread("expected a file".to_owned()),
            Err(error) => return unread(error.to_string()),
            Ok(_) if bytes > self.most_bytes => {
                let most = self.most_bytes >> 20;
                return unread(format!("expected a log of at most {most} MB, got {} MB", bytes >> 20));
            }
            Ok(_) => (),
        }
        match hash(&source.path) {
            Ok(sha256) => (listed(sha256), None),
            Err(error) => unread(error.to_string()),
        }
    }

    /// The rows of a log: as an earlier run left them, or by a process of its own.
    fn rows(&self, one: &Ready) -> LogRows {
        if let Some(why) = &one.refused {
            return error_rows(&one.task, why);
        }
        let path = self.folder.work_file(&one.task.sha256, self.digest);
        if let Some(rows) = fs::read_to_string(&path).ok().and_then(|text| rows_of_text(&text).ok()) {
            return rows;
        }
        let rows = studied(&one.task, &self.limits);
        // what cannot be kept is done again by the next run, no more
        if let Ok(text) = rows_text(&rows) {
            let _ = self.folder.keep(&path, &text);
        }
        rows
    }

    /// Takes the rows as they come, and writes a batch as a part once it is whole. What is held is bounded: the batches that logs
    /// under way are of.
    fn collect<'r>(
        &self,
        ready: &'r [Ready],
        receiver: mpsc::Receiver<(&'r Ready, LogRows)>,
        (tally, progress): (&mut Tally, &dyn Progress),
    ) -> Result<(), CommandError> {
        let mut open: BTreeMap<usize, BTreeMap<&str, (&Ready, LogRows)>> = BTreeMap::new();
        for (one, rows) in receiver {
            progress.step();
            match rows.logs.first().map(|log| log.status.as_str()) {
                Some("flown") => tally.flown += 1,
                Some("no_flight") => tally.no_flight += 1,
                Some("inspected") => tally.inspected += 1,
                _ => tally.errors += 1,
            }
            let batch = open.entry(one.batch).or_default();
            batch.insert(&one.task.uri, (one, rows));
            let size = self.part_logs.min(ready.len() - one.batch * self.part_logs);
            if batch.len() == size {
                let whole = open.remove(&one.batch).unwrap_or_default();
                self.write(whole.into_values().collect(), tally).map_err(failed)?;
            }
        }
        Ok(())
    }

    fn write(&self, batch: Vec<(&Ready, LogRows)>, tally: &mut Tally) -> Result<(), PartsError> {
        let (mut all, mut logs, mut kept) = (LogRows::default(), Vec::new(), Vec::<PathBuf>::new());
        for (one, rows) in batch {
            all.extend(rows);
            logs.push(one.listed.clone());
            kept.push(self.folder.work_file(&one.task.sha256, self.digest));
        }
        self.folder.write_part((&all, logs), (self.form, self.digest, self.shard))?;
        tally.rows += all.count();
        tally.parts += 1;
        // one that stays is not read again: its log is in a part
        kept.iter().for_each(|path| drop(fs::remove_file(path)));
        Ok(())
    }
}

/// What keeps parts from being written or read.
pub fn failed(error: PartsError) -> CommandError {
    match error {
        PartsError::File { .. } | PartsError::Table { .. } => CommandError::Failure(error.to_string()),
        PartsError::OtherSettings { .. } | PartsError::Nothing { .. } => {
            CommandError::Input(error.to_string())
        }
    }
}

/// SHA-256 of a file, hexadecimal.
pub fn hash(path: &Path) -> std::io::Result<String> {
    let mut hasher = Sha256::new();
    std::io::copy(&mut File::open(path)?, &mut hasher)?;
    Ok(hexadecimal(&hasher.finalize()))
}
