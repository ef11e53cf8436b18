//! Thrusts of the rotors in cells of time, after lag and delay of their commands.

use super::place::{Place, STEP_S};
use crate::physics::{ActuationLatency, MAX_ROTORS, delayed_thrusts_n};
use crate::signals::Signals;
use crate::vehicle::Vehicle;

/// Grid on which thrusts are held and lagged, s: a tenth of a cell.
const FINE_S: f64 = 0.004;
/// Instants of it over which a cell is averaged.
const PER_CELL: usize = 10;
/// Cells before the first, for the lag to forget where it began.
const LEAD: usize = 25;
/// Lags for which thrusts are kept, s apart, and how many.
const LAG_STEP_S: f64 = 0.01;
/// See [`LAG_STEP_S`].
const LAGS: usize = 21;
/// Latenesses for which thrusts are kept, in steps of the fine grid.
const LATE: usize = 3;
/// The middle one of them, s.
pub const LATENESS_S: f64 = FINE_S;

/// Mean thrust of each rotor in each cell, N, by lag and lateness.
#[derive(Debug)]
pub struct CellThrusts {
    rotors: usize,
    /// by cell, rotor, lag, lateness
    thrust_n: Vec<f64>,
}

impl CellThrusts {
    /// Of `count` cells from `from_s` on. Rotors that slow down more slowly than they speed up (`uneven`) turn faster in the mean than they
    /// are commanded to: by 1 % where a controller is busy and slowing down takes twice as long.
    pub(super) fn of(
        (signals, vehicle, uneven): (&Signals, &Vehicle, f64),
        from_s: f64,
        count: usize,
    ) -> Self {
        let (rotors, factor) = (vehicle.rotors.len(), signals.thrust_factor(&vehicle.propulsion));
        let start_s = from_s - LEAD as f64 * STEP_S;
        let mut held = Vec::with_capacity((count + LEAD) * PER_CELL * rotors);
        for index in 0..(count + LEAD) * PER_CELL {
            let place = Place::of(&signals.grid, start_s + (index as f64 + 0.5) * FINE_S);
            let of = |rotor| factor * place.of_rotor(&signals.rotor_thrust_n, rotor, rotors);
            held.extend((0..rotors).map(of));
        }
        let mut thrust_n = vec![0.0; count * rotors * LAGS * LATE];
        for lag in 0..LAGS {
            let latency = ActuationLatency { delay_s: 0.0, lag_s: lag as f64 * LAG_STEP_S, uneven };
            let lagged = delayed_thrusts_n(&held, rotors, FINE_S, latency);
            for cell in 0..count {
                let first = (LEAD + cell) * PER_CELL;
                for rotor in 0..rotors {
                    let at = ((cell * rotors + rotor) * LAGS + lag) * LATE;
                    for late in 0..LATE {
                        let range = first - late..first - late + PER_CELL;
                        let sum: f64 = range.map(|index| lagged[index * rotors + rotor]).sum();
                        thrust_n[at + late] = sum / PER_CELL as f64;
                    }
                }
            }
        }
        Self { rotors, thrust_n }
    }

    /// Thrust of each rotor in a cell, N, behind a lag and a lateness of the commands, s.
    #[must_use]
    pub fn behind(&self, cell: usize, lag_s: f64, late_s: f64) -> [f64; MAX_ROTORS] {
        let place = (lag_s / LAG_STEP_S).clamp(0.0, LAGS as f64 - 1.001);
        let share = place.fract();
        let low = (1..LAGS).take_while(|lag| *lag as f64 <= place).count();
        let slope = (late_s - LATENESS_S) / (2.0 * FINE_S);
        let mut thrust_n = [0.0; MAX_ROTORS];
        for (rotor, thrust) in thrust_n.iter_mut().enumerate().take(self.rotors) {
            let at = ((cell * self.rotors + rotor) * LAGS + low) * LATE;
            let values: [f64; LATE] = std::array::from_fn(|late| {
                (1.0 - share) * self.thrust_n[at + late] + share * self.thrust_n[at + LATE + late]
            });
            *thrust = values[1] + slope * (values[2] - values[0]);
        }
        thrust_n
    }
}
