//! What the program's messages say, and whether each is one that a vehicle may be sent.

use std::time::Duration;

use mavid::wire::{Check, CrcSeeds, Frame, Payload};
use mavlink::dialects::ardupilotmega::MavMessage;
use mavlink::{MavlinkVersion, Message};

const HEARTBEAT: u32 = 0;
const COMMAND_INT: u32 = 75;
const COMMAND_LONG: u32 = 76;
const SETPOINT: u32 = 84;
/// Messages that steer, change or store something on a vehicle: SET_MODE, PARAM_SET, MISSION_*, MANUAL_CONTROL,
/// RC_CHANNELS_OVERRIDE, the other setpoints, ...
const STEERING: [u32; 22] =
    [5, 11, 23, 39, 41, 44, 45, 48, 69, 70, 73, 75, 82, 86, 110, 139, 232, 243, 256, 331, 385, 121];
/// Setpoints beyond this are no places, m.
const FAR_M: f64 = 1e4;
const FAST: f64 = 1e3;

/// What steers: a set mode, and so on.
#[derive(Debug, Clone, PartialEq)]
pub enum Left {
    Setpoint(SetpointSeen),
    /// DO_SET_MODE, as HEARTBEAT.custom_mode has it
    Mode(u32),
    /// arm or disarm; forced
    Arm(bool, bool),
    Takeoff(f64),
    /// a question, a heartbeat: message id, or the command's number
    Other(u32),
    /// what should never leave
    Wrong(String),
}

/// Of SET_POSITION_TARGET_LOCAL_NED, north, west, up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SetpointSeen {
    /// by its own stamp
    pub made: Duration,
    pub position_m: [f64; 3],
    pub velocity_m_s: [f64; 3],
}

impl Left {
    /// Changes a mode, arms, disarms or takes off.
    pub fn commands(&self) -> bool {
        matches!(self, Self::Mode(_) | Self::Arm(..) | Self::Takeoff(_))
    }

    /// Of a frame that left the program; whose modes it names.
    pub fn of(seeds: &CrcSeeds, px4: bool, bytes: &[u8]) -> Self {
        let Some(frame) = Frame::at_start(bytes).filter(|frame| frame.bytes().len() == bytes.len()) else {
            return Self::Wrong(format!("{} bytes that are no frame", bytes.len()));
        };
        let (id, payload) = (frame.header().message_id, frame.payload());
        if frame.check(seeds) != Check::Right {
            return Self::Wrong(format!("message {id} with a wrong checksum"));
        }
        if let Err(error) = MavMessage::parse(MavlinkVersion::V2, id, payload.0) {
            return Self::Wrong(format!("message {id} that does not decode: {error}"));
        }
        match id {
            SETPOINT => setpoint(payload),
            COMMAND_LONG => command(px4, payload),
            COMMAND_INT => Self::Wrong("COMMAND_INT".into()),
            HEARTBEAT if payload.u8(4) != 6 || payload.u8(6) & 128 != 0 => {
                Self::Wrong("a HEARTBEAT that is no ground station's".into())
            }
            _ if STEERING.contains(&id) => Self::Wrong(format!("message {id}, which steers")),
            _ => Self::Other(id),
        }
    }
}

fn setpoint(payload: Payload<'_>) -> Left {
    let f = |index: usize| payload.f32(4 + 4 * index);
    let (mask, frame) = (payload.u16(48), payload.u8(52));
    let (system, component) = (payload.u8(50), payload.u8(51));
    let angle = f(9).abs() <= std::f64::consts::PI + 1e-3 && f(10).abs() <= 10.0;
    let near = (0..3).all(|index| f(index).abs() < FAR_M);
    let slow = (3..9).all(|index| f(index).abs() < FAST);
    // ignoring any but the acceleration, or that and the yaw rate, leaves something out that decides
    let allowed = mask & !0b1001_1100_0000 == 0;
    if !(angle && near && slow && allowed) || frame != 1 || (system, component) != (1, 1) {
        let values: Vec<f64> = (0..11).map(f).collect();
        return Left::Wrong(format!(
            "a setpoint out of range: {values:?} mask {mask:#x} frame {frame} for {system}/{component}"
        ));
    }
    let world = |at: usize| [f(at), -f(at + 1), -f(at + 2)];
    Left::Setpoint(SetpointSeen {
        made: Duration::from_millis(payload.u32(0).into()),
        position_m: world(0),
        velocity_m_s: world(3),
    })
}

fn command(px4: bool, payload: Payload<'_>) -> Left {
    let p: Vec<f64> = (0..7).map(|index| payload.f32(4 * index)).collect();
    let (number, target) = (u32::from(payload.u16(28)), (payload.u8(30), payload.u8(31)));
    let wrong = || Left::Wrong(format!("command {number} out of range: {p:?} for {target:?}"));
    if p.iter().any(|value| !value.is_finite()) || target.0 != 1 {
        return wrong();
    }
    let zero = |from: usize| p[from..].iter().all(|value| *value == 0.0);
    match number {
        176 => {
            let modes: &[(f64, f64)] = if px4 {
                &[(6.0, 0.0), (4.0, 3.0), (4.0, 6.0), (4.0, 5.0)]
            } else {
                &[(4.0, 0.0), (17.0, 0.0), (9.0, 0.0), (6.0, 0.0)]
            };
            if p[0] != 1.0 || !modes.contains(&(p[1], p[2])) || !zero(3) {
                return wrong();
            }
            let (main, sub) = (p[1] as u32, p[2] as u32);
            Left::Mode(if px4 { main << 16 | sub << 24 } else { main })
        }
        400 if (p[0] == 0.0 || p[0] == 1.0) && (p[1] == 0.0 || p[1] == 21_196.0) && zero(2) => {
            Left::Arm(p[0] == 1.0, p[1] != 0.0)
        }
        22 if !px4 && p[6] > 0.0 && p[6] < 100.0 => Left::Takeoff(p[6]),
        // SET_MESSAGE_INTERVAL, REQUEST_MESSAGE, GET_MESSAGE_INTERVAL
        510..=512 if p[0] >= 0.0 && p[0] < 65_536.0 => Left::Other(number),
        _ => wrong(),
    }
}
