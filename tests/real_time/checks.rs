//! The whole of `mavid fly` over a socket, as far as its checks: the fence is measured from home, wherever that is,
//! and a key opens the vehicle that has it.

use crate::flying;
use std::path::Path;
use std::sync::mpsc;
use std::time::{Duration, UNIX_EPOCH};

use mavid::config::load_vehicle;
use mavid::fly::view::{KeyCommand, ViewModel};
use mavid::fly::{self, Check, Console, Origin, Outcome, Ride};
use mavid::link::{Link, LinkOptions, Signing, SigningKey};
use mavid::sitl::{Firmware, LinkRole, Pace, Settings, Vehicle, serve};
use mavid::vehicle::Limits;
use mavid::wire::{ComponentId, SystemId};
use tokio::sync::mpsc::unbounded_channel;

/// Flies until the checks are over; ends by word of the operator where they let it go on. The vehicle stands 40 m
/// from the origin of its local frame.
async fn checked(name: &str, parameters: &[(&str, f64)], keys: [Option<u8>; 2]) -> Outcome {
    checked_as(name, flying::vehicle_settings(Firmware::PX4), parameters, keys).await
}

async fn checked_as(
    name: &str,
    base: Settings,
    parameters: &[(&str, f64)],
    keys: [Option<u8>; 2],
) -> Outcome {
    let own = parameters.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect();
    let [signing_key, own_key] = keys.map(|key| key.map(|byte| SigningKey::from_bytes([byte; 32])));
    let settings = Settings {
        start_m: [24.0, -32.0],
        parameters: own,
        signing_key,
        boot_unix_us: u64::try_from(UNIX_EPOCH.elapsed().unwrap().as_micros()).unwrap(),
        ..base
    };
    let flown = settings.vehicle.clone();
    checked_by(name, settings, flown, (own_key, Vec::new())).await
}

/// The same by a vehicle file, with refusals that are overruled.
async fn checked_by(
    name: &str,
    settings: Settings,
    file: mavid::vehicle::Vehicle,
    (own_key, accepted): (Option<SigningKey>, Vec<Check>),
) -> Outcome {
    flying::write_events();
    let mut sortie = flying::sortie(&settings);
    let connect_timeout = Duration::from_secs(10);
    let base = sortie.settings;
    sortie.settings =
        fly::Settings { await_clearance: true, origin: Origin::Here, connect_timeout, accepted, ..base };
    let room = Limits { x_max_m: Some(5.0), y_max_m: Some(5.0), ..Limits::default() };
    sortie.limits = Limits { z_min_m: Some(0.7), z_max_m: Some(5.0), ..room };
    let options = LinkOptions {
        system: SystemId(1),
        component: ComponentId(1),
        patient: true,
        ..LinkOptions::default()
    };
    let ends = Link::open(&"udpin:127.0.0.1:0".parse().unwrap(), options).await.unwrap();
    let address = ends.0.local_address().unwrap();
    let vehicle = Vehicle::new(settings).unwrap();
    let links = vec![(LinkRole::Onboard, ends)];
    let vehicle = tokio::spawn(serve(vehicle, links, (Pace::Times(1.0), None), std::future::pending()));

    let dir = Path::new(env!("CARGO_TARGET_TMPDIR")).join("fly_checks").join(name);
    let _ = std::fs::remove_dir_all(&dir);
    std::fs::create_dir_all(&dir).unwrap();
    let address = format!("udpout:{address}").parse().unwrap();
    let parking = fly::Parking::default();
    let signing = own_key.map(Signing::with_key);
    let ride = Ride { sortie, vehicle: file, address, signing, dir, parking };
    let outcome = ends_after_checks(ride).await;
    vehicle.abort();
    outcome
}

async fn ends_after_checks(ride: Ride) -> Outcome {
    let (show, pictures) = mpsc::sync_channel::<ViewModel>(4);
    let (press, keys) = unbounded_channel();
    // a thread that ends with the flight's last picture
    std::thread::spawn(move || {
        for picture in pictures {
            if !["connect", "check", "over"].contains(&picture.state.as_str()) {
                let _ = press.send(KeyCommand::Quit);
            }
        }
    });
    let flight = fly::run(ride, Console { view: show, keys });
    tokio::time::timeout(Duration::from_secs(60), flight).await.unwrap().unwrap().outcome
}

fn why(outcome: &Outcome) -> String {
    outcome.cause.as_ref().unwrap().to_string()
}

pub async fn a_fence_about_home_lets_a_flight_inside_it_go_on_and_refuses_one_that_leaves_it() {
    let (inside, outside, low) = tokio::join!(
        checked("inside", &[("GF_MAX_HOR_DIST", 10.0), ("GF_MAX_VER_DIST", 10.0)], [None, None]),
        checked("outside", &[("GF_MAX_HOR_DIST", 0.3)], [None, None]),
        checked("low", &[("GF_MAX_VER_DIST", 1.0)], [None, None]),
    );
    assert!(why(&inside).contains("the operator"), "{}", why(&inside));
    assert!(why(&outside).contains("the fence's radius about home"), "{}", why(&outside));
    assert!(why(&low).contains("the fence's greatest height"), "{}", why(&low));
}

pub async fn a_vehicle_that_signs_is_flown_with_its_key_alone() {
    let (right, wrong, unsigned) = tokio::join!(
        checked("right", &[], [Some(7), Some(7)]),
        checked("wrong", &[], [Some(7), Some(8)]),
        checked("unsigned", &[], [None, Some(7)]),
    );
    assert!(why(&right).contains("the operator"), "{}", why(&right));
    assert!(why(&wrong).contains("no vehicle"), "{}", why(&wrong));
    assert!(why(&unsigned).contains("no vehicle"), "{}", why(&unsigned));
    for (name, said) in [("wrong", "signs with another key"), ("unsigned", "it does not sign")] {
        let events =
            Path::new(env!("CARGO_TARGET_TMPDIR")).join("fly_checks").join(name).join("events.jsonl");
        let events = std::fs::read_to_string(events).unwrap();
        assert!(events.contains("is not accepted") && events.contains(said), "{events}");
    }
}

pub async fn a_vehicle_that_has_just_booted_is_waited_for() {
    // all else is checked after some 8 s, and its fence needs its home
    let kind = Firmware::ARDUPILOT_4_7;
    let booted = Settings { warm_up: Some(Duration::from_secs(14)), ..flying::vehicle_settings(kind) };
    let fence = [("FENCE_ENABLE", 1.0), ("FENCE_RADIUS", 10.0), ("FENCE_ALT_MAX", 10.0)];
    let outcome = checked_as("booted", booted, &fence, [None, None]).await;
    assert!(why(&outcome).contains("the operator"), "{}", why(&outcome));
}

pub async fn the_file_of_another_vehicle_is_refused_before_it_is_armed() {
    let shipped =
        |name: &str| load_vehicle(&Path::new(env!("CARGO_MANIFEST_DIR")).join("configs").join(name)).unwrap();
    let x500 = || flying::vehicle_settings(Firmware::PX4);
    let mut light = shipped("x500.toml");
    light.body.mass_kg *= 0.2;
    let hovers_on = |share: f64| Settings { parameters: vec![("MOT_THST_HOVER".into(), share)], ..copter() };
    let (small, overruled, light, own, heavy) = tokio::join!(
        checked_by("small", x500(), shipped("crazyflie.toml"), (None, Vec::new())),
        checked_by("overruled", x500(), shipped("crazyflie.toml"), (None, vec![Check::Rotors])),
        checked_by("light", x500(), light, (None, Vec::new())),
        checked_by("own", copter(), shipped("x500.toml"), (None, Vec::new())),
        checked_by("heavy", hovers_on(0.13), shipped("x500.toml"), (None, Vec::new())),
    );
    let small = why(&small);
    assert!(small.contains("rotors: expected 0.046 m from the middle") && small.contains("0.24"), "{small}");
    assert!(why(&overruled).contains("the operator"), "{}", why(&overruled));
    let light = why(&light);
    assert!(light.contains("hover thrust: expected the vehicle file's weight, 4.050 N"), "{light}");
    assert!(light.contains("MPC_THR_HOVER"), "{light}");
    assert!(why(&own).contains("the operator"), "{}", why(&own));
    assert!(why(&heavy).contains("MOT_THST_HOVER = 0.130"), "{}", why(&heavy));
}

fn copter() -> Settings {
    flying::vehicle_settings(Firmware::ARDUPILOT_4_7)
}
