//! Verbs that speak to vehicles or stand for one.

use super::address::{ADDRESS, LISTEN};
use super::given::DraftArgs;
use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use mavid::autopilot::{Autopilot, STACKS};
use mavid::sitl::Firmware;
use std::path::PathBuf;

/// Arguments of `mavid demo`.
#[derive(Debug, Clone, Args)]
pub struct DemoArgs {
    /// new folder for everything [default: mavid-demo, or the first of mavid-demo-2, -3, ... that is free]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// what to conceal instead of the demo's own: [[effect]] tables with `id` and the parameters by name
    #[arg(long, value_name = "FILE")]
    pub effects: Option<PathBuf>,
    /// print lines instead of a progress bar
    #[arg(long)]
    pub plain: bool,
}

/// Arguments of `mavid sitl`.
#[derive(Debug, Clone, Args)]
pub struct SitlArgs {
    /// vehicle.toml or model.toml of the simulated vehicle; without it, and without --mass, a Holybro X500
    #[arg(long, value_name = "FILE", conflicts_with_all = ["mass", "size", "frame"])]
    pub vehicle: Option<PathBuf>,
    /// in its place
    #[command(flatten)]
    pub draft: DraftArgs,
    /// effects to conceal from whoever connects: [[effect]] tables with `id` and the parameters by name
    #[arg(long, value_name = "FILE")]
    pub effects: Option<PathBuf>,
    #[arg(long, value_name = "ADDRESS", help = LISTEN)]
    pub listen: Vec<String>,
    /// the autopilot that is simulated
    #[arg(long, value_parser = autopilots(), default_value = "px4")]
    pub autopilot: Autopilot,
    /// ArduPilot release whose names and units of parameters are used [default: 4.7]
    #[arg(long, value_parser = ardupilot_versions())]
    pub ardupilot_version: Option<Firmware>,
    /// speed, in multiples of real time
    #[arg(long, value_name = "N", default_value_t = 1.0, allow_negative_numbers = true)]
    pub speed: f64,
    /// in step with the ground station: time advances by 20 ms for each message that it sends, or when it is silent
    #[arg(long, conflicts_with = "speed")]
    pub lockstep: bool,
    /// seed of the noise; the same seed gives the same flight
    #[arg(long, default_value_t = 0)]
    pub seed: u64,
    /// factor on the sensors' noise
    #[arg(long, default_value_t = 1.0, allow_negative_numbers = true)]
    pub noise: f64,
    /// MAVLink system id
    #[arg(long, value_name = "ID", default_value_t = 1, value_parser = clap::value_parser!(u8).range(1..))]
    pub system: u8,
    /// send measured rotor speeds
    #[arg(long)]
    pub esc_telemetry: bool,
    /// simulate a pilot's transmitter that is on, with centred sticks
    #[arg(long)]
    pub transmitter: bool,
    /// time from boot until the position estimate is good, s [default: the autopilot's own]
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    pub warm_up: Option<f64>,
    /// a parameter of the autopilot instead of its default; may be given several times
    #[arg(long, value_name = "NAME=VALUE", value_parser = parameter)]
    pub param: Vec<(String, f64)>,
    /// parameters of a real vehicle, as `fly` and `run` write them: those that the simulated autopilot has take the place of its
    /// defaults, but for those of the battery
    #[arg(long, value_name = "PARAMETERS.TOML")]
    pub parameters: Option<PathBuf>,
    /// sign, and accept only signed messages: a file with 32 bytes, 64 hexadecimal digits, or a passphrase
    #[arg(long, value_name = "FILE")]
    pub signing_key_file: Option<PathBuf>,
    /// latency of the sent frames, s
    #[arg(long, value_name = "S", default_value_t = 0.0, allow_negative_numbers = true)]
    pub latency: f64,
    /// share of the sent frames that are lost, 0 to 1
    #[arg(long, value_name = "SHARE", default_value_t = 0.0, allow_negative_numbers = true)]
    pub loss: f64,
    /// end after this time of the vehicle, s
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    pub duration: Option<f64>,
}

/// Names of the autopilots that can be simulated.
pub(super) fn autopilots() -> impl TypedValueParser<Value = Autopilot> {
    let named = STACKS.into_iter().filter(|stack| Firmware::of(stack.autopilot).is_some());
    let names = named.map(|stack| PossibleValue::new(stack.id).help(stack.vehicles));
    PossibleValuesParser::new(names).map(|id| Autopilot::of_id(&id))
}

/// Releases of ArduPilot that differ in their parameters.
fn ardupilot_versions() -> impl TypedValueParser<Value = Firmware> {
    let of = |version: &'static str, units| PossibleValue::new(version).help(units);
    PossibleValuesParser::new([of("4.6", "centimetres and centidegrees"), of("4.7", "metres and degrees")])
        .map(|version| if version == "4.6" { Firmware::ARDUPILOT_4_6 } else { Firmware::ARDUPILOT_4_7 })
}

/// Arguments of `mavid record`.
#[derive(Debug, Clone, Args)]
pub struct RecordArgs {
    #[arg(long, value_name = "ADDRESS", help = ADDRESS)]
    pub connect: String,
    /// telemetry log to write
    #[arg(long, value_name = "FILE.tlog")]
    pub out: PathBuf,
    /// time to record, s; without it until interrupted
    #[arg(long, value_name = "S", value_parser = positive)]
    pub duration: Option<f64>,
    /// replace an existing file
    #[arg(long)]
    pub force: bool,
    /// act as a ground station: send a heartbeat each second, and request the messages that identification uses
    #[arg(long)]
    pub heartbeat: bool,
    /// MAVLink 2 signing key: a file with 32 bytes, 64 hexadecimal digits, or a passphrase
    #[arg(long, value_name = "FILE")]
    pub signing_key_file: Option<PathBuf>,
}

/// Arguments of `mavid replay`.
#[derive(Debug, Clone, Args)]
pub struct ReplayArgs {
    /// telemetry log to play
    pub log: PathBuf,
    #[arg(long, value_name = "ADDRESS", default_value = "udpout:127.0.0.1:14550", help = ADDRESS)]
    pub to: String,
    /// speed, in multiples of the recorded rate; 0 is as fast as possible
    #[arg(long, value_name = "N", default_value_t = 1.0, allow_negative_numbers = true)]
    pub speed: f64,
}

fn parameter(text: &str) -> Result<(String, f64), String> {
    let expected = || format!("expected NAME=VALUE with a number, got `{text}`");
    let (name, value) = text.split_once('=').ok_or_else(expected)?;
    match value.parse::<f64>() {
        Ok(number) if number.is_finite() && !name.is_empty() => Ok((name.to_owned(), number)),
        _ => Err(expected()),
    }
}

fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(number) if number.is_finite() && number > 0.0 => Ok(number),
        _ => Err(format!("expected a number above 0, got `{text}`")),
    }
}
