//! Vehicles that differ from the others of their type.

use std::collections::BTreeMap;

use super::history::VehicleHistory;
use crate::change::pooled_mean;
use crate::diagnose::Owner;
use crate::stats::{median, normal_sigma};
use crate::trim::AXES;
use serde::Serialize;
use statrs::distribution::{ContinuousCDF, StudentsT};

/// Vehicles of a type, from which on one can differ from the others. Of fewer the spread between vehicles is hardly
/// known; the chance that is told counts it (`cargo bench --bench blind -- --vehicles --history 20 --seed 9301
/// --shuffles 1000`).
const LEAST_VEHICLES: usize = 5;
/// Information of a median and a median size over that of a mean and a standard deviation.
const EFFICIENCY: f64 = 0.37;
/// What a component of the balance is called.
const BALANCE: [&str; AXES] = ["balance along x", "balance along y", "balance about z"];

/// A vehicle that differs from the others of its type.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Outlier {
    /// its name
    pub vehicle: String,
    /// its type
    pub kind: String,
    /// in what
    pub quantity: String,
    /// unit of what follows
    pub unit: &'static str,
    /// its value
    pub value: f64,
    /// standard error of it
    pub std: f64,
    /// median of the others
    pub others: f64,
    /// standard deviation of the others
    pub spread: f64,
    /// chance that a vehicle like the others differs so much in one of all that was compared
    pub chance: f64,
}

/// A value of one vehicle.
struct Value<'a> {
    history: &'a VehicleHistory,
    unit: &'static str,
    value: f64,
    std: f64,
}

/// The vehicles that differ, the least likely first: in what is the vehicle's own, of its latest state.
#[must_use]
pub fn outliers(histories: &[VehicleHistory], chance: f64) -> Vec<Outlier> {
    let mut by_quantity: BTreeMap<(&str, String), Vec<Value<'_>>> = BTreeMap::new();
    for history in histories {
        for (quantity, unit, (value, std)) in latest(history) {
            by_quantity.entry((&history.kind, quantity)).or_default().push(Value {
                history,
                unit,
                value,
                std,
            });
        }
    }
    by_quantity.retain(|_, values| values.len() >= LEAST_VEHICLES);
    let compared: usize = by_quantity.values().map(Vec::len).sum();
    let mut found = Vec::new();
    for ((kind, quantity), values) in &by_quantity {
        for place in 0..values.len() {
            let one = of(values, place, compared);
            found.extend(one.filter(|(.., odds)| *odds < chance).map(|(others, spread, odds)| Outlier {
                vehicle: values[place].history.name.clone(),
                kind: (*kind).to_owned(),
                quantity: quantity.clone(),
                unit: values[place].unit,
                value: values[place].value,
                std: values[place].std,
                others,
                spread,
                chance: odds,
            }));
        }
    }
    found.sort_by(|a, b| a.chance.total_cmp(&b.chance));
    found
}

/// Median and spread of the others, and the chance of so large a difference in one of all comparisons.
fn of(values: &[Value<'_>], place: usize, compared: usize) -> Option<(f64, f64, f64)> {
    let others = || values.iter().enumerate().filter(|(other, _)| *other != place).map(|(_, value)| value);
    let mut sorted: Vec<f64> = others().map(|value| value.value).collect();
    let middle = median(&mut sorted);
    let mut sizes: Vec<f64> = others().map(|value| (value.value - middle).abs()).collect();
    let spread = normal_sigma(&mut sizes);
    // of the others' errors the median is as good as one is known
    let error = median(&mut others().map(|value| value.std).collect::<Vec<_>>());
    let count = sorted.len() as f64;
    let wide =
        (spread.max(error).powi(2) * (1.0 + 1.0 / (EFFICIENCY * count)) + values[place].std.powi(2)).sqrt();
    let law = StudentsT::new(0.0, 1.0, (EFFICIENCY * (count - 1.0)).max(1.0)).ok()?;
    let deviate = (values[place].value - middle).abs() / wide;
    let odds = (2.0 * law.sf(deviate) * compared as f64).min(1.0);
    deviate.is_finite().then_some((middle, spread, odds))
}

/// What a vehicle is at the end of its history: since its last change.
fn latest(history: &VehicleHistory) -> Vec<(String, &'static str, (f64, f64))> {
    let study = &history.study;
    let from = study.history.last().map_or(0, |step| step.from);
    let mut all = Vec::new();
    for (axis, name) in BALANCE.into_iter().enumerate() {
        let of = |flight: usize| {
            let flown = &study.balance.flights[flight];
            Some((flown.lean[axis], study.balance.std(flight, axis).hypot(flown.wander[axis])))
        };
        let values: Vec<_> = (from..study.flights.len()).map(of).collect();
        let common = vec![0.0; values.len()];
        all.extend(pooled_mean(&values, &common).map(|value| (name.to_owned(), "1", value)));
    }
    for track in study.tracks.iter().filter(|track| track.owner == Owner::Vehicle) {
        let value = pooled_mean(&track.values[from..], &track.common_std[from..]);
        all.extend(value.map(|value| (track.name.clone(), track.unit, value)));
    }
    all
}
