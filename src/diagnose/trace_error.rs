//! Why a flight cannot be diagnosed.

/// Errors of a flight that cannot be diagnosed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TraceError {
    /// no gyroscope
    #[error(
        "body rates are not recorded: expected HIGHRES_IMU, ATTITUDE or similar messages, or the columns rate_x_rad_s, rate_y_rad_s and rate_z_rad_s of \
         a table; without them no torque can be compared"
    )]
    NoRates,
    /// neither accelerometer nor velocity with attitude
    #[error("neither an accelerometer nor velocity with attitude is recorded: no force can be compared")]
    NoForce,
    /// rotor thrusts unknown
    #[error("the log holds force and torque, not actuator outputs: what the rotors did is not known")]
    NoRotors,
    /// grid too coarse for the low-pass
    #[error("sampled at {rate_hz:.1} Hz: expected at least 25 Hz")]
    TooSlow {
        /// Hz
        rate_hz: f64,
    },
}
