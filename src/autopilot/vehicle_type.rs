//! MAV_TYPE of multirotors.

use mavlink::dialects::ardupilotmega::MavType;

/// No other type is flown, and of no other type are modes known here.
const MULTIROTORS: [MavType; 7] = [
    MavType::MAV_TYPE_QUADROTOR,
    MavType::MAV_TYPE_COAXIAL,
    MavType::MAV_TYPE_HEXAROTOR,
    MavType::MAV_TYPE_OCTOROTOR,
    MavType::MAV_TYPE_TRICOPTER,
    MavType::MAV_TYPE_DODECAROTOR,
    MavType::MAV_TYPE_DECAROTOR,
];

/// Whether a HEARTBEAT's MAV_TYPE is a multirotor's.
#[must_use]
pub fn is_multirotor(mav_type: u8) -> bool {
    MULTIROTORS.iter().any(|known| *known as u32 == u32::from(mav_type))
}

/// The MAV_TYPE of a multirotor with this many rotors. A number without a type of its own is a quadrotor's.
#[must_use]
pub fn multirotor_type(rotors: usize) -> MavType {
    match rotors {
        6 => MavType::MAV_TYPE_HEXAROTOR,
        8 => MavType::MAV_TYPE_OCTOROTOR,
        _ => MavType::MAV_TYPE_QUADROTOR,
    }
}
