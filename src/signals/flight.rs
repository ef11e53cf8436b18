//! A flight on one clock and one grid.

use super::align::StreamOffset;
use super::grid::Grid;
use super::height::VelocityHeldBy;
use super::own::OwnOfFlight;
use super::rotor_thrusts::ThrustSource;
use super::torque_error::TorqueError;
use super::usable::Usable;
use crate::note::Note;
use crate::recording::{Quantity, Stream};
use crate::vehicle::Propulsion;
use nalgebra::{UnitQuaternion, Vector3, Vector4};
use std::sync::Arc;

/// Values that parts and versions of a flight have in common: a copy takes no memory.
pub type Series<T> = Arc<Vec<T>>;

/// A flight on one clock and one grid. Vectors have one entry a grid instant; SI, body FLU, world NWU.
#[derive(Debug, Clone, PartialEq)]
pub struct Signals {
    /// instants, s of the vehicle's clock
    pub grid: Grid,
    /// airborne, sufficiently excited, not saturated, no gap in a used stream
    pub usable: Vec<bool>,
    /// body to world
    pub attitude: Option<Series<UnitQuaternion<f64>>>,
    /// rad/s, body
    pub rate: Option<Series<Vector3<f64>>>,
    /// m/s^2, body
    pub specific_force: Option<Series<Vector3<f64>>>,
    /// m/s^2, world, gravity removed, where the log holds it
    pub world_acceleration: Option<Series<Vector3<f64>>>,
    /// m, world
    pub position: Option<Series<Vector3<f64>>>,
    /// m/s, world
    pub velocity: Option<Series<Vector3<f64>>>,
    /// N, one for each rotor and instant, rotor after rotor; empty if the log contains the wrench itself
    pub rotor_thrust_n: Series<f64>,
    /// N, full thrust of one rotor of the vehicle for which the thrusts, the wrench and its jitter were computed
    pub full_thrust_n: f64,
    /// `F = [Fz tau]`, N and N m, from the rotors through the nominal mixer, less half of
    /// [`Self::jitter_wrench`]
    pub wrench: Series<Vector4<f64>>,
    /// contribution of the commands' jitter to the wrench if the rotors follow all of it (N, N m); they follow a share
    /// between none and all
    pub jitter_wrench: Option<Series<Vector4<f64>>>,
    /// V; `None` where it is not recorded
    pub battery_voltage_v: Option<Series<f64>>,
    /// what was interpolated, at its own instants
    pub as_recorded: AsRecorded,
    /// commanded trajectory
    pub reference: Option<Reference>,
    /// what it has beside the vehicle's other flights
    pub own: OwnOfFlight,
    /// m/s, world: position and velocity are as seen by who moves with it, which is a flight's own wind or the part of it that a model
    /// has not; zero where they are those over the ground
    pub air_m_s: Vector3<f64>,
    /// sources and corrections
    pub quality: Quality,
}

impl Signals {
    /// Instants of the grid from one sample of a quantity's stream to the next, to the nearest; between them the grid is
    /// interpolated.
    #[must_use]
    pub fn samples_apart(&self, quantity: Quantity) -> usize {
        let rate_hz = self.quality.sources.iter().find(|(q, ..)| *q == quantity).map(|(.., rate)| *rate);
        let period_s = rate_hz.filter(|rate| *rate > 0.0).map_or(self.grid.step_s, |rate| 1.0 / rate);
        (1..1000)
            .find(|n| (f64::from(*n) + 0.5) * self.grid.step_s > period_s)
            .and_then(|n| usize::try_from(n).ok())
            .unwrap_or(1)
    }

    /// What the thrusts must be multiplied by for rotors of another full thrust.
    #[must_use]
    pub fn thrust_factor(&self, propulsion: &Propulsion) -> f64 {
        propulsion.full_thrust_n() / self.full_thrust_n
    }

    /// Emits it as tracing events.
    pub(super) fn emit(&self) {
        let (samples, step_s) = (self.grid.count, self.grid.step_s);
        let usable_s = self.usable.iter().filter(|usable| **usable).count() as f64 * step_s;
        let Quality { sources, thrust_source, offsets, .. } = &self.quality;
        for (quantity, source, rate_hz) in sources {
            tracing::debug!(?quantity, source, rate_hz, "stream chosen");
        }
        for (quantity, offset) in offsets {
            let StreamOffset { late_s, std_s, repaired } = *offset;
            tracing::debug!(?quantity, late_s, std_s, repaired, "stream aligned");
        }
        tracing::info!(samples, step_s, usable_s, thrust = ?thrust_source, "flight conditioned");
    }
}

/// Streams at their own instants, where a mean of raw samples is needed.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct AsRecorded {
    /// m/s^2, body
    pub specific_force: Option<Arc<Stream>>,
    /// m/s, world
    pub velocity: Option<Arc<Stream>>,
    /// m/s, world, raw from a satellite receiver; NaN along z where the message has no climb
    pub gps_velocity: Option<Arc<Stream>>,
}

/// The commanded trajectory on the grid, world NWU.
#[derive(Debug, Clone, PartialEq)]
pub struct Reference {
    /// m/s^2, without gravity
    pub acceleration: Series<Vector3<f64>>,
    /// the acceleration is that of commanded positions, by second differences
    pub is_of_positions: bool,
    /// rad about up
    pub yaw: Series<f64>,
    /// message that it came from
    pub message: &'static str,
}

/// Sources and corrections of the signals.
#[derive(Debug, Clone, PartialEq)]
pub struct Quality {
    /// quantity, message, samples a second
    pub sources: Vec<(Quantity, &'static str, f64)>,
    /// source of the thrusts
    pub thrust_source: ThrustSource,
    /// offsets of streams against the inertial unit
    pub offsets: Vec<(Quantity, StreamOffset)>,
    /// white noise of the gyroscopes at their own samples in the air, largest axis, rad/s; `None` where it is not known
    pub gyro_noise_rad_s: Option<f64>,
    /// airborne spans, s
    pub airborne_s: Vec<(f64, f64)>,
    /// time that each rule of the mask left out
    pub usable: Usable,
    /// commands and body rates are fast enough to compare torques with the motion; otherwise forces are compared, and torques on average
    pub torques: bool,
    /// what all torques have in common as an error
    pub torque_error: TorqueError,
    /// what holds the vertical velocity beside the accelerometer
    pub velocity_held_by: VelocityHeldBy,
    /// a satellite receiver gives the position
    pub position_by_receiver: bool,
    /// voltage of a battery that never changes, as a simulator's may, V: no effect can be told from it; `None` where it changes
    pub steady_voltage_v: Option<f64>,
    /// a simulator flew it: its parameters say that the inertial unit is simulated
    pub simulated: bool,
    /// notes for the user
    pub notes: Vec<Note>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_are_apart_by_the_nearest_number_of_instants() {
        let with = |rate_hz: f64| Signals {
            grid: Grid { start_s: 0.0, step_s: 0.004, count: 0 },
            usable: Vec::new(),
            attitude: None,
            rate: None,
            specific_force: None,
            world_acceleration: None,
            position: None,
            velocity: None,
            rotor_thrust_n: Series::default(),
            full_thrust_n: 1.0,
            wrench: Series::default(),
            jitter_wrench: None,
            battery_voltage_v: None,
            as_recorded: AsRecorded::default(),
            reference: None,
            own: OwnOfFlight::default(),
            air_m_s: Vector3::zeros(),
            quality: Quality {
                sources: vec![(Quantity::AngularRate, "by hand", rate_hz)],
                thrust_source: ThrustSource::Command,
                offsets: Vec::new(),
                gyro_noise_rad_s: None,
                airborne_s: Vec::new(),
                usable: Usable::default(),
                torques: true,
                torque_error: TorqueError::default(),
                velocity_held_by: VelocityHeldBy::default(),
                position_by_receiver: false,
                steady_voltage_v: None,
                simulated: false,
                notes: Vec::new(),
            },
        };
        // 4, 5.6, 9.5, 13, 20, 26, 40 ms
        let expected =
            [(250.0, 1), (178.0, 1), (105.0, 2), (77.0, 3), (50.0, 5), (38.0, 7), (25.0, 10), (0.0, 1)];
        for (rate_hz, apart) in expected {
            assert_eq!(with(rate_hz).samples_apart(Quantity::AngularRate), apart, "{rate_hz} Hz");
        }
        assert_eq!(with(50.0).samples_apart(Quantity::Attitude), 1);
    }
}
