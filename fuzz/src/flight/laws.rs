//! What must hold of all that a ground station sends.

use std::time::Duration;

use mavid::autopilot::Autopilot;
use mavid::fly::Setpoint;
use mavid::wire::Frame;
use mavlink::dialects::ardupilotmega::MavMessage;

use super::vehicle::{ARM, SET_MODE, TAKEOFF, command_of, modes};

const HEARTBEAT: u32 = 0;
const CURRENT_MODE: u32 = 436;
/// Parameter 2 of the command that stops motors in the air.
const KILL: f32 = 21_196.0;
/// Setpoints end so soon after a report of another's mode.
const SETPOINTS_END: Duration = Duration::from_millis(1200);

/// An order to stop the motors waits for a report of the mode, and is repeated for 5 s.
const KILLING: Duration = Duration::from_secs(8);

/// The laws, and what they remember.
#[derive(Debug)]
pub struct Laws {
    /// modes that are ours: that in which setpoints are flown, and those that were asked for
    ours: Vec<u32>,
    /// the station has ordered or sent something: whatever mode the vehicle was left for before is nobody's takeover
    began: bool,
    /// our mode was seen since then
    engaged: bool,
    /// since when the latest report that the station took says another's mode
    other: Option<Duration>,
    /// hands were taken off, and no operator ordered anything since
    hands_off: bool,
    /// when the operator last ordered the motors off: the stream goes on until that is answered or given up
    killed: Option<Duration>,
    /// frames of the vehicle with an odd number are about: which report is the latest is not known
    pub out_of_order: bool,
    stack: Autopilot,
}

impl Laws {
    pub fn new(stack: Autopilot) -> Self {
        let ours = vec![modes(stack).external];
        Self {
            ours,
            began: false,
            engaged: false,
            other: None,
            hands_off: false,
            killed: None,
            out_of_order: false,
            stack,
        }
    }

    /// The station took a frame of the vehicle with a right checksum.
    pub fn reported(&mut self, now: Duration, frame: &Frame<'_>) {
        if ![HEARTBEAT, CURRENT_MODE].contains(&frame.header().message_id) {
            return;
        }
        let mode = frame.payload().u32(0);
        self.engaged |= self.began && mode == modes(self.stack).external;
        if !self.engaged || self.ours.contains(&mode) {
            self.other = None;
        } else {
            self.other.get_or_insert(now);
        }
    }

    /// The operator ordered something: it is no takeover any more.
    pub fn ordered(&mut self, now: Duration, kill: bool) {
        self.killed = kill.then_some(now).or(self.killed);
        self.hands_off = false;
        self.other = None;
        self.engaged = false;
    }

    /// The phase that the station says it is in.
    pub fn phase(&mut self, name: &str) {
        self.hands_off |= name == "hands off";
    }

    /// The station sends a message.
    pub fn sent(&mut self, now: Duration, message: &MavMessage) {
        if let MavMessage::SET_POSITION_TARGET_LOCAL_NED(data) = message {
            let fields = [data.x, data.y, data.z, data.vx, data.vy, data.vz, data.afx, data.afy, data.afz];
            assert!(
                fields.iter().chain([&data.yaw, &data.yaw_rate]).all(|value| value.is_finite()),
                "{data:?}"
            );
            let late = self.other.is_some_and(|since| now.saturating_sub(since) > SETPOINTS_END);
            assert!(
                self.out_of_order || !late,
                "a setpoint at {now:?}, and another has the vehicle: {self:?}"
            );
            let killing = self.killed.is_some_and(|since| now.saturating_sub(since) < KILLING);
            assert!(!self.hands_off || killing, "a setpoint at {now:?} with hands off");
            self.began = true;
            return;
        }
        let Some(command) = command_of(message) else { return };
        let number = command.command as u32;
        let fields =
            [command.param1, command.param2, command.param3, command.param4, command.param5, command.param6];
        assert!(fields.iter().chain([&command.param7]).all(|value| value.is_finite()), "{command:?}");
        // motors off is the operator's own word, and stands until it is answered
        let kills = number == ARM && command.param2 == KILL;
        if ![SET_MODE, ARM, TAKEOFF].contains(&number) || kills {
            return;
        }
        assert!(!self.hands_off, "{command:?} at {now:?} with hands off");
        assert!(
            self.out_of_order || self.other.is_none(),
            "{command:?} at {now:?}, and another has the vehicle: {self:?}"
        );
        self.began = true;
    }

    /// A mode was asked for, whether the vehicle heard it or not.
    pub fn asked_for(&mut self, mode: u32) {
        if !self.ours.contains(&mode) {
            self.ours.push(mode);
        }
    }

    /// A setpoint before it becomes a message.
    pub fn made(setpoint: &Setpoint) {
        let vectors = [setpoint.position_m, setpoint.velocity_m_s, setpoint.acceleration_m_s2];
        let finite = vectors.iter().all(|vector| vector.iter().all(|value| value.is_finite()));
        assert!(
            finite && setpoint.yaw_rad.is_finite() && setpoint.yaw_rate_rad_s.is_finite(),
            "{setpoint:?}"
        );
    }
}
