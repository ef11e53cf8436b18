//! `mavid vehicle load`: parameters of a file onto a vehicle, and back.

use crate::commands::agreement::SET;
use crate::commands::fly::is_attended;
use mavid::autopilot::of_simulator;
use mavid::fetch::Noted;
use mavid::onboard::{
    self, ChangedSince, Loaded, Loading, ParameterComparison, ParameterFileError, PutBack, Session,
    read_parameter_file,
};
use mavid::text;
use serde::Serialize;

use super::log::{agreed, all_put_back, link_options, notes_of_loaded, open, put_back_page};
use super::progress::Spinner;
use super::standard_error::StandardError;
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
    /// what the vehicle made of it by itself, where that is not what was wanted
    #[serde(skip_serializing_if = "Option::is_none")]
    became: Option<f64>,
}

impl From<&ParameterComparison> for Line {
    fn from(ParameterComparison { name, found, in_file }: &ParameterComparison) -> Self {
        Self { parameter: name.clone(), found: *found, wanted: *in_file, became: None }
    }
}

impl Line {
    /// With what the vehicle made of it.
    fn with(self, loaded: &Loaded) -> Self {
        let differing = loaded.differing.iter().find(|(change, _)| change.name == self.parameter);
        Self { became: differing.and_then(|(_, now)| *now), ..self }
    }
}

/// Runs the verb.
pub fn run(json: bool, stderr: &StandardError, args: &LoadArgs) -> Result<Outcome, CommandError> {
    let file = args.file.as_deref().map(read_parameter_file).transpose();
    let file = file.map_err(|error: ParameterFileError| CommandError::Input(error.to_string()))?;
    network::block_on(async {
        let mut session = open(&args.link).await?;
        match &file {
            Some(file) => load((json, stderr), args, &mut session, file).await,
            None => undo((json, stderr), args, &mut session).await,
        }
    })
}

async fn load(
    (json, stderr): (bool, &StandardError),
    args: &LoadArgs,
    session: &mut Session,
    file: &[(String, f64)],
) -> Result<Outcome, CommandError> {
    let shown = Spinner::of(stderr, format!("the vehicle is asked for {}", counted(file.len())));
    let offer = session.offer().await?;
    let notes = notes_of_loaded(&session.known_as(&offer))?;
    refuse_simulators(args, session, file).await?;
    let loading = onboard::compare(session, file).await?;
    drop(shown);
    refuse_unknown(args, session, &loading)?;
    if !json {
        output::text(&table(session, &loading))?;
    }
    let differing = loading.parameters.iter().filter(|parameter| parameter.differs()).count();
    let set = differing > 0 && (args.yes || !json && agreed(SET, "set these")?);
    let nobody_said = differing > 0 && !args.yes && (json || !is_attended());
    let loaded = if set {
        let _shown = Spinner::of(stderr, format!("setting {} and reading back", counted(differing)));
        onboard::load(session, &loading, &notes).await?
    } else {
        Loaded::default()
    };
    let place = text::path(&notes.path());
    if json {
        output::json(&Document {
            schema: 1,
            system: session.vehicle.system.0,
            autopilot: session.stack.id,
            parameters: loading
                .parameters
                .iter()
                .map(|parameter| Line::from(parameter).with(&loaded))
                .collect(),
            set,
            notes: set.then_some(place),
            ..Document::default()
        })?;
    } else if set {
        output::text(&set_page(&loaded, &place, &undo_command(args)))?;
    } else if nobody_said {
        // the error says it
    } else if differing > 0 {
        output::text("nothing is changed; --yes sets it without a question")?;
    } else {
        output::text("nothing to change")?;
    }
    if nobody_said {
        return Err(CommandError::Input(
            "expected --yes, or a terminal at which to agree, got neither: nothing is changed. Look at the values above, then add --yes"
                .to_owned(),
        ));
    }
    Ok(if loaded.differing.is_empty() { Outcome::Done } else { Outcome::DoneWithLoss })
}

fn undo_command(args: &LoadArgs) -> String {
    format!("mavid vehicle load {} --undo", link_options(&args.link))
}

/// So many parameters, in words.
fn counted(count: usize) -> String {
    if count == 1 { "1 parameter".to_owned() } else { format!("{count} parameters") }
}

/// A value as people write it.
fn short(value: f64) -> String {
    let digits = text::significant(value, 6);
    let has_fraction = digits.contains('.') && !digits.contains('e');
    if has_fraction { digits.trim_end_matches('0').trim_end_matches('.').to_owned() } else { digits }
}

/// What was set, for people.
fn set_page(loaded: &Loaded, place: &str, undo: &str) -> String {
    let mut lines = Vec::new();
    if !loaded.kept.is_empty() {
        lines.push(format!("{} set and read back", loaded.kept.len()));
    }
    for (change, now) in &loaded.differing {
        let (name, wanted) = (&change.name, short(change.set));
        lines.push(match now {
            Some(now) if *now == change.found => {
                format!("{name} is not set: the vehicle does not take {wanted} and keeps {}", short(*now))
            }
            Some(now) => format!(
                "{name} was set to {wanted}, and the vehicle made {} of it: {wanted} is not among the values that it uses",
                short(*now)
            ),
            None => format!("{name} was set to {wanted}, and the vehicle did not answer when it was read back"),
        });
    }
    lines.push(format!("what was found stands in {place}"));
    lines.push(format!("to undo it: {undo}"));
    lines.join("\n")
}

/// What a simulator is made to be does not get onto an aircraft, unless that is said.
async fn refuse_simulators(
    args: &LoadArgs,
    session: &mut Session,
    file: &[(String, f64)],
) -> Result<(), CommandError> {
    let own = of_simulator(file);
    if own.is_empty() || args.simulator || onboard::is_simulator(session).await? {
        return Ok(());
    }
    let name = args.file.as_deref().map(text::path).unwrap_or_default();
    Err(CommandError::Input(for_simulator((&name, &own), session.stack.id)))
}

/// Why a file with these parameters of a simulator's own is refused by a vehicle of this autopilot.
fn for_simulator((name, own): (&str, &[&str]), autopilot: &str) -> String {
    format!(
        "{name}: expected parameters of an aircraft, got those of a simulator ({}), and the vehicle does not say that it is one: nothing \
         is changed. For the aircraft: mavid export MODEL --to {autopilot}-params. If the vehicle is that simulator: --simulator",
        text::listed(own.iter())
    )
}

/// All or nothing, unless told otherwise: a file for another autopilot is refused.
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

async fn undo(
    (json, stderr): (bool, &StandardError),
    args: &LoadArgs,
    session: &mut Session,
) -> Result<Outcome, CommandError> {
    let shown = Spinner::of(stderr, "putting parameters back and reading them");
    let offer = session.offer().await?;
    let notes = notes_of_loaded(&session.known_as(&offer))?;
    let since = if args.overwrite { ChangedSince::Overwritten } else { ChangedSince::Kept };
    let put_back = onboard::put_back(session, &notes, since).await?;
    drop(shown);
    let place = text::path(&notes.path());
    let is_whole = put_back.failed.is_empty() && put_back.left.is_empty();
    if json {
        let restored = put_back.done.iter().map(|noted| Line {
            parameter: noted.name.clone(),
            found: Some(noted.became.unwrap_or(noted.set)),
            wanted: noted.found,
            became: None,
        });
        output::json(&Document {
            schema: 1,
            system: session.vehicle.system.0,
            autopilot: session.stack.id,
            restored: restored.collect(),
            notes: (!is_whole).then(|| place.clone()),
            ..Document::default()
        })?;
    } else {
        output::text(&put_back_page(&put_back))?;
    }
    none_left(&put_back, &undo_command(args))?;
    all_put_back(&put_back, &place)
}

/// Fails where somebody changed something since: it is not known whether that is to be lost.
fn none_left(put_back: &PutBack, undo: &str) -> Result<(), CommandError> {
    if put_back.left.is_empty() {
        return Ok(());
    }
    let one = |(noted, now): &(Noted, f64)| {
        let [set, now, found] = [noted.set, *now, noted.found].map(short);
        format!("{} (set to {set}, now {now}, before {found})", noted.name)
    };
    Err(CommandError::Failure(format!(
        "not put back, because somebody changed it since: {}. To put it back all the same: {undo} --overwrite",
        put_back.left.iter().map(one).collect::<Vec<_>>().join(", ")
    )))
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser as _;

    fn noted(set: f64) -> Noted {
        Noted { name: "MPC_THR_HOVER".to_owned(), found: 0.5, set, became: None, at: None }
    }

    #[test]
    fn what_a_vehicle_makes_of_a_value_is_told_apart() {
        let page = |now: Option<f64>| {
            let loaded = Loaded { kept: vec![noted(0.4)], differing: vec![(noted(7.0), now)] };
            set_page(&loaded, "notes", "undo")
        };
        assert!(page(Some(1.0)).starts_with(
            "1 set and read back\nMPC_THR_HOVER was set to 7, and the vehicle made 1 of it: 7 is not"
        ));
        assert!(page(Some(0.5)).contains("does not take 7 and keeps 0.5"));
        assert!(page(None).contains("did not answer"));
    }

    #[test]
    fn undo_takes_the_answer_yes_as_loading_does() {
        let words = ["mavid", "vehicle", "load", "--connect", "udpin:0.0.0.0:14550", "--undo", "--yes"];
        assert!(crate::cli::Cli::try_parse_from(words).is_ok());
        assert!(crate::cli::Cli::try_parse_from(&words[..5]).is_err());
    }

    #[test]
    fn a_file_for_a_simulator_says_what_it_is_and_how_it_is_loaded_all_the_same() {
        let said = for_simulator(("sih.params", &["SIH_MASS", "SIH_IXX"]), "px4");
        assert!(said.starts_with(
            "sih.params: expected parameters of an aircraft, got those of a simulator (SIH_MASS, SIH_IXX)"
        ));
        assert!(said.contains("nothing is changed") && said.contains("--to px4-params"), "{said}");
        assert!(said.ends_with("If the vehicle is that simulator: --simulator"), "{said}");
        let words =
            ["mavid", "vehicle", "load", "--connect", "udpin:0.0.0.0:14550", "sih.params", "--simulator"];
        assert!(crate::cli::Cli::try_parse_from(words).is_ok());
    }

    #[test]
    fn one_parameter_is_one() {
        assert_eq!([1, 2].map(counted), ["1 parameter", "2 parameters"]);
    }

    #[test]
    fn values_are_short() {
        assert_eq!(
            [7.0, 0.5, 0.0, -20.0, 0.389_742, 1200.0].map(short),
            ["7", "0.5", "0", "-20", "0.389742", "1200"]
        );
    }

    #[test]
    fn who_changed_it_since_is_asked_by_an_option() {
        let put_back = PutBack { left: vec![(noted(0.4), 0.6)], ..PutBack::default() };
        let said = none_left(&put_back, "mavid vehicle load --undo").unwrap_err().to_string();
        assert!(said.contains("MPC_THR_HOVER (set to 0.4, now 0.6, before 0.5)"), "{said}");
        assert!(said.ends_with("mavid vehicle load --undo --overwrite"), "{said}");
    }
}
