//! A vehicle as little as a flight needs: it tells of itself, obeys commands, and is where setpoints are.

use std::time::Duration;

use mavid::autopilot::Autopilot;
use mavid::fly::Setpoint;
use mavlink::dialects::ardupilotmega::{COMMAND_LONG_DATA, MavMessage};
use nalgebra::Vector3;

use super::super::frames::{From, VEHICLE, payload, v2};

/// Commands of MAVLink by number.
pub const TAKEOFF: u32 = 22;
pub const SET_MODE: u32 = 176;
pub const ARM: u32 = 400;
const REQUEST_MESSAGE: u32 = 512;
const TIMESYNC: u32 = 111;

const CLIMB_M_S: f64 = 1.0;
/// Between its messages: position and attitude, state, estimator.
const MOTION: Duration = Duration::from_millis(40);
const STATE: Duration = Duration::from_millis(200);
const STATUS: Duration = Duration::from_millis(500);

/// Custom mode numbers.
#[derive(Debug, Clone, Copy)]
pub struct Modes {
    pub external: u32,
    pub hold: u32,
    pub land: u32,
    pub home: u32,
    /// what a pilot's switch chooses
    pub pilot: [u32; 4],
}

const fn px4(main: u32, sub: u32) -> u32 {
    main << 16 | sub << 24
}

/// Of an autopilot, from its own documentation.
pub fn modes(stack: Autopilot) -> Modes {
    match stack {
        Autopilot::Px4 => Modes {
            external: px4(6, 0),
            hold: px4(4, 3),
            land: px4(4, 6),
            home: px4(4, 5),
            pilot: [px4(3, 0), px4(2, 0), px4(7, 0), px4(1, 0)],
        },
        _ => Modes { external: 4, hold: 17, land: 9, home: 6, pilot: [16, 2, 0, 1] },
    }
}

/// The vehicle.
#[derive(Debug)]
pub struct Vehicle {
    pub stack: Autopilot,
    pub mode: u32,
    pub armed: bool,
    pub position_m: Vector3<f64>,
    /// added to what it tells of its position
    pub jump_m: f64,
    pub booted: Duration,
    pub battery_percent: u8,
    velocity_m_s: Vector3<f64>,
    yaw_rad: f64,
    sequence: u8,
    climbs_to_m: Option<f64>,
    due: [Duration; 3],
    grounded: Duration,
}

impl Vehicle {
    pub fn new(stack: Autopilot) -> Self {
        Self {
            stack,
            mode: modes(stack).pilot[2],
            armed: false,
            position_m: Vector3::zeros(),
            jump_m: 0.0,
            booted: Duration::ZERO,
            battery_percent: 90,
            velocity_m_s: Vector3::zeros(),
            yaw_rad: 0.0,
            sequence: 0,
            climbs_to_m: None,
            due: [Duration::ZERO; 3],
            grounded: Duration::ZERO,
        }
    }

    /// A frame of it with the next sequence number.
    pub fn say(&mut self, id: u32, payload: &[u8]) -> Vec<u8> {
        self.sequence = self.sequence.wrapping_add(1);
        v2(id, From { sender: VEHICLE, sequence: self.sequence }, payload)
    }

    /// Flies to a setpoint where its mode says so.
    pub fn follow(&mut self, setpoint: &Setpoint) {
        if self.mode == modes(self.stack).external && self.armed && self.climbs_to_m.is_none() {
            self.velocity_m_s = setpoint.velocity_m_s;
            self.position_m = setpoint.position_m;
            self.yaw_rad = setpoint.yaw_rad;
        }
    }

    /// The mode that a command asks for.
    pub fn asked_for(&self, command: &COMMAND_LONG_DATA) -> u32 {
        let (main, sub) = (whole(command.param2), whole(command.param3));
        if self.stack == Autopilot::Px4 { px4(main, sub) } else { main }
    }

    /// Does what it is told; the answers.
    pub fn obey(&mut self, command: &COMMAND_LONG_DATA) -> Vec<Vec<u8>> {
        let number = command.command as u32;
        match number {
            SET_MODE => self.mode = self.asked_for(command),
            ARM => self.armed = command.param1 > 0.5,
            TAKEOFF => self.climbs_to_m = Some(command.param7.into()),
            _ => {}
        }
        let low = u16::try_from(number).unwrap_or(0).to_le_bytes();
        let mut answers = vec![self.say(77, &payload(10, &[(0, &low)]))];
        match whole(command.param1) {
            148 if number == REQUEST_MESSAGE => answers.push(self.say(148, &payload(78, &[(60, &[9; 18])]))),
            0 if number == REQUEST_MESSAGE => answers.push(self.heartbeat()),
            _ => {}
        }
        answers
    }

    /// TIMESYNC that answers the question of this number.
    pub fn answer(&mut self, number: i64) -> Vec<u8> {
        self.say(TIMESYNC, &payload(16, &[(0, &1_i64.to_le_bytes()), (8, &number.to_le_bytes())]))
    }

    /// Goes on by a step and tells of itself.
    pub fn advance(&mut self, now: Duration, step: Duration) -> Vec<Vec<u8>> {
        self.fly(now, step.as_secs_f64());
        let mut said = Vec::new();
        for (index, period) in [MOTION, STATE, STATUS].into_iter().enumerate() {
            if now >= self.due[index] {
                self.due[index] = now + period;
                said.extend(match index {
                    0 => self.motion(now),
                    1 => self.state(),
                    _ => self.status(now),
                });
            }
        }
        said
    }

    fn fly(&mut self, now: Duration, step_s: f64) {
        let modes = modes(self.stack);
        if let Some(top_m) = self.climbs_to_m.filter(|_| self.armed && self.mode == modes.external) {
            self.position_m.z += CLIMB_M_S * step_s;
            self.velocity_m_s = Vector3::zeros();
            if self.position_m.z >= top_m {
                self.climbs_to_m = None;
            }
        }
        if [modes.land, modes.home].contains(&self.mode) || !self.armed {
            self.position_m.z = (self.position_m.z - CLIMB_M_S * step_s).max(0.0);
            self.velocity_m_s = Vector3::zeros();
        }
        if self.position_m.z > 0.05 {
            self.grounded = now;
        } else if self.mode == modes.land && now.saturating_sub(self.grounded) > Duration::from_secs(1) {
            self.armed = false;
        }
    }

    fn boot_ms(&self, now: Duration) -> [u8; 4] {
        u32::try_from(now.saturating_sub(self.booted).as_millis()).unwrap_or(u32::MAX).to_le_bytes()
    }

    fn motion(&mut self, now: Duration) -> Vec<Vec<u8>> {
        let at = self.boot_ms(now);
        let (p, v) = (self.position_m.map(single), self.velocity_m_s.map(single));
        let jumped = p.x + single(self.jump_m);
        let ned = [jumped, -p.y, -p.z, v.x, -v.y, -v.z].map(f32::to_le_bytes).concat();
        let half = self.yaw_rad / 2.0;
        let turn = [single(half.cos()), 0.0, 0.0, -single(half.sin())].map(f32::to_le_bytes).concat();
        let position = self.say(32, &payload(28, &[(0, &at), (4, &ned)]));
        vec![position, self.say(31, &payload(32, &[(0, &at), (4, &turn)]))]
    }

    fn heartbeat(&mut self) -> Vec<u8> {
        let mode = self.mode.to_le_bytes();
        let autopilot = if self.stack == Autopilot::Px4 { 12 } else { 3 };
        let base = if self.armed { 0x81 } else { 1 };
        self.say(0, &payload(9, &[(0, &mode), (4, &[2, autopilot, base, 4, 3])]))
    }

    fn state(&mut self) -> Vec<Vec<u8>> {
        let mode = self.mode.to_le_bytes();
        let landed = if self.position_m.z > 0.05 { 2 } else { 1 };
        let mut said = vec![self.heartbeat(), self.say(245, &[0, landed])];
        if self.stack == Autopilot::Px4 {
            said.push(self.say(436, &payload(9, &[(0, &mode), (4, &mode)])));
        }
        said
    }

    fn status(&mut self, now: Duration) -> Vec<Vec<u8>> {
        let sensors = [0x1000_000F_u32.to_le_bytes(); 3].concat();
        let system =
            self.say(1, &payload(31, &[(0, &sensors), (14, &[0xFF, 0x3F]), (30, &[self.battery_percent])]));
        let flags = 0x033F_u16.to_le_bytes();
        let micros = u64::try_from(now.as_micros()).unwrap_or(0).to_le_bytes();
        let estimator = match self.stack {
            Autopilot::Px4 => self.say(230, &payload(42, &[(0, &micros), (40, &flags)])),
            _ => self.say(193, &payload(22, &[(20, &flags)])),
        };
        vec![system, estimator]
    }
}

#[expect(clippy::cast_possible_truncation, reason = "MAVLink's values are single-precision")]
fn single(value: f64) -> f32 {
    value as f32
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small whole numbers")]
fn whole(value: f32) -> u32 {
    value as u32
}

/// What a message commands, if it does.
pub fn command_of(message: &MavMessage) -> Option<&COMMAND_LONG_DATA> {
    match message {
        MavMessage::COMMAND_LONG(data) => Some(data),
        _ => None,
    }
}
