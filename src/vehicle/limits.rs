//! The bounds that a vehicle must keep.

/// Bounds that a trajectory or a flight must keep; `None` where the vehicle's file sets none.
/// Angles in radians, lengths in metres.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[expect(missing_docs, reason = "each name says quantity and unit")]
pub struct Limits {
    pub roll_max_rad: Option<f64>,
    pub pitch_max_rad: Option<f64>,
    pub yaw_max_rad: Option<f64>,
    pub yaw_rate_max_rad_s: Option<f64>,
    pub yaw_acceleration_max_rad_s2: Option<f64>,
    pub x_max_m: Option<f64>,
    pub y_max_m: Option<f64>,
    pub z_min_m: Option<f64>,
    pub z_max_m: Option<f64>,
    /// bound on each of x', y', z' (the paper bounds them one by one)
    pub speed_max_m_s: Option<f64>,
    pub acceleration_max_m_s2: Option<f64>,
    pub vertical_acceleration_min_m_s2: Option<f64>,
    pub vertical_acceleration_max_m_s2: Option<f64>,
    pub thrust_max_n: Option<f64>,
    pub torque_max_nm: Option<f64>,
}
