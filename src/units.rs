//! Raw units become SI here and nowhere else.
//!
//! MAVLink speaks milliseconds, microseconds, milli-g, centidegrees and the like; the names of these
//! functions carry the unit that comes in, and each returns SI.

/// Standard gravity as MAVLink's milli-g fields mean it, m/s^2 (CGPM 1901).
pub const STANDARD_GRAVITY_M_S2: f64 = 9.806_65;

/// Gravity of the paper's model (1), m/s^2. Used wherever the model needs gravity, unless a vehicle
/// file says otherwise.
pub const GRAVITY_M_S2: f64 = 9.81;

/// Density of air at sea level, 15 degrees Celsius (ISO 2533), kg/m^3.
pub const AIR_DENSITY_KG_M3: f64 = 1.225;

/// Density of the standard atmosphere (ISO 2533) over that at sea level, at a height above the sea (m) below 11 km. Weather
/// changes it by a few percent.
#[must_use]
pub fn air_density_ratio(altitude_m: f64) -> f64 {
    // 6.5 K/km from 288.15 K; g M / (R L) - 1
    (1.0 - 2.255_77e-5 * altitude_m).max(0.0).powf(4.255_9)
}

/// Milliseconds to seconds.
#[must_use]
pub fn seconds_from_ms(ms: f64) -> f64 {
    ms * 1e-3
}

/// Microseconds to seconds.
#[must_use]
pub fn seconds_from_us(us: f64) -> f64 {
    us * 1e-6
}

/// Milli-g (standard gravity) to m/s^2.
#[must_use]
pub fn m_s2_from_milli_g(milli_g: f64) -> f64 {
    milli_g * 1e-3 * STANDARD_GRAVITY_M_S2
}

/// Milliradians per second to rad/s.
#[must_use]
pub fn rad_s_from_mrad_s(mrad_s: f64) -> f64 {
    mrad_s * 1e-3
}

/// Revolutions per minute to rad/s.
#[must_use]
pub fn rad_s_from_rpm(rpm: f64) -> f64 {
    rpm * std::f64::consts::TAU / 60.0
}

/// Millivolts to volts.
#[must_use]
pub fn volts_from_mv(mv: f64) -> f64 {
    mv * 1e-3
}

/// Centivolts to volts.
#[must_use]
pub fn volts_from_cv(cv: f64) -> f64 {
    cv * 1e-2
}

/// Centiamperes to amperes.
#[must_use]
pub fn amperes_from_ca(ca: f64) -> f64 {
    ca * 1e-2
}

/// Degrees to radians.
#[must_use]
pub fn rad_from_deg(deg: f64) -> f64 {
    deg.to_radians()
}

/// Radians to degrees, for what a person reads.
#[must_use]
pub fn deg_from_rad(rad: f64) -> f64 {
    rad.to_degrees()
}

/// To the precision of MAVLink's floats.
#[must_use]
#[expect(clippy::cast_possible_truncation, reason = "rounding to the message's precision is what is wanted")]
pub fn narrow(value: f64) -> f32 {
    value as f32
}

/// The nearest whole number; holds at the bounds and turns NaN into 0.
#[must_use]
#[expect(clippy::cast_possible_truncation, reason = "rounded before, saturates")]
pub fn whole(value: f64) -> i32 {
    value.round() as i32
}

/// Nearest whole number that is not negative; a field holds at its bounds, and nothing (not a number) is zero.
#[must_use]
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a field holds at its bounds")]
pub fn whole_unsigned(value: f64) -> u32 {
    value.round() as u32
}
