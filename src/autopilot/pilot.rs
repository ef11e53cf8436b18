//! How a pilot takes over: the mode switch and the switch that stops the motors.

use super::outputs::Numbered;
use std::ops::RangeInclusive;

/// The pilot's switches.
#[derive(Debug, Clone)]
pub struct PilotSwitches {
    /// parameter with the channel of the mode switch; zero where there is none
    pub mode_channel: &'static str,
    /// parameters with the mode of each position, from 1
    pub positions: Numbered,
    /// a parameter and the value of it by which no transmitter is listened to
    pub no_transmitter: Option<(&'static str, i32)>,
    /// a mode that is not known here is shown by its number
    pub shows_unknown: bool,
    /// what stops the motors
    pub kill: KillSwitch,
}

/// What stops the motors.
#[derive(Debug, Clone)]
pub enum KillSwitch {
    /// a parameter with the channel of the switch; zero where there is none
    Channel(&'static str),
    /// one of the options of a channel
    Option {
        /// parameter of each channel
        option: Numbered,
        /// channels that may have one
        channels: RangeInclusive<u8>,
        /// options that stop the motors
        stops: [i32; 2],
    },
}

/// Positions of a mode switch.
pub const POSITIONS: RangeInclusive<usize> = 1..=6;
