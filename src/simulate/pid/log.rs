//! The streams of the paper's log.

use nalgebra::Vector4;
use rand::SeedableRng;
use rand_pcg::Pcg64Mcg;

use crate::physics::State;
use crate::recording::{Quantity, Recording, Stream, StreamKey};
use crate::simulate::sensors::NoiseLevels;

/// Source of the recording's streams.
pub const SOURCE: &str = "PID_SIMULATION";

/// The streams of the paper's log.
pub(super) struct Log {
    noise: Option<(NoiseLevels, Pcg64Mcg)>,
    streams: [(Quantity, Stream); 9],
}

impl Log {
    pub fn new(noise: Option<(NoiseLevels, u64)>) -> Self {
        let empty = |quantity, width| (quantity, Stream { width, ..Stream::default() });
        Self {
            noise: noise.map(|(levels, seed)| (levels, Pcg64Mcg::seed_from_u64(seed))),
            streams: [
                empty(Quantity::Position, 3),
                empty(Quantity::Velocity, 3),
                empty(Quantity::Attitude, 4),
                empty(Quantity::AngularRate, 3),
                empty(Quantity::Wrench, 4),
                empty(Quantity::PositionSetpoint, 3),
                empty(Quantity::VelocitySetpoint, 3),
                empty(Quantity::AccelerationSetpoint, 3),
                empty(Quantity::YawSetpoint, 1),
            ],
        }
    }

    pub fn sample(&mut self, time_s: f64, state: &State, (f, desired): (&Vector4<f64>, &[[f64; 5]; 4])) {
        let seen = self.noise.as_mut().map_or(*state, |(levels, rng)| levels.measure(rng, state));
        let q = seen.attitude.quaternion();
        let attitude = [q.w, q.i, q.j, q.k];
        let order = |n: usize| [desired[0][n], desired[1][n], desired[2][n]];
        let setpoints = [order(0), order(1), order(2)];
        let values = [
            seen.position_m.as_slice(),
            seen.velocity_m_s.as_slice(),
            &attitude,
            seen.rates_rad_s.as_slice(),
            f.as_slice(),
            &setpoints[0],
            &setpoints[1],
            &setpoints[2],
            &desired[3][..1],
        ];
        for ((_, stream), values) in self.streams.iter_mut().zip(values) {
            stream.time_s.push(time_s);
            stream.values.extend_from_slice(values);
        }
    }

    pub fn finish(self) -> Recording {
        let key = |quantity| StreamKey { quantity, source: SOURCE, instance: 0 };
        let streams = self.streams.into_iter().map(|(quantity, stream)| (key(quantity), stream)).collect();
        Recording { streams, ..Recording::default() }
    }
}
