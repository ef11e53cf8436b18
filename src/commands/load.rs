//! `mavid vehicle load`: parameters of a file onto a vehicle, and back.

use crate::commands::agreement::SET;
use mavid::onboard::{self, Loading, ParameterComparison, ParameterFileError, Session, read_parameter_file};
use mavid::text;
use serde::Serialize;

use super::log::{agreed, all_put_back, link_options, notes_of_loaded, open, put_back_page};
use super::{CommandError, Outcome, network, output};
use crate::cli::LoadArgs;

#[derive(Debug, Default, Serialize)]
struct Document {
    schema: u32,
    system: u32,
    autopilot: &'static str,
    parameters: Vec<Line>,
    /// whether those that differed were set
    set: bool,
    /// those that are what they were before
    restored: Vec<Line>,
    /// the file with what was found
    notes: Option<String>,
}

#[derive(Debug, Serialize)]
struct Line {
    parameter: String,
    /// before; `null` where the vehicle does not have it
    found: Option<f64>,
    wanted: f64,
}

impl From<&ParameterComparison> for Line {
    fn from(ParameterComparison { name, found, in_file }: &ParameterComparison) -> Self {
        Self { parameter: name.clone(), found: *found, wanted: *in_file }
    }
}

/// Runs the verb.
pub fn run(json: bool, args: &LoadArgs) -> Result<Outcome, CommandError> {
    let file = args.file.as_deref().map(read_parameter_file).transpose();
    let file = file.map_err(|error: ParameterFileError| CommandError::Input(error.to_string()))?;
    network::block_on(async {
        let mut session = open(&args.link).await?;
        match &file {
            Some(file) => load(json, args, &mut session, file).await,
            None => undo(json, &mut session).await,
        }
    })
}

async fn load(
    json: bool,
    args: &LoadArgs,
    session: &mut Session,
    file: &[(String, f64)],
) -> Result<Outcome, CommandError> {
    let offer = session.offer().await?;
    let notes = notes_of_loaded(&session.known_as(&offer))?;
    let loading = onboard::compare(session, file).await?;
    refuse_unknown(args, session, &loading)?;
    if !json {
        output::text(&table(session, &loading))?;
    }
    let differing = loading.parameters.iter().filter(|parameter| parameter.differs()).count();
    let set = differing > 0 && (args.yes || !json && agreed(SET, "set these")?);
    if set {
        onboard::load(session, &loading, &notes).await?;
    }
    let place = text::path(&notes.path());
    if json {
        output::json(&Document {
            schema: 1,
            system: session.vehicle.system.0,
            autopilot: session.stack.id,
            parameters: loading.parameters.iter().map(Line::from).collect(),
            set,
            notes: set.then_some(place),
            ..Document::default()
        })?;
    } else if set {
        output::text(&format!(
            "{differing} set and read back; what was found stands in {place}\nto undo it: mavid vehicle load {} --undo",
            link_options(&args.link)
        ))?;
    } else if differing > 0 {
        output::text("nothing is changed; --yes sets it without a question")?;
    } else {
        output::text("nothing to change")?;
    }
    Ok(Outcome::Done)
}

/// All or nothing, unless told otherwise: a file for another autopilot or a simulator is refused.
fn refuse_unknown(args: &LoadArgs, session: &Session, loading: &Loading) -> Result<(), CommandError> {
    let unknown: Vec<&str> = loading
        .parameters
        .iter()
        .filter(|parameter| parameter.found.is_none())
        .map(|parameter| parameter.name.as_str())
        .collect();
    if unknown.is_empty() || args.known_only && unknown.len() < loading.parameters.len() {
        return Ok(());
    }
    Err(CommandError::Input(format!(
        "expected a file for this vehicle ({}), which does not have {}: nothing is changed. Is the file of another \
         autopilot, of another version of it, or for a simulator? --known-only sets what the vehicle has",
        session.stack.name,
        text::listed(unknown.iter())
    )))
}

fn table(session: &Session, loading: &Loading) -> String {
    let mut lines = vec![format!("system {}, {}:", session.vehicle.system, session.stack.name)];
    lines.push(format!("  {:<18}{:>14}{:>14}", "parameter", "now", "in the file"));
    lines.extend(loading.parameters.iter().map(|ParameterComparison { name, found, in_file }| {
        let found = found.map_or_else(|| "not there".to_owned(), |found| text::significant(found, 6));
        let same = if found == text::significant(*in_file, 6) { "  the same" } else { "" };
        format!("  {name:<18}{found:>14}{:>14}{same}", text::significant(*in_file, 6))
    }));
    lines.join("\n")
}

async fn undo(json: bool, session: &mut Session) -> Result<Outcome, CommandError> {
    let offer = session.offer().await?;
    let notes = notes_of_loaded(&session.known_as(&offer))?;
    let put_back = onboard::put_back(session, &notes).await?;
    if json {
        let restored = put_back.done.iter().map(|noted| Line {
            parameter: noted.name.clone(),
            found: Some(noted.set),
            wanted: noted.found,
        });
        output::json(&Document {
            schema: 1,
            system: session.vehicle.system.0,
            autopilot: session.stack.id,
            restored: restored.collect(),
            notes: (!put_back.failed.is_empty()).then(|| text::path(&notes.path())),
            ..Document::default()
        })?;
    } else {
        output::text(&put_back_page(&put_back))?;
    }
    all_put_back(&put_back, &text::path(&notes.path()))
}
