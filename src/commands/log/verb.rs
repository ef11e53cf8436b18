//! The runs of `mavid log list` and `mavid log fetch`.

use std::time::Instant;

use mavid::fetch::{LogSelection, Offer, RemoteLog};
use mavid::onboard::{self, Flow, Progress, Session};

use super::documents::{FetchDocument, ListDocument, page};
use super::link::open;
use super::{prepare, state};
use crate::cli::{LogArgs, LogFetchArgs, LogListArgs, LogVerb, VehicleLinkArgs};
use crate::commands::progress::{DownloadLines, bytes_bar};
use crate::commands::standard_error::StandardError;
use crate::commands::{CommandError, Outcome, live, network, output};

/// Runs the verb.
pub fn run(json: bool, stderr: &StandardError, args: &LogArgs) -> Result<Outcome, CommandError> {
    let (args, stderr) = (args.clone(), stderr.clone());
    live::run(move |work| {
        // a signal ends the conversation itself
        work.ends_itself();
        network::block_on(async {
            match &args.verb {
                LogVerb::List(args) => list(json, args).await,
                LogVerb::Fetch(args) => fetch(json, &stderr, args).await,
                LogVerb::Prepare(args) => prepare::run(json, args).await,
            }
        })
    })
}

async fn list(json: bool, args: &LogListArgs) -> Result<Outcome, CommandError> {
    let mut session = open(&args.link).await?;
    let offer = session.offer().await?;
    remind(&args.link, &session, &offer);
    let asked = args.protocol.map(Into::into);
    let listed = onboard::list(&mut session, (&offer, asked), LogSelection::All).await?;
    let document = ListDocument::new(&session, &listed);
    if json {
        output::json(&document)?
    } else {
        output::text(&document.page(&args.link))?
    }
    Ok(Outcome::Done)
}

async fn fetch(json: bool, stderr: &StandardError, args: &LogFetchArgs) -> Result<Outcome, CommandError> {
    let mut session = open(&args.link).await?;
    let offer = session.offer().await?;
    remind(&args.link, &session, &offer);
    let wanted = if args.last { LogSelection::Last } else { LogSelection::All };
    let asked = args.protocol.map(Into::into);
    let logs = onboard::list(&mut session, (&offer, asked), wanted).await?.logs;
    output::folder(&args.out)?;
    let begun = onboard::begun(&session, &logs, &args.out).filter(|_| !args.last && args.id.is_none());
    let log = begun.map_or_else(|| chosen(&logs, args.id), Ok)?;
    let bar = stderr.bar(bytes_bar(log.size));
    // where no bar can be drawn
    let mut lines = (!stderr.can_draw()).then(|| DownloadLines::new(Instant::now()));
    let mut watch = |progress: Progress| {
        let line = lines.as_mut().and_then(|lines| lines.due(Instant::now(), progress.bytes, progress.of));
        line.iter().for_each(|line| output::message(line));
        bar.set_length(progress.of);
        bar.set_position(progress.bytes);
        if let Some(chosen) = progress.chosen {
            output::message(&chosen.to_string());
        }
        Flow::On
    };
    let fetched = onboard::fetch(&mut session, (&offer, asked), log, (&args.out, &mut watch)).await;
    bar.finish_and_clear();
    let Some(done) = fetched? else {
        return Err(CommandError::Failure("the download did not come to its end".to_owned()));
    };
    if json {
        output::json(&FetchDocument::new(&session, log, &done))?;
    } else {
        output::text(&page(&done))?;
    }
    Ok(Outcome::Done)
}

/// Says what an earlier run changed on the vehicle and did not put back.
fn remind(link: &VehicleLinkArgs, session: &Session, offer: &Offer) {
    let noted = state::notes(&session.known_as(offer)).map(|notes| notes.read());
    // where there is no folder for notes there are none
    match noted {
        Ok(Ok(noted)) if !noted.is_empty() => output::message(&prepare::earlier(link, &noted)),
        Ok(Err(error)) => output::warning(&error.to_string()),
        _ => {}
    }
}

fn chosen(logs: &[RemoteLog], id: Option<u32>) -> Result<&RemoteLog, CommandError> {
    let Some(last) = logs.last() else {
        let none = "the vehicle has no log; it writes one while it is armed, or as its parameters say";
        return Err(CommandError::Failure(none.to_owned()));
    };
    let Some(id) = id else { return Ok(last) };
    logs.iter().find(|log| log.id == Some(id)).ok_or_else(|| {
        let known =
            |log: Option<&RemoteLog>| log.and_then(|log| log.id).map_or("?".to_owned(), |id| id.to_string());
        CommandError::Input(format!(
            "--id: expected a number of the list, {} to {}, got {id}",
            known(logs.first()),
            known(Some(last))
        ))
    })
}
