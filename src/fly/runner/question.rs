//! What the checks before the flight are made of, once all of it is known. Judging it takes a moment, in which the flight goes
//! on.

use std::sync::Arc;
use std::time::Duration;

use crate::autopilot::LogAwaited;
use crate::fly::flight::Flight;
use crate::fly::parameters::Parameters;
use crate::fly::preflight::{BatteryState, Fence, Judged, Readiness, Situation, judge};
use crate::trajectory::FlightPath;
use crate::vehicle::{Limits, Vehicle};
use nalgebra::Vector3;

/// What the vehicle told beside its state and its parameters.
#[derive(Debug)]
pub(super) struct FenceAndHome {
    pub(super) fence: Fence,
    /// home in the autopilot's local frame, m, NWU
    pub(super) home_m: Option<Vector3<f64>>,
}

/// All that is judged.
#[derive(Debug)]
pub(super) struct Question {
    path: Arc<FlightPath>,
    origin_m: Vector3<f64>,
    stand_m: Option<Vector3<f64>>,
    vehicle: Vehicle,
    limits: Limits,
    tracking_max_m: f64,
    parameters: Box<Parameters>,
    log_awaited: Vec<LogAwaited>,
    release: Option<(u8, u8)>,
    fence_and_home: FenceAndHome,
    battery: BatteryState,
    readiness: Readiness,
    own_system: u8,
}

/// What it came to.
#[derive(Debug)]
pub(super) struct Answer {
    pub(super) judged: Judged,
    pub(super) parameters: Box<Parameters>,
}

impl Question {
    /// Of a flight as it is `now`.
    pub(super) fn of(
        flight: &Flight,
        vehicle: &Vehicle,
        now: Duration,
        (parameters, fence_and_home): (Box<Parameters>, FenceAndHome),
    ) -> Self {
        let (status, sortie) = (flight.status(now), flight.sortie());
        let stand_m = status.position_m.map(Vector3::from);
        Self {
            path: Arc::clone(sortie.course.path()),
            origin_m: stand_m.map_or_else(Vector3::zeros, |stand_m| flight.offset_m(&stand_m)),
            stand_m,
            vehicle: vehicle.clone(),
            limits: sortie.limits,
            tracking_max_m: sortie.settings.tracking_max_m,
            parameters,
            log_awaited: sortie.settings.log_awaited.clone(),
            release: flight.release(),
            battery: BatteryState {
                remaining_percent: status.battery_percent.map(f64::from),
                is_low: status.battery_is_low,
                endurance_s: sortie.settings.hover_time_s,
            },
            readiness: Readiness {
                may_arm: status.may_arm,
                unhealthy: status.unhealthy.into_iter().map(str::to_owned).collect(),
                estimate_good_for: status.estimate_good_for,
                estimate_faults: status.estimator_faults,
                home_set: fence_and_home.home_m.is_some(),
                position_arrives: status.position_m.is_some(),
                armed: status.armed,
                ..Readiness::default()
            },
            fence_and_home,
            own_system: u8::try_from(sortie.settings.station.0.0).unwrap_or(u8::MAX),
        }
    }

    /// Makes the checks. On a slow or busy computer it takes seconds.
    pub(super) fn answer(self) -> Answer {
        let judged = judge(&Situation {
            path: &self.path,
            origin_m: self.origin_m,
            stand_m: self.stand_m,
            home_m: self.fence_and_home.home_m,
            vehicle: &self.vehicle,
            limits: &self.limits,
            tracking_max_m: self.tracking_max_m,
            parameters: &self.parameters,
            log_awaited: &self.log_awaited,
            release: self.release,
            fence: &self.fence_and_home.fence,
            battery: &self.battery,
            readiness: &self.readiness,
            own_system: self.own_system,
        });
        Answer { judged, parameters: self.parameters }
    }
}
