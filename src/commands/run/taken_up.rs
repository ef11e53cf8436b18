//! What an earlier run left unfinished in the folder: flights in which it ended, and logs of which it fetched a part.

use std::path::Path;

use mavid::text;

use super::context::Context;
use super::step::Step;
use crate::cli::VehicleLinkArgs;
use crate::commands::log::fetched_now;
use crate::commands::{CommandError, output};

/// Says which flights do not count, and fetches the rest of the vehicle's logs. That they cannot be had ends no run.
///
/// # Errors
/// A signal ended it.
pub fn take_up(context: &Context<'_>) -> Result<(), CommandError> {
    for folder in context.folder.cut_off() {
        output::message(&cut_off(&folder));
    }
    // the embedded vehicle of an earlier run is gone
    let Some(connect) = &context.args.connect else { return Ok(()) };
    let link = VehicleLinkArgs {
        connect: connect.clone(),
        system_id: context.args.system_id,
        signing_key_file: None,
    };
    for folder in context.folder.half_fetched() {
        fetch(context, &link, &folder)?;
    }
    Ok(())
}

fn cut_off(folder: &Path) -> String {
    format!(
        "{}: the program ended before this flight did. It does not count and is flown again; its recording stays, and mavid \
         explain reads it",
        text::path(folder)
    )
}

fn fetch(context: &Context<'_>, link: &VehicleLinkArgs, folder: &Path) -> Result<(), CommandError> {
    let step = Step::of(&["log", "fetch"])
        .option("--connect", &link.connect)
        .maybe("--system-id", link.system_id.map(|system| system.to_string()))
        .option("--out", folder);
    context.tell(&step);
    context.work.ends_itself();
    let fetched = fetched_now(link, folder);
    context.work.waits();
    match fetched {
        Err(error @ CommandError::Ended(_)) => Err(error),
        Err(error) => {
            let why = format!("the flight is explained without the rest of the vehicle's own log: {error}");
            output::message(&why);
            Ok(())
        }
        Ok(()) => Ok(()),
    }
}
