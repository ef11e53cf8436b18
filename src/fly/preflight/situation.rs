//! Data for the checks before a flight.

use super::energy::BatteryState;
use super::fence::Fence;
use super::readiness::Readiness;
use crate::autopilot::LogAwaited;
use crate::fly::course::approach;
use crate::fly::parameters::Parameters;
use crate::fly::setpoint::Place;
use crate::plan::Reach;
use crate::trajectory::FlightPath;
use crate::vehicle::{Limits, Vehicle};
use nalgebra::Vector3;

/// Data for the checks before a flight.
#[derive(Debug, Clone, Copy)]
pub struct Situation<'a> {
    /// the whole flight from hover after takeoff to hover before landing, m and rad, NWU
    pub path: &'a FlightPath,
    /// where the path's origin lies in the autopilot's local frame, m, NWU
    pub origin_m: Vector3<f64>,
    /// where the vehicle stands in the autopilot's local frame, m, NWU
    pub stand_m: Option<Vector3<f64>>,
    /// home in the autopilot's local frame, m, NWU
    pub home_m: Option<Vector3<f64>>,
    /// the vehicle file
    pub vehicle: &'a Vehicle,
    /// room and limits to keep, in the path's frame
    pub limits: &'a Limits,
    /// distance to the reference that is allowed, m
    pub tracking_max_m: f64,
    /// parameters of the vehicle
    pub parameters: &'a Parameters,
    /// parameters of its logging that count only from its next start on
    pub log_awaited: &'a [LogAwaited],
    /// major and minor number of the autopilot's release, where it said so
    pub release: Option<(u8, u8)>,
    /// the vehicle's fence
    pub fence: &'a Fence,
    /// charge
    pub battery: &'a BatteryState,
    /// health, estimate, home
    pub readiness: &'a Readiness,
    /// the ground station's MAVLink system id
    pub own_system: u8,
}

/// Default speed of landing, m/s: ArduPilot's LAND_SPEED; that of PX4, MPC_LAND_SPEED, is larger.
const LANDS_M_S: f64 = 0.5;
/// Time with motors on before the takeoff, at the start gate, and on the ground until they stop, s. It enters the
/// charge that a flight needs, at the power of idling; a larger one asks for more charge.
const WAITS_S: f64 = 15.0;

impl Situation<'_> {
    /// Home (m, local frame); if it is not known, the place where the vehicle stands, or the path's zero.
    pub(super) fn home(&self) -> Vector3<f64> {
        self.home_m.or(self.stand_m).unwrap_or(self.origin_m)
    }

    /// Paths from the place of the vehicle straight up, and from there to the start of the path; `None` if its place is
    /// not known.
    pub(super) fn way_to_start(&self) -> Option<[FlightPath; 2]> {
        let (stand_m, start) = self.stand_m.zip(self.path.derivatives(0.0))?;
        let [x, y, z, yaw_rad] = start.map(|axis| axis[0]);
        let place = |position_m| Place { position_m, yaw_rad };
        Some(approach(&place(stand_m), &place(Vector3::new(x, y, z) + self.origin_m)))
    }

    /// s from the ground to the ground: takeoff, the way to the start, the path, landing.
    pub(super) fn duration_s(&self) -> f64 {
        let way_s = self.way_to_start().iter().flatten().map(FlightPath::duration_s).sum::<f64>();
        let end_m = self.path.derivatives(self.path.duration_s()).map_or(0.0, |axes| axes[2][0]);
        way_s + self.path.duration_s() + end_m.max(0.0) / LANDS_M_S + WAITS_S
    }

    /// Largest height above home with the rotors below the ceiling, m; `None` without a ceiling.
    pub(super) fn highest_m(&self) -> Option<f64> {
        let ceiling_m = self.limits.z_max_m? + self.origin_m.z - self.home().z;
        Some(ceiling_m - Reach::of(self.vehicle).up_m)
    }
}
