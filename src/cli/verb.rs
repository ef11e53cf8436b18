//! The command line as a whole: a verb, and what holds for each.

use std::ffi::OsString;

use clap::{ColorChoice, CommandFactory, FromArgMatches, Parser, Subcommand};

use super::compare::CompareArgs;
use super::convert::ConvertArgs;
use super::csv_map::CsvMapArgs;
use super::effects::EffectsArgs;
use super::fleet::{FleetArgs, FleetLogArgs};
use super::flight::FlyArgs;
use super::installed::{CompletionsArgs, ManArgs, SchemaArgs};
use super::live::{DemoArgs, RecordArgs, ReplayArgs, SitlArgs};
use super::model::{ExportArgs, SimulateArgs, VehicleArgs};
use super::onboard::LogArgs;
use super::plan::PlanArgs;
use super::recording::{ExplainArgs, IdentifyArgs, InspectArgs, ProveArgs, RedactArgs, ValidateArgs};
use super::report::ReportArgs;
use super::run::RunArgs;
use super::verbosity::Verbosity;

/// Identifies a multirotor's parameters from a flight and names the physical effects that the model lacks
#[derive(Debug, Parser)]
#[command(name = "mavid", version, arg_required_else_help = true, after_help = AFTER_HELP)]
pub struct Cli {
    /// Print one JSON document on standard output and nothing else there
    #[arg(long, global = true)]
    pub json: bool,
    /// Colours on a terminal. NO_COLOR in the environment means never where this is auto
    #[arg(long, global = true, value_enum, value_name = "WHEN", default_value_t)]
    pub color: ColorChoice,
    /// how much is said
    #[command(flatten)]
    pub verbosity: Verbosity,
    /// what to do
    #[command(subcommand)]
    pub verb: Verb,
}

const AFTER_HELP: &str = "Examples:\n  mavid demo\n  mavid explain flight.ulg --mass 2.0\n  mavid run --connect udpin:0.0.0.0:14540 --mass 2.0 --room 4,4,3\n\nExit status: 0 done, 1 failure, 2 bad usage or input, 3 done with loss or ended by a signal, 4 done and something changed (compare, fleet report).";

/// The verbs.
#[derive(Debug, Subcommand)]
pub enum Verb {
    /// From a vehicle to what its model lacks, step by step: plan, check, fly, explain, until every name is certain
    #[command(
        after_help = "Examples:\n  mavid run --connect udpin:0.0.0.0:14540 --mass 2.0 --room 6,6,4\n  mavid run --connect serial:/dev/ttyUSB0:57600 --mass 1.4 --rehearse --out first-flight\n  mavid run --sitl --yes"
    )]
    Run(RunArgs),
    /// Plan, fly, identify and explain the flight of a simulated vehicle with a concealed fault, in under two minutes
    #[command(after_help = "Examples:\n  mavid demo\n  mavid demo --effects concealed.toml --out drag-demo")]
    Demo(DemoArgs),
    /// Check a vehicle file (or a model) and print what follows from it
    #[command(
        after_help = "Examples:\n  mavid vehicle vehicle.toml\n  mavid vehicle init --from flight.ulg --mass 2.0 --out vehicle.toml"
    )]
    Vehicle(VehicleArgs),
    /// Plan an excitation trajectory inside limits, or check one
    #[command(
        after_help = "Examples:\n  mavid plan vehicle.toml --out plan.toml\n  mavid plan --mass 2.0 --frame quadrotor-x --limits room.toml --out plan.toml"
    )]
    Plan(PlanArgs),
    /// Identify mass and inertia from recorded flights
    #[command(
        after_help = "Examples:\n  mavid identify flight.ulg --mass 2.0 --out model.toml\n  mavid identify flight.tlog --vehicle vehicle.toml --with linear_drag,motor_lag"
    )]
    Identify(IdentifyArgs),
    /// Simulate the flight of a vehicle along a trajectory and write its log
    #[command(
        after_help = "Example:\n  mavid simulate vehicle.toml --trajectory plan.toml --out flight.tlog"
    )]
    Simulate(SimulateArgs),
    /// Fly a vehicle along a trajectory, record the flight and identify the vehicle from it
    #[command(
        after_help = "Example:\n  mavid fly --connect udpin:0.0.0.0:14540 --vehicle vehicle.toml --trajectory plan.toml --out flight1 --arm"
    )]
    Fly(FlyArgs),
    /// Run the embedded simulated vehicle, for any ground station
    #[command(
        after_help = "Examples:\n  mavid sitl\n  mavid sitl --autopilot ardupilot --effects concealed.toml --listen tcpin:127.0.0.1:5760"
    )]
    Sitl(SitlArgs),
    /// Compare models with recorded flights: closed loop, output prediction, open-loop playback
    #[command(
        after_help = "Example:\n  mavid validate flight.ulg --model vehicle.toml --model model.toml --out validation"
    )]
    Validate(ValidateArgs),
    /// Report what is in a log and what can be identified from it
    #[command(after_help = "Example:\n  mavid inspect flight.ulg --mass 2.0")]
    Inspect(InspectArgs),
    /// Record a MAVLink link until interrupted
    #[command(
        after_help = "Example:\n  mavid record --connect udpin:0.0.0.0:14550 --out flight.tlog --heartbeat"
    )]
    Record(RecordArgs),
    /// List and fetch the logs that a vehicle keeps of its flights
    #[command(after_help = "Example:\n  mavid log fetch --connect udpin:0.0.0.0:14550 --last")]
    Log(LogArgs),
    /// Play a recorded flight back as live traffic; nothing is commanded
    #[command(after_help = "Example:\n  mavid replay flight.tlog --to udpout:127.0.0.1:14550 --speed 4")]
    Replay(ReplayArgs),
    /// Locate the mismatch between model and recording and name the missing physical effects
    #[command(
        after_help = "Examples:\n  mavid explain flight.ulg --mass 2.0\n  mavid explain one.ulg two.ulg --vehicle vehicle.toml --next next.toml --out explained"
    )]
    Explain(ExplainArgs),
    /// Say what changed of a vehicle between flights: which rotor, the centre of mass, which parameter
    #[command(after_help = "Example:\n  mavid compare before.ulg --with after.ulg --mass 2.0")]
    Compare(CompareArgs),
    /// Print the report that run, explain or compare wrote into a folder: as Markdown, text, JSON or HTML
    #[command(
        after_help = "Examples:\n  mavid report mavid-run\n  mavid report explained --format text\n  mavid report explained --format html > report.html"
    )]
    Report(ReportArgs),
    /// Write the streams of a log as CSV, MCAP or Parquet, with what an explanation leaves of them
    #[command(after_help = "Example:\n  mavid convert flight.ulg --to csv --out streams")]
    Convert(ConvertArgs),
    /// Make tables of the logs of many vehicles, and say which of them changed
    #[command(
        after_help = "Examples:\n  mavid fleet logs/*.ulg --out tables --vehicles vehicles.toml\n  mavid fleet report tables"
    )]
    Fleet(FleetArgs),
    /// Study one log for `mavid fleet`, in a process of its own
    #[command(hide = true)]
    FleetLog(FleetLogArgs),
    /// Write a model for another simulator, or as parameters of the aircraft's own autopilot
    #[command(
        after_help = "Examples:\n  mavid export model.toml --to sdf --out model.sdf\n  mavid export model.toml --to px4-params --out vehicle.params"
    )]
    Export(ExportArgs),
    /// Explain a folder of cases and score the sealed verdicts against their answers
    #[command(after_help = "Example:\n  mavid prove cases --answers answers.json")]
    Prove(ProveArgs),
    /// Write a log to share: without positions on the Earth, serial numbers and keys
    #[command(after_help = "Example:\n  mavid redact flight.ulg --out shared.ulg")]
    Redact(RedactArgs),
    /// List the physical effects that the program can name, or tell one: equation, parameters, usual sizes, what it is confused with
    #[command(
        after_help = "Examples:\n  mavid effects\n  mavid effects linear_drag\n  mavid effects motor-lag\n  mavid effects weak_rotor --table"
    )]
    Effects(EffectsArgs),
    /// Propose what the columns of a CSV table mean, as a file for --csv-map
    #[command(after_help = "Example:\n  mavid csv-map flight.csv --out map.toml")]
    CsvMap(CsvMapArgs),
    /// Print the JSON Schema of the document that a verb writes with --json
    #[command(after_help = "Example:\n  mavid schema compare > compare.schema.json")]
    Schema(SchemaArgs),
    /// Print the completions of a shell
    #[command(
        after_help = "Example:\n  mavid completions bash > ~/.local/share/bash-completion/completions/mavid"
    )]
    Completions(CompletionsArgs),
    /// Write the manual pages into a folder
    #[command(after_help = "Example:\n  mavid man ~/.local/share/man/man1")]
    Man(ManArgs),
}

impl Cli {
    /// The command line of these arguments, the first of which is the program. Help and mistakes are in the colours that the
    /// arguments ask for, as far as they can be read.
    ///
    /// # Errors
    /// A question for help, or what cannot be parsed.
    pub fn of(arguments: impl IntoIterator<Item = OsString>) -> Result<Self, clap::Error> {
        let arguments: Vec<OsString> = arguments.into_iter().collect();
        let command = Self::command().color(color_of(&arguments));
        Self::from_arg_matches(&command.try_get_matches_from(arguments)?)
    }
}

/// What `--color` says, before anything else is parsed.
pub fn color_of(arguments: &[OsString]) -> ColorChoice {
    let words = || arguments.iter().filter_map(|argument| argument.to_str());
    let behind =
        words().zip(words().skip(1)).find(|(option, _)| *option == "--color").map(|(_, choice)| choice);
    let choice = behind.or_else(|| words().find_map(|word| word.strip_prefix("--color=")));
    choice.and_then(|choice| choice.parse().ok()).unwrap_or(ColorChoice::Auto)
}

/// Whether `--json` is among the arguments, before anything else is parsed.
pub fn is_json(arguments: &[OsString]) -> bool {
    arguments.iter().take_while(|argument| *argument != "--").any(|argument| argument == "--json")
}

impl Verb {
    /// It talks to vehicles: nothing in it waits for standard error.
    pub fn is_live(&self) -> bool {
        matches!(
            self,
            Self::Run(_) | Self::Demo(_) | Self::Fly(_) | Self::Sitl(_) | Self::Record(_) | Self::Replay(_)
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each verb that is shown, with the verbs above it.
    fn walk(command: &clap::Command, path: &str, check: &mut dyn FnMut(&clap::Command, &str)) {
        for verb in command.get_subcommands().filter(|verb| !verb.is_hide_set() && verb.get_name() != "help")
        {
            let path = format!("{path} {}", verb.get_name());
            check(verb, &path);
            walk(verb, &path, check);
        }
    }

    #[test]
    fn every_verb_has_an_example_that_can_be_typed() {
        let (mut verbs, mut wrong) = (0, Vec::new());
        let mut check = |verb: &clap::Command, path: &str| {
            verbs += 1;
            let help = verb.get_after_help().map(ToString::to_string).unwrap_or_default();
            let examples: Vec<&str> = help.lines().filter_map(|line| line.strip_prefix("  ")).collect();
            if examples.is_empty() {
                wrong.push(format!("{path}: no example in its help (after_help)"));
            }
            for example in examples {
                // the shell takes what stands behind >
                let typed = example.split(" > ").next().unwrap_or_default();
                let words = typed.split_whitespace().map(OsString::from);
                match Cli::of(words) {
                    Err(error) => wrong.push(format!("{example}: {error}")),
                    Ok(_) if !example.starts_with(path) => {
                        wrong.push(format!("{example}: is none of {path}"))
                    }
                    Ok(_) => {}
                }
            }
        };
        check(&Cli::command(), "mavid");
        walk(&Cli::command(), "mavid", &mut check);
        assert!(verbs > 25 && wrong.is_empty(), "{verbs} verbs\n{}", wrong.join("\n"));
    }

    #[test]
    fn the_parser_is_sound_and_colours_are_read_before_it() {
        Cli::command().debug_assert();
        let of = |words: &[&str]| color_of(&words.iter().map(OsString::from).collect::<Vec<_>>());
        assert_eq!(of(&["mavid", "--color", "never", "plan"]), ColorChoice::Never);
        assert_eq!(of(&["mavid", "plan", "--color=always"]), ColorChoice::Always);
        assert_eq!(of(&["mavid", "plan", "--color"]), ColorChoice::Auto);
        let json = |words: &[&str]| is_json(&words.iter().map(OsString::from).collect::<Vec<_>>());
        assert!(json(&["mavid", "plan", "--json"]) && !json(&["mavid", "plan", "--", "--json"]));
    }
}
