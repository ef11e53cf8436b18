//! `mavid sitl`: the embedded simulated vehicle on its own, for any ground station.

use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use mavid::config::{LoadedVehicle, parse_vehicle};
use mavid::fly::parameters::Parameters;
use mavid::link::{Address, LinkOptions, LinkReader, SigningKey};
use mavid::sitl::{Firmware, LinkRole, Pace, SensorSettings, Served, Settings, Vehicle, serve};
use mavid::study::with_further;
use mavid::text;
use mavid::wire::{ComponentId, SystemId};
use serde::Serialize;

use super::{CommandError, Outcome, live, network, output};
use crate::cli::SitlArgs;

/// The vehicle that flies where none is given.
pub const DEFAULT_VEHICLE: &str = include_str!("../../configs/x500.toml");
/// What messages call it.
pub const EMBEDDED: &str = "the vehicle within the program";
/// So far behind the pace a ground station takes the vehicle for one whose link is bad.
const BEHIND: Duration = Duration::from_millis(500);
/// The port on which PX4 takes its peer for a companion computer.
const ONBOARD_PORT: u16 = 14540;

/// What runs. Says nothing of what is concealed.
#[derive(Debug, Serialize)]
struct Document {
    schema: u32,
    vehicle: String,
    autopilot: &'static str,
    /// the same in sentences
    #[serde(skip)]
    pilot: &'static str,
    system: u8,
    listen: Vec<String>,
    /// speed, in multiples of real time; none in lock-step
    speed: Option<f64>,
}

/// Runs the verb.
pub fn run(json: bool, args: &SitlArgs) -> Result<Outcome, CommandError> {
    let args = args.clone();
    live::run(move |work| {
        work.ends_itself();
        simulate(json, &args)
    })
}

fn simulate(json: bool, args: &SitlArgs) -> Result<Outcome, CommandError> {
    let settings = settings(args)?;
    let addresses = addresses(args, settings.autopilot)?;
    let pace = pace(args)?;
    let document = Document {
        schema: 1,
        vehicle: settings.vehicle.name.clone(),
        autopilot: settings.autopilot.stack().id,
        pilot: settings.autopilot.stack().name,
        system: settings.system,
        listen: Vec::new(),
        speed: if let Pace::Times(speed) = pace { Some(speed) } else { None },
    };
    let limit = args.duration.map(|seconds| seconds_from("duration", seconds)).transpose()?;
    let vehicle = Vehicle::new(settings).map_err(|error| CommandError::Input(error.to_string()))?;
    network::block_on(fly(vehicle, &addresses, (pace, limit), json, document))?;
    Ok(Outcome::Done)
}

async fn fly(
    vehicle: Vehicle,
    addresses: &[Address],
    time: (Pace, Option<Duration>),
    json: bool,
    mut document: Document,
) -> Result<(), CommandError> {
    let mut links = Vec::with_capacity(addresses.len());
    for address in addresses {
        let options = LinkOptions {
            system: SystemId(document.system.into()),
            component: ComponentId(1),
            patient: true,
            ..LinkOptions::default()
        };
        let ends = network::open(address, options).await?;
        document.listen.push(bound(address, &ends.0).to_string());
        links.push((role(address), ends));
    }
    if json {
        output::json(&document)?;
    } else {
        output::text(&page(&document))?;
    }
    let stop = async {
        // where the signal cannot be had, the program is ended by the system
        if network::interrupted().await.is_err() {
            std::future::pending::<()>().await;
        }
    };
    let Served { flown, behind } = serve(vehicle, links, time, stop).await;
    if behind > BEHIND {
        let behind_s = behind.as_secs_f64();
        output::warning(&format!(
            "this machine was up to {behind_s:.1} s of the vehicle's time behind: expected a free core, a lower \
             --speed, or --lockstep"
        ));
    }
    output::message(&format!("stopped after {:.1} s of the vehicle's time", flown.as_secs_f64()));
    Ok(())
}

fn page(document: &Document) -> String {
    let pace =
        document.speed.map_or("in lock-step".to_owned(), |speed| format!("at {speed} times real time"));
    let links: Vec<String> = document.listen.iter().map(|address| format!("\n  {address}")).collect();
    format!(
        "{} flown by {}, system {}, {pace}, on{}\nCtrl-C ends it.",
        document.vehicle,
        document.pilot,
        document.system,
        links.concat()
    )
}

fn firmware(args: &SitlArgs) -> Result<Firmware, CommandError> {
    let latest = Firmware::of(args.autopilot).ok_or_else(|| {
        CommandError::Input(format!("--autopilot: {} is not simulated", args.autopilot.id()))
    })?;
    match args.ardupilot_version {
        None => Ok(latest),
        Some(version) if version.autopilot() == args.autopilot => Ok(version),
        Some(_) => {
            let got = latest.stack().name;
            let what = format!("--ardupilot-version: expected --autopilot ardupilot beside it, got {got}");
            Err(CommandError::Input(what))
        }
    }
}

/// The simulated vehicle of these arguments.
pub fn settings(args: &SitlArgs) -> Result<Settings, CommandError> {
    let kind = firmware(args)?;
    let (LoadedVehicle { vehicle, warnings, model }, origin) = loaded(args)?;
    output::warnings(&origin, &warnings);
    let acting = with_further(&model.effects, &origin, args.effects.as_deref(), &vehicle)?;
    let key = args.signing_key_file.as_deref().map(SigningKey::read).transpose();
    let signing_key = key.map_err(|error| CommandError::Input(error.to_string()))?;
    if let Some(warning) = args.signing_key_file.as_deref().and_then(SigningKey::exposure) {
        output::warning(&warning);
    }
    let base = Settings::new(vehicle, kind);
    let sensors = SensorSettings { noise_scale: args.noise, ..base.sensors };
    Ok(Settings {
        effects: acting,
        seed: args.seed,
        system: args.system,
        sensors,
        esc_telemetry: args.esc_telemetry,
        transmitter: args.transmitter,
        latency: seconds_from("latency", args.latency)?,
        loss: args.loss,
        warm_up: args.warm_up.map(|seconds| seconds_from("warm-up", seconds)).transpose()?,
        signing_key,
        boot_unix_us: unix_us(),
        taken_over: args.parameters.as_deref().map_or_else(|| Ok(Vec::new()), taken_over)?,
        parameters: args.param.clone(),
        ..base
    })
}

/// Beginnings of the names of parameters of the battery: the simulated vehicle has its own.
const BATTERY: &str = "BAT";

/// What the simulated vehicle takes over of a file of parameters.
fn taken_over(path: &Path) -> Result<Vec<(String, f64)>, CommandError> {
    let name = text::path(path);
    let text = std::fs::read_to_string(path)
        .map_err(|error| CommandError::Input(format!("cannot read {name}: {error}")))?;
    let all = Parameters::from_toml(&text, &name).map_err(|error| CommandError::Input(error.to_string()))?;
    Ok(all.values.into_iter().filter(|(name, _)| !name.starts_with(BATTERY)).collect())
}

/// Of the host.
fn unix_us() -> u64 {
    let since = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    u64::try_from(since.as_micros()).unwrap_or(u64::MAX)
}

/// The vehicle, and what messages call it.
fn loaded(args: &SitlArgs) -> Result<(LoadedVehicle, PathBuf), CommandError> {
    if args.vehicle.is_some() || args.draft.mass.is_some() {
        return Ok(args.draft.given(args.vehicle.as_ref()).alone()?);
    }
    Ok((parse_vehicle(DEFAULT_VEHICLE, EMBEDDED)?, PathBuf::from(EMBEDDED)))
}

fn seconds_from(name: &str, value: f64) -> Result<Duration, CommandError> {
    Duration::try_from_secs_f64(value).map_err(|_| {
        CommandError::Input(format!("--{name}: expected seconds, zero or above and finite, got {value}"))
    })
}

fn pace(args: &SitlArgs) -> Result<Pace, CommandError> {
    if args.lockstep {
        return Ok(Pace::Lockstep);
    }
    if !(args.speed > 0.0 && args.speed <= 1000.0) {
        let what = format!("--speed: expected above 0 and at most 1000, got {}", args.speed);
        return Err(CommandError::Input(what));
    }
    Ok(Pace::Times(args.speed))
}

/// Those given, or those of the autopilot's own simulator.
fn addresses(args: &SitlArgs, kind: Firmware) -> Result<Vec<Address>, CommandError> {
    let own: &[&str] = if kind.is_px4() {
        &["udpout:127.0.0.1:14550", "udpout:127.0.0.1:14540"]
    } else {
        &["tcpin:127.0.0.1:5760"]
    };
    let texts: Vec<&str> =
        if args.listen.is_empty() { own.to_vec() } else { args.listen.iter().map(String::as_str).collect() };
    texts.iter().map(|text| network::address("--listen", text)).collect()
}

/// With the port that the system chose, where the address left it open.
fn bound(address: &Address, reader: &LinkReader) -> Address {
    let chosen = reader.local_address().map(|local| local.port());
    match (address.clone(), chosen) {
        (Address::UdpIn { host, port: 0 }, Some(port)) => Address::UdpIn { host, port },
        (Address::TcpIn { host, port: 0 }, Some(port)) => Address::TcpIn { host, port },
        (given, _) => given,
    }
}

fn role(address: &Address) -> LinkRole {
    match address {
        Address::UdpIn { port, .. } | Address::UdpOut { port, .. } if *port == ONBOARD_PORT => {
            LinkRole::Onboard
        }
        _ => LinkRole::GroundStation,
    }
}
