//! What a simulated vehicle is made of.

use std::time::Duration;

use super::{Firmware, SitlError};
use crate::fence::FenceItem;
use crate::frames::Geodetic;
use crate::link::SigningKey;
use crate::physics::ActiveEffect;
use crate::simulate::{FlightSettings, NoiseLevels, StreamSkew};
use crate::vehicle::Vehicle as Description;
use crate::wire::Nonce;

/// Where on Earth the origin of the local frame lies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Origin {
    /// degrees north
    pub latitude_deg: f64,
    /// degrees east
    pub longitude_deg: f64,
    /// above mean sea level
    pub altitude_m: f64,
}

impl Origin {
    pub(super) fn place(&self) -> Geodetic {
        Geodetic { latitude_deg: self.latitude_deg, longitude_deg: self.longitude_deg }
    }
}

/// How well the vehicle knows its own motion, and what of it the telemetry shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SensorSettings {
    /// of the estimates that the autopilot flies on
    pub control_noise: NoiseLevels,
    /// of the telemetry
    pub noise: NoiseLevels,
    /// factor on both (-)
    pub noise_scale: f64,
    /// how much later than its sample each stream is stamped
    pub skew: StreamSkew,
}

impl Default for SensorSettings {
    fn default() -> Self {
        let base = FlightSettings::default();
        Self {
            control_noise: base.control_noise,
            noise: base.telemetry.noise,
            noise_scale: base.telemetry.noise_scale,
            skew: base.telemetry.skew,
        }
    }
}

/// Everything that a simulated vehicle is.
#[derive(Debug, Clone)]
pub struct Settings {
    /// what flies
    pub vehicle: Description,
    /// what the autopilot believes it flies; without it what flies
    pub nominal: Option<Description>,
    /// what acts beyond rigid body and motors; nobody who connects is told
    pub effects: Vec<ActiveEffect>,
    /// first-order lag of the rotors, s; 0 lets them follow at once
    pub motor_time_constant_s: f64,
    /// the autopilot that is simulated
    pub autopilot: Firmware,
    /// seed of the noise; the same seed gives the same flight
    pub seed: u64,
    /// MAVLink system id
    pub system: u8,
    /// place at the start, local frame, m north and m west
    pub start_m: [f64; 2],
    /// heading at the start about up, rad
    pub start_yaw_rad: f64,
    /// origin of the local frame
    pub origin: Origin,
    /// time from boot until the position estimate is good; without it the autopilot's own
    pub warm_up: Option<Duration>,
    /// noise
    pub sensors: SensorSettings,
    /// time from a frame's making to its arrival
    pub latency: Duration,
    /// share of the sent frames that are lost, 0 to 1 (-)
    pub loss: f64,
    /// send measured rotor speeds
    pub esc_telemetry: bool,
    /// simulate a pilot's transmitter that is on, with centred sticks
    pub transmitter: bool,
    /// V at the start
    pub battery_v: f64,
    /// V/s by which the battery falls while armed
    pub battery_drop_v_s: f64,
    /// what a ground station has stored as fence
    pub fence: Vec<FenceItem>,
    /// signs what it sends, and believes only what is signed with it (ArduPilot believes everything on its first link)
    pub signing_key: Option<SigningKey>,
    /// what the program that starts it knows it by
    pub nonce: Option<Nonce>,
    /// parameters of another vehicle, which take the place of the autopilot's defaults as far as this one has them
    pub taken_over: Vec<(String, f64)>,
    /// values instead of the autopilot's defaults
    pub parameters: Vec<(String, f64)>,
    /// host's time at boot, microseconds since 1970 UTC
    pub boot_unix_us: u64,
}

impl Settings {
    /// A vehicle with nothing concealed, at the origin, heading north.
    #[must_use]
    pub fn new(vehicle: Description, autopilot: Firmware) -> Self {
        let base = FlightSettings::default();
        let motor_time_constant_s = vehicle.propulsion.time_constant_s.unwrap_or(base.motor_time_constant_s);
        Self {
            vehicle,
            nominal: None,
            effects: Vec::new(),
            motor_time_constant_s,
            autopilot,
            seed: base.seed,
            system: 1,
            start_m: [0.0; 2],
            start_yaw_rad: 0.0,
            origin: Origin { latitude_deg: 47.397_742, longitude_deg: 8.545_594, altitude_m: 488.0 },
            warm_up: None,
            sensors: SensorSettings::default(),
            latency: Duration::ZERO,
            loss: 0.0,
            esc_telemetry: false,
            transmitter: false,
            battery_v: base.battery_v,
            battery_drop_v_s: base.battery_drop_v_s,
            fence: Vec::new(),
            signing_key: None,
            nonce: None,
            taken_over: Vec::new(),
            parameters: Vec::new(),
            boot_unix_us: 1_700_000_000_000_000,
        }
    }

    /// Time from boot until the position estimate is good. ArduPilot's is what its own simulator takes.
    pub(super) fn warm_up(&self) -> Duration {
        let own = if self.autopilot.is_px4() { Duration::from_secs(8) } else { Duration::from_secs(41) };
        self.warm_up.unwrap_or(own)
    }

    /// What the autopilot believes it flies.
    pub(super) fn believed(&self) -> &Description {
        self.nominal.as_ref().unwrap_or(&self.vehicle)
    }

    /// # Errors
    /// If a number is out of its range.
    pub(super) fn check(&self) -> Result<(), SitlError> {
        let refuse = |name: &str, expected, got: f64| {
            Err(SitlError::Setting { name: name.to_owned(), expected, got: got.to_string() })
        };
        let at_least_zero = [
            ("motor_time_constant_s", self.motor_time_constant_s),
            ("noise", self.sensors.noise_scale),
            ("battery_drop_v_s", self.battery_drop_v_s),
        ];
        for (name, value) in at_least_zero {
            if !(value >= 0.0 && value.is_finite()) {
                return refuse(name, "zero or above and finite", value);
            }
        }
        if !(self.battery_v > 0.0 && self.battery_v.is_finite()) {
            return refuse("battery_v", "positive and finite", self.battery_v);
        }
        if !(0.0..1.0).contains(&self.loss) {
            return refuse("loss", "in [0, 1)", self.loss);
        }
        let place = [self.start_m[0], self.start_m[1], self.start_yaw_rad];
        if let Some(wrong) = place.iter().find(|value| !value.is_finite()) {
            return refuse("start", "finite", *wrong);
        }
        let Origin { latitude_deg, longitude_deg, altitude_m } = self.origin;
        if !(latitude_deg.abs() <= 85.0 && longitude_deg.abs() <= 180.0 && altitude_m.abs() < 9000.0) {
            return refuse("origin", "within 85 degrees of latitude and 180 of longitude", latitude_deg);
        }
        if self.system == 0 {
            return refuse("system", "1 to 255", 0.0);
        }
        Ok(())
    }
}
