//! Logs of which bytes here and there are others than were written: they tell what a sound copy tells, and no more.

use crate::support;

use std::path::Path;

use mavid::inspect::{Inspection, inspect};
use mavid::log::{Input, OpenOptions};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

fn inspected(bytes: &[u8]) -> Inspection {
    let input = Input::Bytes { name: "bytes", bytes };
    inspect(input, &OpenOptions::default(), None, &mut |_| ()).unwrap()
}

/// This share of all bytes behind the first ones is replaced, those of definitions among them.
fn damaged(log: &[u8], share: f64, seed: u64) -> Vec<u8> {
    let mut random = Pcg64::seed_from_u64(seed);
    let mut bytes = log.to_vec();
    for byte in bytes.iter_mut().skip(16) {
        if random.random::<f64>() < share {
            *byte = random.random();
        }
    }
    bytes
}

const SEEDS: std::ops::RangeInclusive<u64> = 1..=8;

#[test]
fn one_byte_in_a_hundred_takes_nothing_from_an_ardupilot_log_and_lengthens_nothing() {
    let Some(shared) = support::shared() else { return };
    for name in ["ap01.bin", "ap05.bin"] {
        let log = std::fs::read(shared.join("onboard/sitl").join(name)).unwrap();
        let sound = inspected(&log).flight;
        let mut told_all = 0;
        for seed in SEEDS {
            let found = inspected(&damaged(&log, 0.01, seed));
            let (told, flight) = (format!("{name} {seed}: {}", found.verdict), found.flight.clone());
            assert!(flight.airborne_s <= sound.airborne_s, "{told} {flight:?}");
            assert!(flight.usable_s <= sound.usable_s, "{told} {flight:?}");
            told_all += usize::from(
                flight.airborne_s > 0.9 * sound.airborne_s && flight.usable_s > 0.5 * sound.usable_s,
            );
            let is_told =
                |loss: &String| loss.contains("samples that leap away from those around them and back");
            assert!(found.losses.iter().any(is_told), "{told}: {:?}", found.losses);
        }
        // a kind of message is lost whose definition has a wrong name or number
        assert!(told_all + 2 >= SEEDS.count(), "{name}: {told_all}");
    }
}

/// Stretches of 200 bytes, 62 % of all.
#[test]
fn a_px4_log_of_which_most_is_gone_flies_no_longer() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/px4_flight.ulg");
    let mut logs = vec![std::fs::read(path).unwrap()];
    logs.extend(support::shared().map(|shared| std::fs::read(shared.join("onboard/sitl/px01.ulg")).unwrap()));
    for log in logs {
        let sound = inspected(&log).flight;
        for seed in 1..=4 {
            let mut random = Pcg64::seed_from_u64(seed);
            let mut bytes = log.clone();
            for piece in bytes[16..].chunks_mut(200) {
                if random.random::<f64>() < 0.62 {
                    piece.iter_mut().for_each(|byte| *byte = random.random());
                }
            }
            let flight = inspected(&bytes).flight;
            assert!(flight.airborne_s <= sound.airborne_s, "{seed}: {flight:?} {sound:?}");
            assert!(flight.usable_s <= sound.usable_s, "{seed}: {flight:?} {sound:?}");
        }
    }
}
