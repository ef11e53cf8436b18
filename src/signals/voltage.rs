//! The battery's voltage in the air.

use super::flight::Signals;
use super::grid::Grid;

/// Mean voltage of the battery in the air over flights, V, each instant alike; `None` where none of them recorded it.
#[must_use]
pub fn airborne_voltage_v(flights: &[Signals]) -> Option<f64> {
    let of = |signals: &Signals| {
        let voltage_v = signals.battery_voltage_v.as_ref()?;
        Some(in_the_air(voltage_v, &signals.grid, &signals.quality.airborne_s))
    };
    let (sum_v, count) = flights
        .iter()
        .filter_map(of)
        .fold((0.0, 0.0), |(sum_v, count), (of_flight_v, instants)| (sum_v + of_flight_v, count + instants));
    (count > 0.0).then(|| sum_v / count)
}

/// Sum of a voltage, V, over the instants of a grid within airborne spans, s, and the number of these instants.
fn in_the_air(voltage_v: &[f64], grid: &Grid, airborne_s: &[(f64, f64)]) -> (f64, f64) {
    let is_flown = |index: usize| {
        let time_s = grid.time_s(index);
        airborne_s.iter().any(|(from_s, to_s)| (*from_s..=*to_s).contains(&time_s))
    };
    let flown = voltage_v.iter().enumerate().filter(|(index, volts)| volts.is_finite() && is_flown(*index));
    flown.fold((0.0, 0.0), |(sum_v, count), (_, volts)| (sum_v + volts, count + 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_stands_on_the_ground_does_not_count() {
        let grid = Grid { start_s: 10.0, step_s: 1.0, count: 5 };
        // instants 10 to 14 s, in the air from 11 to 13 s
        let volts = [16.8, 16.5, f64::NAN, 16.0, 16.6];
        assert_eq!(in_the_air(&volts, &grid, &[(10.5, 13.5)]), (32.5, 2.0));
        assert_eq!(in_the_air(&volts, &grid, &[]), (0.0, 0.0));
        assert_eq!(airborne_voltage_v(&[]), None);
    }
}
