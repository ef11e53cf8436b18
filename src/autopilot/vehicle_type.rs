//! MAV_TYPE of multirotors.

/// Quadrotor, coaxial, hexa-, octo-, tri-, dodeca-, decarotor. No other type is flown, and of no other type are modes
/// known here.
const MULTIROTORS: [u8; 7] = [QUADROTOR, 3, HEXAROTOR, OCTOROTOR, 15, 29, 35];
const QUADROTOR: u8 = 2;
const HEXAROTOR: u8 = 13;
const OCTOROTOR: u8 = 14;

/// Whether a HEARTBEAT's MAV_TYPE is a multirotor's.
#[must_use]
pub fn is_multirotor(mav_type: u8) -> bool {
    MULTIROTORS.contains(&mav_type)
}

/// The MAV_TYPE of a multirotor with this many rotors. A number without a type of its own is a quadrotor's.
#[must_use]
pub fn multirotor_type(rotors: usize) -> u8 {
    match rotors {
        6 => HEXAROTOR,
        8 => OCTOROTOR,
        _ => QUADROTOR,
    }
}
