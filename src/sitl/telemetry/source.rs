//! The source of the messages: noise, stamps, and what stays the same over a flight.

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use crate::simulate::{NoiseLevels, StreamSkew};
use crate::sitl::{Firmware, Origin, Settings};
use crate::wire::EMBEDDED_UID2;

/// Keeps the telemetry's noise apart from the autopilot's.
const TELEMETRY_SEED: u64 = 0x7465_6c65_6d65_7472;

/// Makes messages.
#[derive(Debug)]
pub(in crate::sitl) struct Telemetry {
    pub(super) kind: Firmware,
    pub(super) noise: NoiseLevels,
    pub(super) skew: StreamSkew,
    pub(super) rng: Pcg64Mcg,
    pub(super) origin: Origin,
    pub(super) rotor_count: usize,
    pub(super) esc_telemetry: bool,
    pub(super) uid2: [u8; EMBEDDED_UID2.len()],
    pub(super) boot_unix_us: u64,
    pub(super) pings: u32,
}

impl Telemetry {
    pub(in crate::sitl) fn new(settings: &Settings) -> Self {
        Self {
            kind: settings.autopilot,
            noise: settings.sensors.noise.scaled(settings.sensors.noise_scale),
            skew: settings.sensors.skew,
            rng: Pcg64Mcg::seed_from_u64(settings.seed ^ TELEMETRY_SEED),
            origin: settings.origin,
            rotor_count: settings.vehicle.rotors.len(),
            esc_telemetry: settings.esc_telemetry,
            uid2: settings.nonce.map_or(EMBEDDED_UID2, |nonce| nonce.uid2()),
            boot_unix_us: settings.boot_unix_us,
            pings: 0,
        }
    }

    /// A number in 0..1 that decides whether a frame gets lost.
    pub(in crate::sitl) fn chance(&mut self) -> f64 {
        self.rng.random()
    }
}
