//! How the body moved, on one grid with the instants that count; with or without a vehicle.

use super::airborne::normalized_commands;
use crate::recording::{Quantity, Recording, Stream};
use crate::signals::{Evidence, Grid, Series, Signals, Usable, best, cubic_onto, median_period_s, usable};
use crate::units::STANDARD_GRAVITY_M_S2;
use nalgebra::Vector3;

/// Shortest and longest step of the grid, s.
const STEP_S: (f64, f64) = (0.005, 0.02);

/// Motion on a grid; SI, body FLU, world NWU.
pub(super) struct Motion {
    pub grid: Grid,
    /// airborne, exciting, not saturated, no gap
    pub usable: Vec<bool>,
    /// rad/s
    pub rate: Option<Series<Vector3<f64>>>,
    /// m/s^2 along the thrust
    pub thrust: Option<Vec<f64>>,
    /// m/s
    pub velocity: Option<Series<Vector3<f64>>>,
    /// m
    pub altitude: Option<Vec<f64>>,
}

impl From<Signals> for Motion {
    fn from(signals: Signals) -> Self {
        let thrust = thrust(
            signals.specific_force.as_ref().map(|force| force.as_slice()),
            signals.world_acceleration.as_ref().map(|acceleration| acceleration.as_slice()),
        );
        Self {
            thrust,
            altitude: signals.position.map(|position| position.iter().map(|p| p.z).collect()),
            grid: signals.grid,
            usable: signals.usable,
            rate: signals.rate,
            velocity: signals.velocity,
        }
    }
}

impl Motion {
    /// From the streams alone, by the rules of the identification; `None` where nothing measures motion.
    pub(super) fn of_recording(
        recording: &Recording,
        airborne_s: &[(f64, f64)],
        transient_s: Option<f64>,
    ) -> Option<(Self, Usable)> {
        let pick = |quantity| best(recording, quantity, |s: &Stream| s.width == 3).map(|(_, stream)| stream);
        let chosen = [
            pick(Quantity::AngularRate),
            pick(Quantity::SpecificForce),
            pick(Quantity::WorldAcceleration),
            pick(Quantity::Velocity),
            pick(Quantity::Position),
        ];
        let streams: Vec<&Stream> = chosen.iter().copied().flatten().collect();
        let step_s = median_period_s(streams.first()?).clamp(STEP_S.0, STEP_S.1);
        let start_s =
            streams.iter().filter_map(|s| s.time_s.first()).copied().fold(f64::NEG_INFINITY, f64::max);
        let end_s = streams.iter().filter_map(|s| s.time_s.last()).copied().fold(f64::INFINITY, f64::min);
        if !step_s.is_finite() || end_s - start_s < 1.0 {
            return None;
        }
        let grid = Grid::covering(start_s, end_s, step_s);
        let onto = |stream: Option<&Stream>| {
            let flat = cubic_onto(stream?, 0.0, &grid)?;
            Some(flat.chunks_exact(3).map(|v| Vector3::new(v[0], v[1], v[2])).collect::<Vec<_>>())
        };
        let [rate, specific_force, world_acceleration, velocity, position] = chosen.map(onto);
        let command = normalized_commands(recording);
        let evidence = Evidence {
            streams: &streams,
            airborne_s,
            resets_s: &recording.clock_resets_s,
            command: command.as_ref(),
            rate: rate.as_deref(),
            is_damaged: recording.is_damaged,
        };
        let (mask, used) = usable(&grid, &evidence, transient_s);
        let thrust = thrust(specific_force.as_deref(), world_acceleration.as_deref());
        let altitude = position.map(|position| position.iter().map(|p| p.z).collect());
        let (rate, velocity) = (rate.map(Series::new), velocity.map(Series::new));
        Some((Self { grid, usable: mask, rate, thrust, velocity, altitude }, used))
    }
}

/// The accelerometer's z, else the size of the world's specific force.
fn thrust(
    specific_force: Option<&[Vector3<f64>]>,
    world_acceleration: Option<&[Vector3<f64>]>,
) -> Option<Vec<f64>> {
    let up = Vector3::new(0.0, 0.0, STANDARD_GRAVITY_M_S2);
    match (specific_force, world_acceleration) {
        (Some(force), _) => Some(force.iter().map(|f| f.z).collect()),
        (None, Some(acceleration)) => Some(acceleration.iter().map(|a| (a + up).norm()).collect()),
        (None, None) => None,
    }
}
