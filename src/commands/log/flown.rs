//! The vehicle's own log of a flight that has just ended.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use mavid::fetch::LogSelection;
use mavid::onboard::{self, Flow, Progress};
use mavid::wire::SystemId;

use super::before::{AFTER, link_of};
use super::documents::checked_words;
use super::hint;
use super::link::open_as;
use crate::cli::{FlyArgs, VehicleLinkArgs};
use crate::commands::leftover::STATION;
use crate::commands::live::Work;
use crate::commands::progress::DownloadLines;
use crate::commands::words::Word;
use crate::commands::{CommandError, network, output};

/// A download without `--fetch-log` is made only if it takes no longer than this.
const AT_MOST: Duration = Duration::from_secs(60);

/// How a log is fetched after a flight.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fetching {
    /// not at all
    Not,
    /// where the link is fast enough
    IfFast,
    /// however long it takes
    Always,
}

impl Fetching {
    /// By the arguments.
    pub fn of(args: &FlyArgs) -> Self {
        match (args.fetch_log, args.no_fetch_log) {
            (true, _) => Self::Always,
            (false, true) => Self::Not,
            (false, false) => Self::IfFast,
        }
    }
}

/// Fetches the log of the flight into its folder. Nothing of it makes a flight a failure: why there is no log is told.
/// The first Ctrl-C meanwhile ends the download alone, and the work after it goes on.
pub fn after_flight(
    (args, work): (&FlyArgs, &Work),
    system: Option<SystemId>,
    fetching: Fetching,
    tell: &mut impl FnMut(Word),
) -> Option<PathBuf> {
    if fetching == Fetching::Not {
        return None;
    }
    let link = link_of(args, system.map(|system| system.0));
    let station = SystemId(args.station_id);
    work.fetches();
    let how = (fetching, LogSelection::Last);
    let fetched = network::block_on(fetched((&link, station), &args.out, how, tell));
    let is_ended = matches!(fetched, Err(CommandError::Ended(_)));
    work.fetched(is_ended);
    fetched.unwrap_or_else(|error| {
        let later = later(&link, &args.out);
        let why = format!("the vehicle's own log is not fetched: {error}; {later}");
        tell(if fetching == Fetching::Always { Word::Warning(why) } else { Word::Message(why) });
        if is_ended {
            let goes_on = "the flight is analysed without it; Ctrl-C once more ends the program";
            tell(Word::Message(goes_on.to_owned()));
        }
        None
    })
}

/// Fetches the rest of the vehicle's own log into the folder of a flight that is over.
///
/// # Errors
/// The vehicle does not answer, or a signal ended it.
pub fn fetched_now(link: &VehicleLinkArgs, folder: &Path) -> Result<(), CommandError> {
    let mut tell = |word: Word| word.say();
    let how = (Fetching::IfFast, LogSelection::All);
    network::block_on(fetched((link, STATION), folder, how, &mut tell)).map(|_| ())
}

fn later(link: &VehicleLinkArgs, folder: &Path) -> String {
    format!("later: {}", hint::fetch_last(link, folder))
}

/// What is said of a download at this speed: that it goes on, or that it would take too long.
fn judged(progress: &Progress, bytes_s: f64, fetching: Fetching) -> Result<String, String> {
    let left = progress.of.saturating_sub(progress.bytes);
    let left_s = if bytes_s > 0.0 { left as f64 / bytes_s } else { f64::INFINITY };
    // what came while the speed was measured is not waited for
    let more = if progress.bytes > 0 { " more" } else { "" };
    let time =
        if left_s.is_finite() { format!("about {left_s:.0} s{more}") } else { "no end in sight".to_owned() };
    let there =
        if progress.bytes > 0 { format!("{:.1} of ", progress.bytes as f64 / 1e6) } else { String::new() };
    let size = format!("{there}{:.1} MB at {:.0} kB/s", progress.of as f64 / 1e6, bytes_s / 1e3);
    if fetching == Fetching::IfFast && left_s > AT_MOST.as_secs_f64() {
        return Err(format!(
            "the vehicle's own log would take too long ({size}: {time}): it is not fetched without --fetch-log"
        ));
    }
    Ok(format!("fetching the vehicle's own log, {size}: {time}"))
}

async fn fetched(
    (link, station): (&VehicleLinkArgs, SystemId),
    folder: &Path,
    (fetching, selection): (Fetching, LogSelection),
    tell: &mut impl FnMut(Word),
) -> Result<Option<PathBuf>, CommandError> {
    let mut session = open_as(link, station, AFTER).await?;
    let offer = session.offer().await?;
    let logs = onboard::list(&mut session, (&offer, None), selection).await?.logs;
    output::folder(folder)?;
    let mut path = None;
    match onboard::begun(&session, &logs, folder).or(logs.last()) {
        None => tell(Word::Message("the vehicle wrote no log of its own".to_owned())),
        Some(log) => {
            let (mut told, mut lines) = (false, DownloadLines::new(Instant::now()));
            let mut watch = |progress: Progress| {
                if let Some(line) = lines.due(Instant::now(), progress.bytes, progress.of) {
                    tell(Word::Message(format!("the vehicle's own log: {line}")));
                }
                if let Some(chosen) = &progress.chosen {
                    tell(Word::Message(format!("the vehicle's own log: {chosen}")));
                }
                let Some(bytes_s) = progress.bytes_s.filter(|_| !told) else { return Flow::On };
                told = true;
                match judged(&progress, bytes_s, fetching) {
                    Ok(words) => {
                        tell(Word::Message(words));
                        Flow::On
                    }
                    Err(words) => {
                        tell(Word::Message(format!("{words}; {}", later(link, folder))));
                        Flow::Stop
                    }
                }
            };
            let done = onboard::fetch(&mut session, (&offer, None), log, (folder, &mut watch)).await?;
            if let Some(done) = done {
                let took = done.took.as_secs_f64();
                tell(Word::Message(format!(
                    "the vehicle's own log: {}, {:.1} MB in {took:.1} s by {}; {}",
                    mavid::text::path(&done.path),
                    done.bytes as f64 / 1e6,
                    done.protocol.words(),
                    checked_words(done.checked)
                )));
                path = Some(done.path);
            }
        }
    }
    Ok(path)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_download_that_takes_longer_than_a_minute_is_made_only_where_it_is_asked_for() {
        let progress = Progress { bytes: 0, of: 7_000_000, bytes_s: None, chosen: None };
        let slow = judged(&progress, 1e5, Fetching::IfFast).unwrap_err();
        assert!(slow.contains("7.0 MB at 100 kB/s: about 70 s"), "{slow}");
        assert!(judged(&progress, 1e5, Fetching::Always).is_ok());
        let fast = judged(&progress, 2e5, Fetching::IfFast).unwrap();
        assert_eq!(fast, "fetching the vehicle's own log, 7.0 MB at 200 kB/s: about 35 s");
        let begun = Progress { bytes: 600_000, of: 1_600_000, ..progress.clone() };
        let rest = judged(&begun, 2e5, Fetching::IfFast).unwrap();
        assert_eq!(rest, "fetching the vehicle's own log, 0.6 of 1.6 MB at 200 kB/s: about 5 s more");
        let never = judged(&progress, 0.0, Fetching::IfFast).unwrap_err();
        assert!(never.contains("no end in sight"), "{never}");
    }
}
