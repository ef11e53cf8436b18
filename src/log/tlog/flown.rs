//! Which of a log's systems flew.

use crate::recording::landed::{MOVES, ON_GROUND};
use crate::wire::heartbeat::{ARMED, BASE_MODE_AT};
use std::collections::BTreeMap;

use super::reader::TlogReader;
use crate::log::error::LogError;
use crate::log::input::Input;
use crate::wire::{Record, Source, SystemId, Vehicle};

/// So many samples of it are no damage and no knock.
const LEAST_MOVING: u64 = 20;

/// What a system did, by its own messages.
#[derive(Debug, Clone, Copy, Default)]
struct Deeds {
    /// it says that it is of a kind that stays on the ground or in the water
    stays_down: bool,
    armed: bool,
    landed_state_told: bool,
    in_air_armed: bool,
    motion: u64,
    moving_armed: u64,
}

impl Deeds {
    fn flew(&self) -> bool {
        if self.stays_down {
            return false;
        }
        if self.landed_state_told { self.in_air_armed } else { self.moving_armed >= LEAST_MOVING }
    }

    fn note(&mut self, record: &Record<'_>) {
        let payload = record.frame.payload();
        let length = |[x, y, z]: [f64; 3]| (x * x + y * y + z * z).sqrt();
        let moving = match Source::from_message_id(record.frame.header().message_id) {
            Some(Source::Heartbeat) => {
                if let Some(vehicle) = Vehicle::from_heartbeat(record) {
                    self.stays_down = vehicle.kind.is_some_and(|kind| !kind.flies());
                    self.armed = payload.u8(BASE_MODE_AT) & ARMED != 0;
                }
                return;
            }
            Some(Source::ExtendedSysState) => {
                let state = payload.u8(1);
                self.landed_state_told |= state != 0;
                self.in_air_armed |= self.armed && f64::from(state) > ON_GROUND;
                return;
            }
            Some(Source::Attitude | Source::LocalPositionNed) => length(payload.f32s(16)),
            Some(Source::AttitudeQuaternion) => length(payload.f32s(20)),
            _ => return,
        };
        self.motion += 1;
        self.moving_armed += u64::from(self.armed && moving > MOVES);
    }
}

/// The system of a telemetry log that flew: it was armed and in the air or, where it does not tell that, in motion.
/// Where none flew, the only one that sends motion, or the only one there is; of those a rover or a submarine only where there
/// is nothing else.
///
/// # Errors
/// The log cannot be read, or more than one system flew, or none did and more than one sends motion.
pub(super) fn who_flew(input: &Input<'_>) -> Result<SystemId, LogError> {
    let mut reader = TlogReader::new(input.open()?);
    let mut deeds: BTreeMap<SystemId, Deeds> = BTreeMap::new();
    let mut vehicles = Vec::new();
    while let Some(record) = reader.next_record()? {
        if !record.known {
            continue;
        }
        let system = record.frame.header().system;
        if Vehicle::from_heartbeat(&record).is_some() && !vehicles.contains(&system) {
            vehicles.push(system);
        }
        deeds.entry(system).or_default().note(&record);
    }
    chosen(&vehicles, |system| deeds.get(system).copied().unwrap_or_default())
}

fn chosen(vehicles: &[SystemId], deeds: impl Fn(&SystemId) -> Deeds) -> Result<SystemId, LogError> {
    let those = |did: fn(&Deeds) -> bool| -> Vec<SystemId> {
        vehicles.iter().copied().filter(|system| did(&deeds(system))).collect::<Vec<_>>()
    };
    let flew = those(Deeds::flew);
    let kinds: [fn(&Deeds) -> bool; 3] =
        [Deeds::flew, |deeds| deeds.motion > 0 && !deeds.stays_down, |deeds| deeds.motion > 0];
    let candidates = kinds.into_iter().map(those).find(|systems| !systems.is_empty()).unwrap_or_default();
    match (candidates.as_slice(), vehicles) {
        ([only], _) | ([], [only, ..]) => Ok(*only),
        (_, []) => Err(LogError::NoVehicle { systems: Vec::new() }),
        (_, [first, ..]) => {
            let mut systems = candidates;
            systems.sort_unstable();
            Err(LogError::SeveralVehicles { flew: !flew.is_empty(), systems, first: *first })
        }
    }
}
