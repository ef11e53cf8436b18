//! The frames of the paper, and the one door between them and MAVLink's.
//!
//! Inside: body x forward, y left, z up (FLU); world north, west, up (NWU). MAVLink, PX4 and
//! ArduPilot speak forward-right-down and north-east-down. Both changes are the same half turn about
//! x: y and z change sign. `Ixy` and `Ixz` change sign with it, `Iyz` does not.
//!
//! A body vector and a world vector cannot be mixed up:
//!
//! ```compile_fail
//! use mavid::frames::{Attitude, World};
//! use nalgebra::Vector3;
//! let attitude = Attitude::identity();
//! let wind = World(Vector3::new(1.0, 0.0, 0.0));
//! let _ = attitude.to_world(wind); // a world vector is already in the world frame
//! ```

use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};

/// A vector in the body frame, x forward, y left, z up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Body(pub Vector3<f64>);

/// A vector in the world frame, north, west, up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct World(pub Vector3<f64>);

/// Orientation of the body in the world: turns body vectors into world vectors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Attitude(pub UnitQuaternion<f64>);

impl Attitude {
    /// Level, facing north.
    #[must_use]
    pub fn identity() -> Self {
        Self(UnitQuaternion::identity())
    }

    /// From roll, pitch and yaw (ZYX, radians, FLU body in NWU world), the paper's `eta`.
    #[must_use]
    pub fn from_euler(roll_rad: f64, pitch_rad: f64, yaw_rad: f64) -> Self {
        Self(UnitQuaternion::from_euler_angles(roll_rad, pitch_rad, yaw_rad))
    }

    /// Roll, pitch, yaw in radians (ZYX).
    #[must_use]
    pub fn euler(&self) -> (f64, f64, f64) {
        self.0.euler_angles()
    }

    /// A body vector seen in the world.
    #[must_use]
    pub fn to_world(&self, vector: Body) -> World {
        World(self.0 * vector.0)
    }

    /// A world vector seen in the body.
    #[must_use]
    pub fn to_body(&self, vector: World) -> Body {
        Body(self.0.inverse_transform_vector(&vector.0))
    }

    /// `R^T e_z`: the world's up in the body frame, a unit vector.
    #[must_use]
    pub fn up_in_body(&self) -> Vector3<f64> {
        self.0.inverse_transform_vector(&Vector3::z())
    }
}

/// Forward-right-down components to this crate's body frame.
#[must_use]
pub fn body_from_frd(frd: [f64; 3]) -> Body {
    Body(Vector3::new(frd[0], -frd[1], -frd[2]))
}

/// North-east-down components to this crate's world frame.
#[must_use]
pub fn world_from_ned(ned: [f64; 3]) -> World {
    World(Vector3::new(ned[0], -ned[1], -ned[2]))
}

/// East-north-up components, ROS's world frame (REP 103), to this crate's world frame.
#[must_use]
pub fn world_from_enu(enu: [f64; 3]) -> World {
    World(Vector3::new(enu[1], -enu[0], enu[2]))
}

/// This crate's world frame to north-east-down components.
#[must_use]
pub fn ned_from_world(world: World) -> [f64; 3] {
    [world.0.x, -world.0.y, -world.0.z]
}

/// This crate's body frame to forward-right-down components.
#[must_use]
pub fn frd_from_body(body: Body) -> [f64; 3] {
    [body.0.x, -body.0.y, -body.0.z]
}

/// A quaternion (w x y z) that turns FRD into NED, as MAVLink sends it, to the attitude FLU to NWU.
/// `None` as for [`attitude_from_quaternion`].
#[must_use]
pub fn attitude_from_frd_ned(wxyz: [f64; 4]) -> Option<Attitude> {
    attitude_from_quaternion([wxyz[0], wxyz[1], -wxyz[2], -wxyz[3]])
}

/// A quaternion (w x y z) that turns FLU into ENU to the attitude FLU to NWU.
/// `None` as for [`attitude_from_quaternion`].
#[must_use]
pub fn attitude_from_flu_enu(wxyz: [f64; 4]) -> Option<Attitude> {
    let north_from_east = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), yaw_from_enu(0.0));
    attitude_from_quaternion(wxyz).map(|attitude| Attitude(north_from_east * attitude.0))
}

/// A quaternion (w x y z) that turns FLU into NWU, normalised.
/// `None` where it is not finite or its norm is not within 10 % of one.
#[must_use]
pub fn attitude_from_quaternion(wxyz: [f64; 4]) -> Option<Attitude> {
    let quaternion = Quaternion::new(wxyz[0], wxyz[1], wxyz[2], wxyz[3]);
    let norm = quaternion.norm();
    (norm.is_finite() && (norm - 1.0).abs() < 0.1)
        .then(|| Attitude(UnitQuaternion::from_quaternion(quaternion)))
}

/// The attitude as MAVLink's quaternion (w x y z), FRD to NED.
#[must_use]
pub fn frd_ned_from_attitude(attitude: Attitude) -> [f64; 4] {
    let q = attitude.0.quaternion();
    [q.w, q.i, -q.j, -q.k]
}

/// MAVLink's roll, pitch, yaw (FRD in NED, radians) to an attitude.
#[must_use]
pub fn attitude_from_euler_frd_ned(roll_rad: f64, pitch_rad: f64, yaw_rad: f64) -> Attitude {
    Attitude::from_euler(roll_rad, -pitch_rad, -yaw_rad)
}

/// Yaw about the world's down axis (MAVLink) to yaw about up.
#[must_use]
pub fn yaw_from_ned(yaw_rad: f64) -> f64 {
    -yaw_rad
}

/// Yaw about up from east (ENU) to yaw about up from north.
#[must_use]
pub fn yaw_from_enu(yaw_rad: f64) -> f64 {
    yaw_rad - std::f64::consts::FRAC_PI_2
}

/// The cross-product matrix `S(w)` of the paper: `S(w) v = w x v`.
#[must_use]
pub fn skew(w: &Vector3<f64>) -> Matrix3<f64> {
    Matrix3::new(0.0, -w.z, w.y, w.z, 0.0, -w.x, -w.y, w.x, 0.0)
}

/// A place on Earth as MAVLink says it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Geodetic {
    /// degrees north
    pub latitude_deg: f64,
    /// degrees east
    pub longitude_deg: f64,
}

/// WGS 84: semi-major axis, m, and first eccentricity squared.
const SEMI_MAJOR_M: f64 = 6_378_137.0;
const ECCENTRICITY_SQUARED: f64 = 6.694_379_990_14e-3;

impl Geodetic {
    /// Metres north and west of `origin`, by the radii of curvature there: good to centimetres over a
    /// kilometre.
    #[must_use]
    pub fn north_west_m(&self, origin: &Self) -> [f64; 2] {
        let (along_m, across_m) = origin.radii_m();
        // the short way round at the date line
        let east_deg = (self.longitude_deg - origin.longitude_deg + 540.0).rem_euclid(360.0) - 180.0;
        let north = (self.latitude_deg - origin.latitude_deg).to_radians() * along_m;
        [north, -east_deg.to_radians() * across_m]
    }

    /// The place that is this many metres north and west of `self`: the inverse of
    /// [`north_west_m`](Self::north_west_m).
    #[must_use]
    pub fn moved(&self, [north_m, west_m]: [f64; 2]) -> Self {
        let (along_m, across_m) = self.radii_m();
        let east_deg = (-west_m / across_m).to_degrees();
        Self {
            latitude_deg: self.latitude_deg + (north_m / along_m).to_degrees(),
            longitude_deg: (self.longitude_deg + east_deg + 540.0).rem_euclid(360.0) - 180.0,
        }
    }

    /// Metres in a radian of latitude, and of longitude.
    fn radii_m(&self) -> (f64, f64) {
        let (sin, cos) = self.latitude_deg.to_radians().sin_cos();
        let flat = 1.0 - ECCENTRICITY_SQUARED * sin * sin;
        let across_m = SEMI_MAJOR_M / flat.sqrt();
        (across_m * (1.0 - ECCENTRICITY_SQUARED) / flat, across_m * cos)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    #[test]
    fn nose_up_in_ned_is_negative_pitch_about_left() {
        // 0.1 rad nose up in FRD/NED: forward points up, so its world z (up) is positive
        let attitude = attitude_from_euler_frd_ned(0.0, 0.1, 0.0);
        let forward = attitude.to_world(Body(Vector3::x()));
        assert!((forward.0.z - 0.1_f64.sin()).abs() < 1e-12);
    }

    #[test]
    fn facing_east_in_ned_is_minus_west() {
        let attitude = attitude_from_euler_frd_ned(0.0, 0.0, FRAC_PI_2);
        let forward = attitude.to_world(Body(Vector3::x()));
        assert!((forward.0 - Vector3::new(0.0, -1.0, 0.0)).norm() < 1e-12);
        assert_eq!(ned_from_world(forward)[1].round(), 1.0);
    }

    #[test]
    fn quaternion_and_euler_doors_agree() {
        let (roll, pitch, yaw) = (0.3, -0.2, 1.1);
        let ned = UnitQuaternion::from_euler_angles(roll, pitch, yaw);
        let q = ned.quaternion();
        let by_quaternion = attitude_from_frd_ned([q.w, q.i, q.j, q.k]).unwrap();
        let by_euler = attitude_from_euler_frd_ned(roll, pitch, yaw);
        assert!(by_quaternion.0.angle_to(&by_euler.0) < 1e-12);
        let back = frd_ned_from_attitude(by_quaternion);
        assert!((back[2] - q.j).abs() < 1e-12);
    }

    #[test]
    fn facing_east_in_enu_is_minus_west() {
        let attitude = attitude_from_flu_enu([1.0, 0.0, 0.0, 0.0]).unwrap();
        let forward = attitude.to_world(Body(Vector3::x()));
        assert!((forward.0 - Vector3::new(0.0, -1.0, 0.0)).norm() < 1e-12);
        assert_eq!(forward.0.y, world_from_enu([1.0, 0.0, 0.0]).0.y);
        assert!((attitude.euler().2 - yaw_from_enu(0.0)).abs() < 1e-12);
    }

    #[test]
    fn bad_quaternions_are_refused() {
        assert!(attitude_from_frd_ned([0.0; 4]).is_none());
        assert!(attitude_from_frd_ned([f64::NAN, 0.0, 0.0, 0.0]).is_none());
    }

    #[test]
    fn hover_specific_force_points_up() {
        let body = body_from_frd([0.0, 0.0, -9.81]);
        assert_eq!(body.0.z, 9.81);
    }

    #[test]
    fn a_minute_of_latitude_is_a_nautical_mile() {
        let origin = Geodetic { latitude_deg: 45.0, longitude_deg: 179.999 };
        let place = Geodetic { latitude_deg: 45.0 + 1.0 / 60.0, longitude_deg: -179.999 };
        let [north, west] = place.north_west_m(&origin);
        assert!((north - 1852.2).abs() < 0.5, "{north}");
        // 0.002 degrees across the date line, to the east
        assert!((west + 157.7).abs() < 0.5, "{west}");
        let back = origin.moved([north, west]);
        assert!((back.latitude_deg - place.latitude_deg).abs() < 1e-9, "{back:?}");
        assert!((back.longitude_deg - place.longitude_deg).abs() < 1e-9, "{back:?}");
    }
}
