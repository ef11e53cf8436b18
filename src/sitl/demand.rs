//! SET_POSITION_TARGET_LOCAL_NED and SET_ATTITUDE_TARGET as each autopilot reads them.

use crate::wire::mav_frame::{BODY_NED, FORCE_SET, LOCAL_NED};
use nalgebra::{UnitQuaternion, Vector3};

use super::Firmware;
use crate::frames::{
    Attitude, Body, World, attitude_from_frd_ned, body_from_frd, world_from_ned, yaw_from_ned,
};
use crate::physics::State;
use crate::simulate::GuidedTarget;
use crate::wire::Payload;

/// What a setpoint asks for, world; what is not asked for is NaN or `None`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Demand {
    /// place and how to move there
    pub(super) motion: GuidedTarget,
    /// about up
    pub(super) yaw_rad: Option<f64>,
    /// about up
    pub(super) yaw_rate_rad_s: Option<f64>,
}

/// What SET_ATTITUDE_TARGET asks for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct AttitudeDemand {
    /// body to world; `None`: the rates alone count
    pub(super) attitude: Option<UnitQuaternion<f64>>,
    /// body, rad/s; with an attitude only the last, about the vertical
    pub(super) rates_rad_s: Vector3<f64>,
    pub(super) lift: Lift,
}

/// What carries the vehicle meanwhile.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Lift {
    /// share of full thrust, 0 to 1
    Thrust(f64),
    /// up, m/s
    Climb(f64),
}

/// How ArduPilot reads the thrust of SET_ATTITUDE_TARGET.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum ThrustField {
    /// as a thrust
    Thrust,
    /// half stays at its height, one climbs and zero descends at these speeds, m/s
    Climb {
        /// upwards
        climb_m_s: f64,
        /// downwards, positive
        descent_m_s: f64,
    },
}

impl AttitudeDemand {
    /// As PX4 reads it; `None` where it asks for nothing that can be flown: neither an attitude nor all three
    /// rates, no thrust, or what is no number.
    pub(super) fn px4(payload: Payload) -> Option<Self> {
        let mask = payload.u8(38);
        let thrust = payload.f32(32);
        let [x, y, z] = body_from_frd(payload.f32s(20)).0.into();
        if mask & THRUST != 0 || !thrust.is_finite() {
            return None;
        }
        let lift = Lift::Thrust(thrust.clamp(0.0, 1.0));
        if mask & ATTITUDE == 0 {
            let Attitude(attitude) = attitude_from_frd_ned(payload.f32s(4))?;
            let yaw_rate = if mask & TURN_YAW == 0 && z.is_finite() { z } else { 0.0 };
            let rates_rad_s = Vector3::new(0.0, 0.0, yaw_rate);
            return Some(Self { attitude: Some(attitude), rates_rad_s, lift });
        }
        let rates_rad_s = Vector3::new(x, y, z);
        let all = mask & TURN == 0 && rates_rad_s.iter().all(|rate| rate.is_finite());
        all.then_some(Self { attitude: None, rates_rad_s, lift })
    }

    /// As ArduPilot reads it; `None` where it stops the vehicle: no thrust, a quaternion that is none, or rates
    /// about some axes only.
    pub(super) fn ardupilot(payload: Payload, field: ThrustField) -> Option<Self> {
        let mask = payload.u8(38);
        let thrust = payload.f32(32);
        let rates = match mask & TURN {
            0 => body_from_frd(payload.f32s(20)).0,
            TURN => Vector3::zeros(),
            _ => return None,
        };
        let is_number = thrust.is_finite() && rates.iter().all(|rate| rate.is_finite());
        if mask & THRUST != 0 || !is_number {
            return None;
        }
        let share = thrust.clamp(0.0, 1.0);
        let lift = match field {
            ThrustField::Thrust => Lift::Thrust(share),
            ThrustField::Climb { climb_m_s, .. } if share >= 0.5 => {
                Lift::Climb((2.0 * share - 1.0) * climb_m_s)
            }
            ThrustField::Climb { descent_m_s, .. } => Lift::Climb((2.0 * share - 1.0) * descent_m_s),
        };
        if mask & ATTITUDE != 0 {
            return Some(Self { attitude: None, rates_rad_s: rates, lift });
        }
        let quaternion: [f64; 4] = payload.f32s(4);
        let square: f64 = quaternion.iter().map(|part| part * part).sum();
        if (square - 1.0).abs() > UNIT_WITHIN {
            return None;
        }
        let Attitude(attitude) = attitude_from_frd_ned(quaternion)?;
        Some(Self { attitude: Some(attitude), rates_rad_s: Vector3::new(0.0, 0.0, rates.z), lift })
    }

    /// Level, at its height, towards a heading: what ArduPilot flies when nothing comes any more.
    pub(super) fn level(yaw_rad: f64) -> Self {
        Self {
            attitude: Some(UnitQuaternion::from_euler_angles(0.0, 0.0, yaw_rad)),
            rates_rad_s: Vector3::zeros(),
            lift: Lift::Climb(0.0),
        }
    }
}

/// Why a message is no setpoint.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Refusal {
    /// dropped in silence
    Dropped,
    /// PX4 says which frame it does not support
    Frame(u8),
    /// ArduPilot stops the vehicle
    Stop,
}

const LOCAL_OFFSET_NED: u8 = 7;
const BODY_OFFSET_NED: u8 = 9;

/// type_mask: 1 means ignore.
const POSITION: u16 = 0b111;
const VELOCITY: u16 = 0b111 << 3;
const ACCELERATION: u16 = 0b111 << 6;
const YAW: u16 = 1 << 10;
const YAW_RATE: u16 = 1 << 11;

/// type_mask of SET_ATTITUDE_TARGET: rates, that about z, thrust, attitude.
const TURN: u8 = 0b111;
const TURN_YAW: u8 = 1 << 2;
const THRUST: u8 = 1 << 6;
const ATTITUDE: u8 = 1 << 7;
/// A quaternion whose square is further from one is none for ArduPilot.
const UNIT_WITHIN: f64 = 1e-3;

/// The message's fields as they come.
struct Fields {
    frame: u8,
    mask: u16,
    position: [f64; 3],
    velocity: [f64; 3],
    acceleration: [f64; 3],
    yaw_rad: Option<f64>,
    yaw_rate_rad_s: Option<f64>,
}

impl Fields {
    fn read(payload: Payload) -> Self {
        let mask = payload.u16(48);
        let kept = |bit: u16, value: f64| (mask & bit == 0 && value.is_finite()).then(|| yaw_from_ned(value));
        Self {
            frame: payload.u8(52),
            mask,
            position: payload.f32s(4),
            velocity: payload.f32s(16),
            acceleration: payload.f32s(28),
            yaw_rad: kept(YAW, payload.f32(40)),
            yaw_rate_rad_s: kept(YAW_RATE, payload.f32(44)),
        }
    }
}

impl Demand {
    /// What the message asks of a vehicle that is in `estimate`.
    pub(super) fn read(kind: Firmware, payload: Payload, estimate: &State) -> Result<Self, Refusal> {
        let fields = Fields::read(payload);
        if kind.is_px4() { px4(&fields, estimate) } else { ardupilot(&fields, estimate) }
    }

    /// PX4 flies it: each axis has a position, velocity or acceleration, and the horizontal ones come in
    /// pairs.
    pub(super) fn is_complete(&self) -> bool {
        let has = |axis: usize| {
            [&self.motion.position_m, &self.motion.velocity_m_s, &self.motion.acceleration_m_s2]
                .map(|v| v[axis].is_finite())
        };
        (0..3).all(|axis| has(axis).contains(&true)) && has(0) == has(1)
    }
}

fn heading(estimate: &State) -> UnitQuaternion<f64> {
    UnitQuaternion::from_euler_angles(0.0, 0.0, estimate.attitude.euler_angles().2)
}

/// PX4: each axis alone is ignored or not; position, velocity and acceleration are honoured together.
fn px4(fields: &Fields, estimate: &State) -> Result<Demand, Refusal> {
    if fields.mask & FORCE_SET != 0 {
        return Err(Refusal::Dropped);
    }
    let masked = |first_bit: u16, values: [f64; 3]| {
        let mut values = values;
        for (axis, value) in values.iter_mut().enumerate() {
            if fields.mask & (first_bit << axis) != 0 {
                *value = f64::NAN;
            }
        }
        values
    };
    let position = masked(1, fields.position);
    let velocity = masked(1 << 3, fields.velocity);
    let acceleration = masked(1 << 6, fields.acceleration);
    let (position_m, velocity_m_s, acceleration_m_s2) = match fields.frame {
        LOCAL_NED => (world_from_ned(position).0, world_from_ned(velocity).0, world_from_ned(acceleration).0),
        BODY_NED => {
            let turn = heading(estimate);
            let turned = |values| turn * body_from_frd(values).0;
            (Vector3::repeat(f64::NAN), turned(velocity), turned(acceleration))
        }
        other => return Err(Refusal::Frame(other)),
    };
    let nothing = [position_m, velocity_m_s, acceleration_m_s2].iter().flatten().all(|value| value.is_nan());
    if nothing {
        return Err(Refusal::Dropped);
    }
    let (yaw_rad, yaw_rate_rad_s) = (fields.yaw_rad, fields.yaw_rate_rad_s);
    let motion = GuidedTarget { position_m, velocity_m_s, acceleration_m_s2 };
    Ok(Demand { motion, yaw_rad, yaw_rate_rad_s })
}

/// ArduPilot: any bit of a group ignores the whole vector; what it cannot use stops the vehicle.
fn ardupilot(fields: &Fields, estimate: &State) -> Result<Demand, Refusal> {
    let frame = fields.frame;
    if fields.mask & FORCE_SET != 0
        || !matches!(frame, LOCAL_NED | LOCAL_OFFSET_NED | BODY_NED | BODY_OFFSET_NED)
    {
        return Err(Refusal::Stop);
    }
    let body = matches!(frame, BODY_NED | BODY_OFFSET_NED);
    let turn = heading(estimate);
    let vector = |group: u16, values: [f64; 3]| {
        if fields.mask & group != 0 {
            return Ok(Vector3::repeat(f64::NAN));
        }
        if values.iter().any(|value| !value.is_finite()) {
            return Err(Refusal::Stop);
        }
        Ok(if body {
            turn * body_from_frd(values).0
        } else {
            let World(vector) = world_from_ned(values);
            vector
        })
    };
    let mut position_m = vector(POSITION, fields.position)?;
    if frame != LOCAL_NED {
        position_m += estimate.position_m;
    }
    let velocity_m_s = vector(VELOCITY, fields.velocity)?;
    let mut acceleration_m_s2 = vector(ACCELERATION, fields.acceleration)?;
    let has = |vector: &Vector3<f64>| vector.x.is_finite();
    match (has(&position_m), has(&velocity_m_s), has(&acceleration_m_s2)) {
        (false, false, false) => return Err(Refusal::Stop),
        // an acceleration counts with a velocity, or alone
        (true, false, true) => acceleration_m_s2 = Vector3::repeat(f64::NAN),
        _ => {}
    }
    let turned = if body { estimate.attitude.euler_angles().2 } else { 0.0 };
    let yaw_rad = fields.yaw_rad.map(|yaw| yaw + turned);
    let motion = GuidedTarget { position_m, velocity_m_s, acceleration_m_s2 };
    Ok(Demand { motion, yaw_rad, yaw_rate_rad_s: fields.yaw_rate_rad_s })
}

/// A world position as MAVLink has it.
pub(super) fn ned(vector: Vector3<f64>) -> [f64; 3] {
    crate::frames::ned_from_world(World(vector))
}

/// A body vector as MAVLink has it.
pub(super) fn frd(vector: Vector3<f64>) -> [f64; 3] {
    crate::frames::frd_from_body(Body(vector))
}
