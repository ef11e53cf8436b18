//! How high above the sea a flight was, by its recording.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::Read;
use std::path::Path;

use mavid::log::TlogReader;
use mavid::wire::SystemId;
use mavid::wire::message_id::HOME_POSITION;

use crate::commands::export::ALTITUDES_M;

/// Where the altitude stands in a HOME_POSITION, mm above the sea.
const ALTITUDE_AT: usize = 8;

/// Height of the vehicle's home above the sea, m, by the last HOME_POSITION of a recorded link; `None` where it has none, where
/// several vehicles sent one and `system` says not which is meant, or where no vehicle flies so high.
pub fn home_m(recording: &Path, system: Option<SystemId>) -> Option<f64> {
    last_home_m(TlogReader::new(File::open(recording).ok()?), system)
}

fn last_home_m(mut reader: TlogReader<impl Read>, system: Option<SystemId>) -> Option<f64> {
    let mut homes_m: BTreeMap<SystemId, f64> = BTreeMap::new();
    // what was read before a damage counts
    while let Ok(Some(record)) = reader.next_record() {
        let header = record.frame.header();
        let is_meant = system.is_none_or(|system| system == header.system);
        if record.known && is_meant && header.message_id == HOME_POSITION {
            homes_m.insert(header.system, 1e-3 * f64::from(record.frame.payload().i32(ALTITUDE_AT)));
        }
    }
    let mut homes_m = homes_m.into_values();
    match (homes_m.next(), homes_m.next()) {
        (Some(home_m), None) => Some(home_m).filter(|home_m| ALTITUDES_M.contains(home_m)),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mavid::wire::MessageWriter;
    use mavlink::dialects::ardupilotmega::{HOME_POSITION_DATA, MavMessage};

    fn recorded(altitudes_mm: &[i32]) -> Vec<u8> {
        let mut writer = MessageWriter::new(Vec::new());
        for (second, altitude) in (0..).zip(altitudes_mm) {
            let home = HOME_POSITION_DATA { altitude: *altitude, ..HOME_POSITION_DATA::default() };
            writer
                .write(1_700_000_000_000_000 + 1_000_000 * second, &MavMessage::HOME_POSITION(home))
                .unwrap();
        }
        writer.finish().unwrap()
    }

    #[test]
    fn the_last_home_of_the_vehicle_tells_the_height() {
        let of =
            |altitudes_mm: &[i32], system| last_home_m(TlogReader::new(&recorded(altitudes_mm)[..]), system);
        assert_eq!(of(&[0, 584_070], None), Some(584.07));
        assert_eq!(of(&[0, 584_070], Some(SystemId(1))), Some(584.07));
        assert_eq!(of(&[584_070], Some(SystemId(7))), None, "of another vehicle");
        assert_eq!(of(&[20_000_000], None), None, "no multirotor flies so high");
        assert_eq!(of(&[], None), None);
    }
}
