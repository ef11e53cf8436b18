//! The unknowns in a parameterisation without bounds: the model is physical for all values.

use crate::diagnose::base::Base;
use crate::diagnose::channels::Nuisance;
use crate::diagnose::fit::Fitted;
use crate::estimate::{
    LogCholesky, NAMES, THETA, UNITS, inertia_of, log_cholesky, second_moments, theta_of, unpack,
};
use nalgebra::{DMatrix, DVector};

/// How an effect's parameter is written.
#[derive(Debug, Clone, Copy)]
enum Scale {
    /// `exp(x)`: from zero on
    Log,
    /// as it is
    Plain,
}

/// A free parameter of an effect.
#[derive(Debug, Clone, Copy)]
struct Slot {
    /// among the base's effects
    effect: usize,
    /// among its values
    slot: usize,
    scale: Scale,
    /// index among the free parameters of all effects
    free: usize,
}

/// The unknowns: log mass and log-Cholesky inertia, latency, and the effects' free parameters.
#[derive(Debug, Clone)]
pub(super) struct Unknowns {
    base: Base,
    start: DVector<f64>,
    floor: f64,
    slots: Vec<Slot>,
}

/// Index of the latency among the unknowns.
const LATENCY: usize = THETA;
/// Index of the first effect among the unknowns.
const EFFECTS: usize = THETA + 1;

impl Unknowns {
    /// The unknowns at a base; `None` if its inertia is not physical.
    pub(super) fn of(base: &Base) -> Option<Self> {
        let theta = theta_of(&base.vehicle.body);
        let floor = 1e-4 * second_moments(&base.vehicle.body.inertia_kg_m2).trace() / 3.0;
        let body = log_cholesky(&theta, floor)?;
        let mut slots = Vec::new();
        let mut start: Vec<f64> = body.iter().copied().collect();
        start.push(base.latency.total_s());
        let mut free = 0;
        for (effect, present) in base.present.iter().enumerate() {
            for &slot in &present.free {
                let (value, Some(parameter)) = (present.values[slot], present.parameter(slot)) else {
                    continue;
                };
                free += 1;
                // what physics holds at a bound stays there
                if present.is_at_bound(slot, &base.size) {
                    continue;
                }
                let from_zero = parameter.bounds.at(&base.size).0 >= 0.0;
                let scale = if from_zero && value > 1e-9 { Scale::Log } else { Scale::Plain };
                start.push(match scale {
                    Scale::Log => value.ln(),
                    Scale::Plain => value,
                });
                slots.push(Slot { effect, slot, scale, free: free - 1 });
            }
        }
        Some(Self { base: base.clone(), start: DVector::from_vec(start), floor, slots })
    }

    pub(super) fn len(&self) -> usize {
        self.start.len()
    }

    pub(super) fn start(&self) -> DVector<f64> {
        self.start.clone()
    }

    /// The model at a point.
    pub(super) fn base(&self, point: &DVector<f64>) -> Base {
        let mut base = self.base.clone();
        let theta = unpack(&LogCholesky::from_iterator(point.iter().take(THETA).copied()), self.floor);
        base.vehicle.body.mass_kg = theta[0];
        base.vehicle.body.inertia_kg_m2 = inertia_of(&theta);
        let latency_s = point[LATENCY];
        if base.latency.lag_s > 0.0 {
            base.latency.lag_s = (latency_s - base.latency.delay_s).max(1e-4);
        } else {
            base.latency.delay_s = latency_s;
        }
        for (index, &Slot { effect, slot, scale, .. }) in self.slots.iter().enumerate() {
            let value = match scale {
                Scale::Log => point[EFFECTS + index].exp(),
                Scale::Plain => point[EFFECTS + index],
            };
            base.present[effect].values[slot] = base.present[effect].possible(slot, value, &base.size);
        }
        base
    }

    /// The parameters themselves, SI.
    pub(super) fn natural(&self, point: &DVector<f64>) -> Vec<f64> {
        let base = self.base(point);
        let mut out: Vec<f64> = theta_of(&base.vehicle.body).iter().copied().collect();
        out.push(base.latency.total_s());
        out.extend(self.slots.iter().map(|at| base.present[at.effect].values[at.slot]));
        out
    }

    /// Slope of [`Self::natural`] by the unknowns.
    pub(super) fn slope(&self, point: &DVector<f64>) -> DMatrix<f64> {
        let size = self.len();
        let mut slope = DMatrix::zeros(size, size);
        for column in 0..size {
            let step = self.step(column);
            let (mut up, mut down) = (point.clone(), point.clone());
            up[column] += step;
            down[column] -= step;
            for (row, (a, b)) in self.natural(&up).iter().zip(self.natural(&down)).enumerate() {
                slope[(row, column)] = (a - b) / (2.0 * step);
            }
        }
        slope
    }

    /// Step of an unknown for numerical derivatives.
    pub(super) fn step(&self, index: usize) -> f64 {
        match index {
            0..=LATENCY => 1e-3,
            _ => match self.slots[index - EFFECTS].scale {
                Scale::Log => 1e-3,
                Scale::Plain => 1e-3 * self.start[index].abs().max(1e-3),
            },
        }
    }

    /// Names and units.
    pub(super) fn names(&self) -> Vec<(String, &'static str)> {
        let mut out: Vec<(String, &'static str)> =
            NAMES.iter().zip(UNITS).map(|(name, unit)| ((*name).to_owned(), unit)).collect();
        out.push(("latency".to_owned(), "s"));
        for &Slot { effect, slot, .. } in &self.slots {
            let present = &self.base.present[effect];
            let (name, unit) = present.parameter(slot).map_or(("", "-"), |of| (of.name, of.unit));
            out.push((format!("{}.{name}", present.id()), unit));
        }
        out
    }

    /// Column of the weak form for each unknown.
    pub(super) fn weak_columns(&self, fitted: &Fitted) -> Vec<Option<usize>> {
        let place =
            |wanted: Nuisance| fitted.rows.nuisances.iter().position(|column| column.nuisance == wanted);
        let mut out = vec![place(Nuisance::Mass)];
        out.extend((0..THETA - 1).map(|entry| place(Nuisance::Inertia(entry))));
        out.push(place(Nuisance::Latency));
        out.extend(self.slots.iter().map(|at| Some(fitted.rows.nuisances.len() + at.free)));
        out
    }
}
