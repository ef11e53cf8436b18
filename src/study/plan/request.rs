//! What is to be flown.

use std::path::PathBuf;

use crate::plan::PlanRequest;
use crate::study::VehicleGiven;

/// What is to be flown, and inside of which limits.
#[derive(Debug, Clone)]
pub struct PlanningRequest {
    /// vehicle or model file, or mass and frame
    pub vehicle: VehicleGiven,
    /// file with the limits; `None`: the vehicle's own
    pub limits: Option<PathBuf>,
    /// where the series comes from
    pub series: PlannedSeries,
    /// of the search; repeats and noise hold for any series
    pub search: PlanRequest,
    /// x, y, z (m), yaw (rad) of the hover after takeoff; `None`: the series' mean
    pub takeoff: Option<[f64; 4]>,
    /// the same before landing; `None`: where it took off
    pub landing: Option<[f64; 4]>,
}

/// Where a series comes from.
#[derive(Debug, Clone, PartialEq)]
pub enum PlannedSeries {
    /// the search
    Searched,
    /// a file, which is checked
    Stored(PathBuf),
    /// the circular validation path (44)
    Circle(Circle),
}

/// A circle at constant speed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Circle {
    /// m
    pub radius_m: f64,
    /// s a turn
    pub turn_s: f64,
    /// m; `None`: the middle of the room's
    pub height_m: Option<f64>,
}
