//! What is to be flown, by which vehicle, and within which bounds.

use std::time::Duration;

use super::course::Course;
use super::preflight::{HOVER, ROTORS};
use super::safety::FirstQuestion;
use crate::autopilot::LogAwaited;
use crate::vehicle::Limits;
use crate::wire::{ComponentId, Nonce, SystemId};

/// Setpoints a second. An autopilot takes each as a step, and its motors answer each with a jolt. Logs are sampled at 50,
/// 100 or 250 Hz: jolts at a rate that divides these fall at one and the same phase of the samples for a whole flight, and
/// the motors' mean is logged wrong by as much as the setpoints change. At 50 Hz and a log of 100 Hz the inertia about z
/// came out up to 4 % wrong, and damping was named that is not there. At 43 Hz what is left lies above 7 Hz.
pub const SETPOINT_HZ: u32 = 43;

/// One flight, as ordered.
#[derive(Debug, Clone)]
pub struct Sortie {
    /// what is flown
    pub course: Course,
    /// what the vehicle must keep
    pub limits: Limits,
    /// m/s^2
    pub gravity_m_s2: f64,
    /// the vehicle by its system id; without it the only one on the link
    pub system: Option<SystemId>,
    /// the order to arm whatever answers on the link
    pub may_arm: bool,
    /// what this program gave to the simulated vehicle that it started itself: that one is armed without the order
    pub own_vehicle: Option<Nonce>,
    /// how
    pub settings: Settings,
}

/// Where the plan's horizontal origin lies. Its heights always count from the ground where the vehicle
/// stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Origin {
    /// at the origin of the vehicle's local position
    #[default]
    Local,
    /// so that the vehicle stands below the plan's takeoff place
    Here,
}

/// A check whose refusal the operator may overrule.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Check {
    /// that the file's thrust carries its weight by the command on which the vehicle hovers
    HoverThrust,
    /// that the file's rotors are those of the autopilot
    Rotors,
}

impl Check {
    /// As the findings' subject.
    #[must_use]
    pub fn subject(self) -> &'static str {
        match self {
            Self::HoverThrust => HOVER,
            Self::Rotors => ROTORS,
        }
    }
}

/// How a flight is conducted. The times and distances are those of `fly`'s safety rules.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// our own ids
    pub station: (SystemId, ComponentId),
    /// between setpoints
    pub setpoint_period: Duration,
    /// where the plan lies
    pub origin: Origin,
    /// distance to the reference that is allowed, m
    pub tracking_max_m: f64,
    /// around the vehicle's room, m
    pub room_margin_m: f64,
    /// from upright, rad; without it 20 degrees more than planned
    pub tilt_max_rad: Option<f64>,
    /// s of hover that a full battery gives, where it is known
    pub hover_time_s: Option<f64>,
    /// until a vehicle is heard
    pub connect_timeout: Duration,
    /// until the vehicle is ready to arm
    pub ready_timeout: Duration,
    /// for a takeoff, and for the start to be reached
    pub reach_timeout: Duration,
    /// in a hold that nobody ends, before it lands
    pub hold_then_land: Duration,
    /// how near to the start the vehicle must be before the trajectory begins, m; without it 0.3 m, or what the vehicle can
    /// do in hover
    pub gate_m: Option<f64>,
    /// how slow, m/s; without it 0.2 m/s, or what the vehicle can do in hover
    pub gate_m_s: Option<f64>,
    /// how long a vehicle that others fly is watched while it is heard and armed
    pub watch_max: Duration,
    /// a vehicle that is not heard for so long is gone
    pub gone_after: Duration,
    /// somebody else checks parameters and message rates and says so by [`Event::Cleared`](super::Event)
    pub await_clearance: bool,
    /// the operator's word is waited for before the vehicle is armed ([`Key::Arm`](super::Key))
    pub await_word: bool,
    /// the vehicle is the simulated twin of the operator's, and so it is said wherever the operator looks
    pub is_twin: bool,
    /// a refusal by one of these is a warning
    pub accepted: Vec<Check>,
    /// parameters of the vehicle's logging that were set and wait for its next start
    pub log_awaited: Vec<LogAwaited>,
    /// from which the questions after the vehicle's mode are counted; drawn again for each run, so that answers to others
    /// are not taken for answers to us
    pub first_question: FirstQuestion,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            station: (SystemId(255), ComponentId(190)),
            setpoint_period: Duration::from_secs(1) / SETPOINT_HZ,
            origin: Origin::Local,
            tracking_max_m: 1.0,
            room_margin_m: 1.0,
            tilt_max_rad: None,
            hover_time_s: None,
            connect_timeout: Duration::from_secs(30),
            ready_timeout: Duration::from_secs(120),
            reach_timeout: Duration::from_secs(30),
            hold_then_land: Duration::from_secs(10),
            gate_m: None,
            gate_m_s: None,
            watch_max: Duration::from_secs(3600),
            gone_after: Duration::from_secs(120),
            await_clearance: false,
            await_word: false,
            is_twin: false,
            accepted: Vec::new(),
            log_awaited: Vec::new(),
            first_question: FirstQuestion::random(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Above every frequency that is excited on purpose, Hz.
    const EXCITED_HZ: u32 = 2;

    #[test]
    fn no_harmonic_of_the_setpoints_is_seen_as_motion_in_a_log() {
        for log_hz in [25, 50, 100, 125, 200, 250, 400] {
            for harmonic in 1..=4 {
                let beyond_hz = (harmonic * SETPOINT_HZ) % log_hz;
                let seen_hz = beyond_hz.min(log_hz - beyond_hz);
                assert!(seen_hz > EXCITED_HZ, "harmonic {harmonic} is {seen_hz} Hz in a log of {log_hz} Hz");
            }
        }
        assert_eq!(Settings::default().setpoint_period, Duration::from_secs(1) / SETPOINT_HZ);
    }
}
