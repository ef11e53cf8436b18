//! Batches of logs through processes, and out as parts.

use std::collections::{BTreeMap, HashMap, HashSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;
use std::thread;
use std::time::UNIX_EPOCH;

use super::child::studied;
use super::identity::{hash, identity};
use super::limits::Bounds;
use crate::commands::CommandError;
use mavid::fleet::{
    At, Listed, LogRows, LogSettings, LogTask, PartForm, PartList, PartsError, PartsFolder, Shard, Source,
    error_rows, hexadecimal, rows_of_text, rows_text, unread_name,
};
use mavid::store::{Store, Stored};
use mavid::study::Progress;
use sha2::{Digest, Sha256};
use tempfile::TempDir;

/// What all logs have in common.
#[derive(Debug)]
pub struct Work<'a> {
    pub folder: &'a PartsFolder,
    pub settings: &'a LogSettings,
    /// of the settings
    pub digest: &'a str,
    pub bounds: Bounds,
    pub form: PartForm,
    pub shard: Shard,
    pub jobs: usize,
    pub part_logs: usize,
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

impl Tally {
    /// What became of a log by its rows.
    fn count(&mut self, rows: &LogRows) {
        match rows.logs.first().map(|log| log.status.as_str()) {
            Some("flown") => self.flown += 1,
            Some("no_flight") => self.no_flight += 1,
            Some("inspected") => self.inspected += 1,
            _ => self.errors += 1,
        }
    }
}

/// A log that is to be studied.
struct Ready<'a> {
    batch: usize,
    source: &'a Source,
    listed: Listed,
    /// names what is kept of it: the hash of its bytes, or of a log in a store that of its version
    key: String,
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
    fn ready<'s>(
        &self,
        sources: &'s [Source],
        (done, known): (&HashSet<&str>, &HashMap<&str, &Listed>),
        (tally, progress): (&mut Tally, &dyn Progress),
    ) -> Vec<Ready<'s>> {
        use rayon::prelude::*;
        let hashed: Vec<(Listed, Option<String>)> =
            sources.par_iter().map(|source| self.listed(source, known)).collect();
        let mut seen: HashSet<String> = HashSet::new();
        let mut ready: Vec<Ready<'s>> = Vec::new();
        for (source, (listed, refused)) in sources.iter().zip(hashed) {
            if done.contains(listed.sha256.as_str()) {
                tally.done_before += 1;
                progress.step();
            } else if !seen.insert(listed.sha256.clone()) {
                tally.twins += 1;
                progress.step();
            } else {
                let (batch, key) = (ready.len() / self.part_logs, listed.sha256.clone());
                ready.push(Ready { batch, source, listed, key, refused });
            }
        }
        ready
    }

    /// A log with its hash; of one that an earlier run read, and that was not changed since, by its list. A log in a store is not read
    /// here: until then the hash is that of its version.
    fn listed(&self, source: &Source, known: &HashMap<&str, &Listed>) -> (Listed, Option<String>) {
        let uri = || source.uri.clone();
        let listed =
            |sha256, (bytes, modified_ns)| Listed { sha256, uri: uri(), bytes, modified_ns, twin: false };
        let same = |stamps: (u64, u64)| {
            let same = known.get(source.uri.as_str());
            same.filter(|same| (same.bytes, same.modified_ns) == stamps && stamps.1 > 0)
        };
        match &source.at {
            At::File(path) => {
                let metadata = fs::metadata(path);
                let bytes = metadata.as_ref().map_or(0, fs::Metadata::len);
                let modified = metadata.as_ref().ok().and_then(|metadata| metadata.modified().ok());
                let since = modified.and_then(|time| time.duration_since(UNIX_EPOCH).ok());
                let stamps =
                    (bytes, since.map_or(0, |since| u64::try_from(since.as_nanos()).unwrap_or(u64::MAX)));
                if let Some(same) = same(stamps) {
                    return ((*same).clone(), None);
                }
                match identity(path, &self.bounds) {
                    Ok(sha256) => (listed(sha256, stamps), None),
                    Err(why) => (listed(unread_name(&source.uri, bytes), stamps), Some(why)),
                }
            }
            At::Stored(_, stored) => {
                let stamps = (stored.bytes, stored.modified_ns);
                let refused = self.bounds.refused(stored.bytes);
                let name = if refused.is_some() {
                    unread_name(&source.uri, stored.bytes)
                } else {
                    version_name(&source.uri, stored)
                };
                same(stamps).map_or_else(|| (listed(name, stamps), refused), |same| ((*same).clone(), None))
            }
        }
    }

    /// The rows of a log: as an earlier run left them, or by a process of its own.
    fn rows(&self, one: &Ready<'_>) -> LogRows {
        let task = |path: &Path, sha256: &str| LogTask {
            uri: one.source.uri.clone(),
            path: path.to_owned(),
            sha256: sha256.to_owned(),
            bytes: one.listed.bytes,
            settings: self.settings.clone(),
        };
        let unread = |why: &str| {
            error_rows(&task(Path::new(""), &unread_name(&one.source.uri, one.listed.bytes)), why)
        };
        if let Some(why) = &one.refused {
            return unread(why);
        }
        if let Some(rows) = self.folder.kept(&one.key, self.digest).and_then(|text| rows_of_text(&text).ok())
        {
            return rows;
        }
        let rows = match &one.source.at {
            At::File(path) => studied(&task(path, &one.key), &self.bounds.limits),
            At::Stored(store, stored) => match self.fetched(store, &stored.name) {
                Ok((copy, sha256)) => studied(&task(&copy.path, &sha256), &self.bounds.limits),
                // it may come at the next run: nothing is kept
                Err(why) => return unread(&why),
            },
        };
        // what cannot be kept is done again by the next run, no more
        if let Ok(text) = rows_text(&rows) {
            let _ = self.folder.keep((&one.key, self.digest), text);
        }
        rows
    }

    /// A copy of a log in a store, and the hash of its bytes.
    fn fetched(&self, store: &Store, name: &str) -> Result<(Copy, String), String> {
        let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
        // a drafted vehicle is called as its log is
        let last = name.rsplit('/').next().unwrap_or(name);
        let path = folder.path().join(last);
        let mut file = fs::File::create_new(&path).map_err(|error| error.to_string())?;
        store.download(name, &mut file, self.bounds.most_bytes).map_err(|error| error.to_string())?;
        let sha256 = hash(&path).map_err(|error| error.to_string())?;
        Ok((Copy { path, _folder: folder }, sha256))
    }

    /// Takes the rows as they come, and writes a batch as a part once it is whole. What is held is bounded: the batches that logs
    /// under way are of.
    fn collect<'r>(
        &self,
        ready: &'r [Ready<'r>],
        receiver: mpsc::Receiver<(&'r Ready<'r>, LogRows)>,
        (tally, progress): (&mut Tally, &dyn Progress),
    ) -> Result<(), CommandError> {
        let mut open: BTreeMap<usize, BTreeMap<&str, (&Ready<'_>, LogRows)>> = BTreeMap::new();
        for (one, rows) in receiver {
            progress.step();
            let batch = open.entry(one.batch).or_default();
            batch.insert(&one.source.uri, (one, rows));
            let size = self.part_logs.min(ready.len() - one.batch * self.part_logs);
            if batch.len() == size {
                let whole = open.remove(&one.batch).unwrap_or_default();
                self.write(whole.into_values().collect(), tally).map_err(failed)?;
            }
        }
        Ok(())
    }

    /// Writes a part. Of logs in stores only now is known which have the same bytes: the first of them has the rows.
    fn write(&self, batch: Vec<(&Ready<'_>, LogRows)>, tally: &mut Tally) -> Result<(), PartsError> {
        let (mut all, mut logs, mut keys) = (LogRows::default(), Vec::<Listed>::new(), Vec::new());
        let mut seen = HashSet::new();
        for (one, rows) in batch {
            let sha256 = rows.logs.first().map_or_else(|| one.key.clone(), |log| log.log.clone());
            let twin = !seen.insert(sha256.clone());
            if twin {
                tally.twins += 1;
            } else {
                tally.count(&rows);
                all.extend(rows);
            }
            logs.push(Listed { sha256, twin, ..one.listed.clone() });
            keys.push(&one.key);
        }
        self.folder.write_part((&all, logs), (self.form, self.digest, self.shard))?;
        tally.rows += all.count();
        tally.parts += 1;
        keys.iter().for_each(|key| self.folder.forget(key, self.digest));
        Ok(())
    }
}

/// A copy of a log, which goes with the value.
struct Copy {
    path: PathBuf,
    _folder: TempDir,
}

/// Stands for the hash of a log in a store that was not read yet.
fn version_name(uri: &str, stored: &Stored) -> String {
    let Stored { bytes, modified_ns, tag, .. } = stored;
    let version = format!("version: {uri} {bytes} {modified_ns} {}", tag.as_deref().unwrap_or(""));
    hexadecimal(&Sha256::digest(version.as_bytes()))
}

/// What keeps parts from being written or read.
pub fn failed(error: PartsError) -> CommandError {
    match error {
        PartsError::File { .. } | PartsError::Table { .. } => CommandError::Failure(error.to_string()),
        PartsError::OtherSettings { .. } | PartsError::Nothing { .. } | PartsError::Store(_) => {
            CommandError::Input(error.to_string())
        }
    }
}
