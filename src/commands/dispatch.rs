//! The dispatch of the command line to its verb.

use super::standard_error::StandardError;
use super::{
    CommandError, Outcome, compare, convert, csv_map, demo, effects, explain, export, fleet, fly, identify,
    inspect, installed, log, plan, prove, record, redact, replay, report, simulate, sitl, validate, vehicle,
};
use crate::cli::{Cli, Verb};

/// Runs the verb.
pub fn run(cli: &Cli, stderr: &StandardError) -> Result<Outcome, CommandError> {
    match &cli.verb {
        Verb::Run(args) => super::run::run(cli.json, stderr, args),
        Verb::Demo(args) => demo::run(cli.json, stderr, args),
        Verb::Vehicle(args) => vehicle::run(cli.json, stderr, args),
        Verb::Plan(args) => plan::run(cli.json, stderr, args),
        Verb::Identify(args) => identify::run(cli.json, stderr, args),
        Verb::Simulate(args) => simulate::run(cli.json, args),
        Verb::Fly(args) => fly::run(cli.json, stderr, args),
        Verb::Sitl(args) => sitl::run(cli.json, args),
        Verb::Validate(args) => validate::run(cli.json, stderr, args),
        Verb::Inspect(args) => inspect::run(cli.json, stderr, args),
        Verb::Log(args) => log::run(cli.json, stderr, args),
        Verb::Record(args) => record::run(cli.json, stderr, args),
        Verb::Replay(args) => replay::run(cli.json, stderr, args),
        Verb::Explain(args) => explain::run(cli.json, stderr, args),
        Verb::Compare(args) => compare::run(cli.json, stderr, args),
        Verb::Report(args) => report::run(cli.json, args),
        Verb::Convert(args) => convert::run(cli.json, stderr, args),
        Verb::Fleet(args) => fleet::run(cli.json, stderr, args),
        Verb::FleetLog(args) => fleet::run_log(args),
        Verb::Export(args) => export::run(cli.json, args),
        Verb::Prove(args) => prove::run(cli.json, stderr, args),
        Verb::Redact(args) => redact::run(cli.json, args),
        Verb::Effects(args) => effects::run(cli.json, args),
        Verb::CsvMap(args) => csv_map::run(cli.json, args),
        Verb::Schema(args) => installed::schema(args),
        Verb::Completions(args) => installed::completions(args),
        Verb::Man(args) => installed::man(cli.json, args),
    }
}
