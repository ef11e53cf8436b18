//! An explanation with values that other flights tell: those of all flights together, or of all but one.

use super::by_flight::named;
use super::channels::Nuisance;
use super::explanation::Explanation;
use super::fit::Fitted;
use super::named::Named;
use super::rows::Rows;
use super::signature::EffectTerm;
use super::trace::Trace;
use crate::estimate::{INERTIA_ENTRIES, NAMES};
use nalgebra::DMatrix;

impl Explanation {
    /// The same models, `before` and `after`, with other values and standard errors: mass, moments of inertia and effects by the names of
    /// [`FlightParameter`](super::FlightParameter), SI. What is not among them stays.
    #[must_use]
    pub fn with_values(&self, before: &[(&str, (f64, f64))], after: &[(&str, (f64, f64))]) -> Self {
        let mut moved = self.clone();
        set_values(&mut moved.search.before, before);
        set_values(&mut moved.search.after, after);
        moved
    }
}

impl Explanation {
    /// The final model with the values that flights have in common, by the names of [`FlightParameter`](super::FlightParameter), SI: in its names as well.
    /// Its mass moves with them, or the thrust of a vehicle that was weighed: thrust that is less by an effect lifts less.
    #[must_use]
    pub fn with_common(&self, flights: &[Trace], values: &[(&str, (f64, f64))]) -> Self {
        let mut moved = self.with_values(&[], values);
        let step_kg = mass_step(flights, (&self.search.after, &moved.search.after));
        let base = &mut moved.search.after.base;
        let mass_kg = base.vehicle.body.mass_kg;
        if base.weighed_kg.is_some() {
            // its mass stays, and all of its thrust is more or less than it was
            base.vehicle.propulsion = base.vehicle.propulsion.scaled(mass_kg / (mass_kg + step_kg));
        } else {
            base.vehicle.body.mass_kg += step_kg;
        }
        let of = |name: &str| values.iter().find(|(known, _)| *known == name).map(|(_, estimate)| *estimate);
        let terms = &moved.search.after.base.effects;
        for effect in moved.named.iter_mut().chain(&mut moved.closest) {
            let Some(term) = terms.iter().find(|term| is_of(effect, term)) else { continue };
            for parameter in &mut effect.parameters {
                if let Some((value, std)) = of(&named(term, parameter.name)) {
                    (parameter.value, parameter.std) = (value, std);
                }
            }
        }
        moved
    }
}

/// Whether a name is that of a term of the model; of several rotors each has its own.
fn is_of(named: &Named, term: &EffectTerm) -> bool {
    let is_same = |slot: usize| {
        let name = term.parameter(slot).map(|parameter| parameter.name);
        named.parameters.iter().any(|of| Some(of.name) == name && of.value == term.values[slot])
    };
    named.id == term.id() && term.signature.role.which.is_none_or(is_same)
}

/// A Newton step of the mass by least squares of the force along body z, with all else held.
pub(super) struct MassByLift<'a> {
    /// kg beyond the mass of the rows' model by one linear step: see [`mass_after`]
    pub(super) step_kg: f64,
    /// force along body z of one kg more in each row, N/kg
    pub(super) slopes: &'a [f64],
    /// sum of their squares over the rows that were used
    pub(super) squares: f64,
}

/// `None` where the rows tell nothing of the mass.
pub(super) fn mass_by_lift<'a>(rows: &'a Rows, used: &[usize]) -> Option<MassByLift<'a>> {
    let mass = rows.nuisances.iter().find(|column| column.nuisance == Nuisance::Mass)?;
    let slopes = mass.values[2].as_slice();
    let squares: f64 = used.iter().map(|&row| slopes[row].powi(2)).sum();
    let step_kg = used.iter().map(|&row| slopes[row] * rows.residual[2][row]).sum::<f64>() / squares;
    step_kg.is_finite().then_some(MassByLift { step_kg, slopes, squares })
}

/// The mass to which a linear step about another one leads, kg, and the factor from the step's standard error to that of the mass. The
/// residual is `m K(a) - K(F)` and the column of the mass `-K(F) / m`, so that a force `F = m' K(a)` gives the step `(m' - m) m / m'`.
/// `None` where no mass gives that step.
pub(super) fn mass_after(mass_kg: f64, step_kg: f64) -> Option<(f64, f64)> {
    let left = 1.0 - step_kg / mass_kg;
    (left > 0.0).then(|| (mass_kg / left, left.powi(-2)))
}

/// By how much the mass of the flights changes, kg, where the effects have the second model's values in place of the first's: a
/// difference of two small steps. Zero where a flight tells nothing of it.
fn mass_step(flights: &[Trace], (before, after): (&Fitted, &Fitted)) -> f64 {
    let missing = |fitted: &Fitted| {
        let rows = Rows::new(flights, &fitted.base).ok()?;
        let all: Vec<usize> = (0..rows.len()).collect();
        mass_by_lift(&rows, &all).map(|of| of.step_kg)
    };
    missing(after).zip(missing(before)).map_or(0.0, |(after, before)| after - before)
}

fn set_values(fitted: &mut Fitted, values: &[(&str, (f64, f64))]) {
    let of = |name: &str| values.iter().find(|(known, _)| *known == name).map(|(_, estimate)| *estimate);
    for index in 0..fitted.rows.nuisances.len() {
        let body = &mut fitted.base.vehicle.body;
        let known = match fitted.rows.nuisances[index].nuisance {
            // a vehicle that was weighed has its mass
            Nuisance::Mass if fitted.base.weighed_kg.is_some() => None,
            Nuisance::Mass => of(NAMES[0]).inspect(|known| body.mass_kg = known.0),
            Nuisance::Inertia(entry) => {
                let (row, column) = INERTIA_ENTRIES[entry];
                let is_known = row == column && !fitted.undetermined.contains(&(1 + entry));
                let moment = is_known.then(|| of(NAMES[1 + entry])).flatten();
                moment.inspect(|known| body.inertia_kg_m2[(row, column)] = known.0)
            }
            _ => None,
        };
        if let Some((_, std)) = known {
            set_std(&mut fitted.covariance, index, std);
        }
    }
    let mut index = fitted.rows.nuisances.len();
    for present in &mut fitted.base.effects {
        for slot in present.free.clone() {
            let name = present.parameter(slot).map(|parameter| named(present, parameter.name));
            if let Some((value, std)) = name.and_then(|name| of(&name)) {
                present.values[slot] = value;
                set_std(&mut fitted.covariance, index, std);
            }
            index += 1;
        }
    }
}

/// Another standard error of one coefficient, with the correlations as they are.
fn set_std(covariance: &mut DMatrix<f64>, index: usize, std: f64) {
    let by = std / covariance[(index, index)].max(0.0).sqrt();
    if by.is_finite() && by > 0.0 {
        covariance.row_mut(index).scale_mut(by);
        covariance.column_mut(index).scale_mut(by);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of a hover with another mass: `F = m' a` in the rows of a model with `m`, and the least squares on `-F / m`.
    #[test]
    fn a_step_leads_to_the_mass_that_the_force_carries() {
        for (mass_kg, true_kg) in [(1.0, 0.75), (1.0, 1.2), (2.0, 3.0)] {
            let lift: f64 = true_kg * 9.8;
            let (residual, slope) = (mass_kg * 9.8 - lift, -lift / mass_kg);
            let (found, factor) = mass_after(mass_kg, residual / slope).unwrap();
            assert!((found - true_kg).abs() < 1e-12, "{found}");
            // of a small further force
            let more = (mass_kg * 9.8 - lift * (1.0 + 1e-6)) / slope;
            let by = (mass_after(mass_kg, more).unwrap().0 - found) / (more - residual / slope);
            assert!((by / factor - 1.0).abs() < 1e-4, "{by} {factor}");
        }
        assert!(mass_after(1.0, 1.0).is_none());
    }
}
