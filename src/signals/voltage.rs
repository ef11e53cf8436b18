//! The battery's voltage in the air.

use super::flight::Signals;
use super::grid::Grid;
use super::select::{LEAST_SAMPLES, best};
use crate::recording::{Quantity, Recording, Stream};

/// Voltages of a battery, V: others are no measurement.
const POSSIBLE_V: std::ops::Range<f64> = 0.1..1e3;

/// Battery voltage by linear interpolation, V; `None` where it is not recorded, or never changes.
pub(super) fn battery_voltage_v(recording: &Recording, grid: &Grid) -> Option<Vec<f64>> {
    let (_, raw) = best(recording, Quantity::BatteryVoltage, |s| s.width == 1)?;
    let known = raw.time_s.iter().zip(&raw.values).filter(|(_, volts)| POSSIBLE_V.contains(*volts));
    let (time_s, values) = known.map(|(time_s, volts)| (*time_s, *volts)).unzip();
    super::linear_onto(&Stream { time_s, width: 1, values }, 0.0, grid)
}

/// Voltage of a battery that never changes, V; `None` where it changes or is not recorded.
pub(super) fn steady_voltage_v(recording: &Recording) -> Option<f64> {
    if best(recording, Quantity::BatteryVoltage, |s| s.width == 1).is_some() {
        return None;
    }
    let streams = recording.streams.iter().filter(|(key, stream)| {
        key.quantity == Quantity::BatteryVoltage && stream.width == 1 && stream.len() >= LEAST_SAMPLES
    });
    streams.flat_map(|(_, stream)| stream.values.iter().copied()).find(|volts| POSSIBLE_V.contains(volts))
}

/// Mean voltage of the battery in the air over flights, V, each instant alike; that of a battery that never changes where none
/// changes; `None` where none of them recorded it.
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
    let steady = || flights.iter().find_map(|signals| signals.quality.steady_voltage_v);
    (count > 0.0).then(|| sum_v / count).or_else(steady)
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
    use crate::recording::StreamKey;

    #[test]
    fn a_voltage_that_never_changes_is_known_and_is_no_course() {
        let recorded = |volts: &[f64]| {
            let key = StreamKey { quantity: Quantity::BatteryVoltage, source: "BAT", instance: 0 };
            let time_s = (0..volts.len()).map(|index| index as f64).collect();
            let mut recording = Recording::default();
            recording.streams.insert(key, Stream { time_s, width: 1, values: volts.to_vec() });
            recording
        };
        let grid = Grid { start_s: 0.0, step_s: 1.0, count: 5 };
        let steady = recorded(&[12.6; 20]);
        assert_eq!((battery_voltage_v(&steady, &grid), steady_voltage_v(&steady)), (None, Some(12.6)));
        // no measurement at all
        assert_eq!(steady_voltage_v(&recorded(&[0.0; 20])), None);
        let falls: Vec<f64> = (0..20).map(|index| 16.8 - 0.1 * f64::from(index)).collect();
        let falls = recorded(&falls);
        assert_eq!(steady_voltage_v(&falls), None);
        assert!(battery_voltage_v(&falls, &grid).is_some());
    }

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
