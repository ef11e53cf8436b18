//! What is logged when: by the parameters that govern it.

use std::time::Duration;

use crate::sitl::parameters::Parameters;

/// Bits of SDLOG_PROFILE: all that is logged by default; what an identification needs.
const PX4_DEFAULT: u32 = 0;
const PX4_IDENTIFICATION: u32 = 3;
/// The first bit of SDLOG_BACKEND and of LOG_BACKEND_TYPE: a file.
const FILE: u32 = 0;
/// Bits of LOG_BITMASK.
mod bit {
    pub(super) const ATTITUDE_FAST: u32 = 0;
    pub(super) const ATTITUDE_MEDIUM: u32 = 1;
    pub(super) const GPS: u32 = 2;
    pub(super) const GUIDED: u32 = 5;
    pub(super) const IMU: u32 = 7;
    pub(super) const CURRENT: u32 = 9;
    pub(super) const OUTPUTS: u32 = 10;
    pub(super) const IMU_FAST: u32 = 18;
}

/// How often a message is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Every {
    Never,
    /// each period of the main loop
    Loop,
    Ms(u32),
}

impl Every {
    /// Whether a period of the main loop that ends at `now` is one of them, `period` being its length.
    pub(super) fn is_due(self, now: Duration, period: Duration) -> bool {
        match self {
            Self::Never => false,
            Self::Loop => true,
            Self::Ms(ms) => {
                let (every, now) = (u128::from(ms) * 1000, now.as_micros());
                now / every != now.saturating_sub(period.as_micros()) / every
            }
        }
    }

    fn at_most(self, most_hz: f64) -> Self {
        if most_hz <= 0.0 || self == Self::Never {
            return self;
        }
        let least_ms = crate::units::whole_unsigned((1e3 / most_hz).ceil());
        match self {
            Self::Ms(ms) => Self::Ms(ms.max(least_ms)),
            // the loop's own period is shorter than any limit that is worth it
            _ => Self::Ms(least_ms.max(1)),
        }
    }
}

/// When a log is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum When {
    Never,
    /// from arming until disarming
    Armed,
    /// from boot until disarming, then as armed
    BootUntilDisarmed,
    /// from the first arming on
    FirstArmed,
    Always,
}

/// What is logged, by the parameters as they are when a log begins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Schedule {
    pub(super) when: When,
    profile: u32,
    most_hz: f64,
}

fn bits(value: f64) -> u32 {
    crate::units::whole_unsigned(value)
}

fn has(mask: u32, bit: u32) -> bool {
    mask >> bit & 1 == 1
}

impl Schedule {
    pub(super) fn px4(parameters: &Parameters) -> Self {
        let to_file = has(bits(parameters.value("SDLOG_BACKEND")), FILE);
        let when = match crate::units::whole(parameters.value("SDLOG_MODE")) {
            _ if !to_file => When::Never,
            0 => When::Armed,
            1 => When::BootUntilDisarmed,
            2 => When::Always,
            4 => When::FirstArmed,
            _ => When::Never,
        };
        Self { when, profile: bits(parameters.value("SDLOG_PROFILE")), most_hz: 0.0 }
    }

    pub(super) fn ardupilot(parameters: &Parameters) -> Self {
        let to_file = has(bits(parameters.value("LOG_BACKEND_TYPE")), FILE);
        let when = match parameters.value("LOG_DISARMED") {
            _ if !to_file => When::Never,
            disarmed if disarmed >= 1.0 => When::Always,
            _ => When::Armed,
        };
        let most_hz = parameters.value("LOG_FILE_RATEMAX");
        Self { when, profile: bits(parameters.value("LOG_BITMASK")), most_hz }
    }

    /// PX4's rate of a topic: by default, and for an identification.
    pub(super) fn topic(&self, default: Every, identification: Every) -> Every {
        if has(self.profile, PX4_IDENTIFICATION) && identification != Every::Never {
            return identification;
        }
        if has(self.profile, PX4_DEFAULT) { default } else { Every::Never }
    }

    /// ArduPilot's rates.
    pub(super) fn rates(&self) -> Rates {
        let on = |bit: u32, every: Every| if has(self.profile, bit) { every } else { Every::Never };
        let or = |first: Every, second: Every| if first == Every::Never { second } else { first };
        let attitude = or(on(bit::ATTITUDE_FAST, Every::Loop), on(bit::ATTITUDE_MEDIUM, Every::Ms(100)));
        let imu = or(on(bit::IMU_FAST, Every::Loop), on(bit::IMU, Every::Ms(40)));
        let limited = |every: Every| every.at_most(self.most_hz);
        Rates {
            attitude: limited(attitude),
            imu: limited(imu),
            outputs: limited(on(bit::OUTPUTS, Every::Ms(100))),
            estimate: limited(Every::Ms(100)),
            satellites: limited(on(bit::GPS, Every::Ms(200))),
            targets: limited(on(bit::GUIDED, Every::Ms(100))),
            battery: limited(on(bit::CURRENT, Every::Ms(100))),
            speeds: limited(Every::Ms(100)),
        }
    }
}

/// How often ArduPilot writes each group of messages.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Rates {
    pub(super) attitude: Every,
    pub(super) imu: Every,
    pub(super) outputs: Every,
    pub(super) estimate: Every,
    pub(super) satellites: Every,
    pub(super) targets: Every,
    pub(super) battery: Every,
    pub(super) speeds: Every,
}
