//! The download of one log, from the list to the file.

use std::path::{Path, PathBuf};
use std::time::Duration;

use mavid::autopilot::Autopilot;
use mavid::fetch::{
    Begun, Checked, Chosen, Download, List, Offer, Part, PartError, Protocol, RemoteLog, Wanted,
};
use mavid::text;

use super::session::{Flow, Session};
use crate::commands::{CommandError, output};

/// How far a download is.
#[derive(Debug, Clone)]
pub struct Progress {
    /// bytes that there are
    pub bytes: u64,
    /// and of how many
    pub of: u64,
    /// bytes a second, once they were measured by the way that stays
    pub bytes_s: Option<f64>,
    /// which way stays and why, once, where there was a choice
    pub chosen: Option<Chosen>,
}

/// Whom a download is told to while it goes on.
pub type Watch<'a> = &'a mut dyn FnMut(Progress) -> Flow;

/// A log that was fetched.
#[derive(Debug)]
pub struct Done {
    /// where it is
    pub path: PathBuf,
    /// how it was checked
    pub checked: Checked,
    /// bytes of it
    pub bytes: u64,
    /// bytes that an earlier download had brought
    pub resumed: u64,
    /// time of this download
    pub took: Duration,
    /// the way by which its end came
    pub protocol: Protocol,
}

/// The logs of a vehicle. Where the file transfer was not asked for by name and does not work, by log messages.
pub async fn list(
    session: &mut Session,
    (offer, asked): (&Offer, Option<Protocol>),
    wanted: Wanted,
) -> Result<(Protocol, Vec<RemoteLog>, usize), CommandError> {
    let protocol = asked.unwrap_or_else(|| offer.protocol());
    match listed(session, protocol, wanted).await {
        // a signal ends all of it
        Err(error @ CommandError::Failure(_)) if asked.is_none() && protocol == Protocol::Ftp => {
            output::warning(&format!("no file transfer: {error}; asking by log messages"));
            listed(session, Protocol::Log, wanted).await
        }
        done => done,
    }
}

async fn listed(
    session: &mut Session,
    protocol: Protocol,
    wanted: Wanted,
) -> Result<(Protocol, Vec<RemoteLog>, usize), CommandError> {
    let list = List::new(session.vehicle, protocol, wanted);
    let mut list = list.map_err(|error| CommandError::Input(error.to_string()))?;
    session.talk(&mut list, |_| Ok(Flow::On)).await?;
    Ok((protocol, list.logs(), list.left_out()))
}

/// Ending of the logs of an autopilot.
fn ending(autopilot: Autopilot) -> &'static str {
    if autopilot == Autopilot::Px4 { ".ulg" } else { ".bin" }
}

/// Fetches a log into a folder: by the protocol that listed it if one was asked for, by the faster one otherwise. `None`
/// where `watch` had enough: what came stays beside its place.
pub async fn fetch(
    session: &mut Session,
    (offer, asked): (&Offer, Option<Protocol>),
    log: &RemoteLog,
    (out, watch): (&Path, Watch<'_>),
) -> Result<Option<Done>, CommandError> {
    output::folder(out)?;
    let vehicle = session.known_as(offer);
    let mut part = Part::open(out, &vehicle, log, ending(session.vehicle.autopilot)).map_err(of_part)?;
    let resumed = match part.begun() {
        Begun::Anew => 0,
        Begun::After(bytes) => bytes,
    };
    let began = session.elapsed();
    let download = match asked {
        Some(_) => Download::new(session.vehicle, log, part.length()),
        None => Download::by_the_faster(session.vehicle, log, part.length()),
    };
    let mut download = download.map_err(|error| CommandError::Failure(error.to_string()))?;
    let ended = session
        .talk(&mut download, |download| {
            part.append(&download.ready()).map_err(of_part)?;
            Ok(watch(Progress {
                bytes: part.length(),
                of: download.size().unwrap_or(log.size),
                bytes_s: download.bytes_s(),
                chosen: download.chosen(),
            }))
        })
        .await;
    let flow = match ended {
        Ok(flow) => flow,
        Err(error) => {
            session.say(&download.farewell(session.elapsed())).await;
            return Err(match error {
                CommandError::Ended(why) => CommandError::Ended(format!(
                    "{why}; {} of {} bytes are kept, and the next download into the same folder goes on with them",
                    part.length(),
                    download.size().unwrap_or(log.size)
                )),
                other => other,
            });
        }
    };
    let Some(fetched) = download.fetched().filter(|_| flow == Flow::On) else {
        session.say(&download.farewell(session.elapsed())).await;
        return Ok(None);
    };
    let took = session.elapsed().saturating_sub(began);
    let checked = part.check(&fetched).map_err(of_part)?;
    let path = part.finish().map_err(of_part)?;
    let protocol = download.protocol();
    Ok(Some(Done { path, checked, bytes: fetched.size, resumed, took, protocol }))
}

fn of_part(error: PartError) -> CommandError {
    match error {
        PartError::Another { .. } | PartError::Taken { .. } => CommandError::Input(error.to_string()),
        PartError::Write { .. } | PartError::Sum { .. } => CommandError::Failure(error.to_string()),
    }
}

/// How a log was checked, in words.
pub fn words(checked: Checked) -> String {
    match checked {
        Checked::Sum(sum) => format!("its length and checksum ({sum:#010x}) are those of the vehicle"),
        Checked::Length => "its length is that of the vehicle; the vehicle offers no checksum".to_owned(),
        Checked::NoAnswer => {
            "its length is that of the vehicle; the vehicle did not answer for the checksum".to_owned()
        }
        Checked::Grown(bytes) => format!(
            "the vehicle still writes on it ({bytes} bytes now): this is what there was when the download began, and no \
             checksum is of it"
        ),
    }
}

/// What to do next with a log.
pub fn next(path: &Path) -> String {
    format!("next: mavid inspect {}", text::path(&path))
}
