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
    /// Its mass moves with them: thrust that is less by an effect lifts less.
    #[must_use]
    pub fn with_common(&self, flights: &[Trace], values: &[(&str, (f64, f64))]) -> Self {
        let mut moved = self.with_values(&[], values);
        moved.search.after.base.vehicle.body.mass_kg +=
            mass_step(flights, (&self.search.after, &moved.search.after));
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

/// The mass by least squares of the force along body z, with all else held.
pub(super) struct MassByLift<'a> {
    /// kg beyond the mass of the rows' model
    pub(super) more_kg: f64,
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
    let more_kg = used.iter().map(|&row| slopes[row] * rows.residual[2][row]).sum::<f64>() / squares;
    more_kg.is_finite().then_some(MassByLift { more_kg, slopes, squares })
}

/// By how much the mass of the flights changes, kg, where the effects have the second model's values in place of the first's. Zero for a vehicle that was weighed, and where a flight tells nothing of it.
fn mass_step(flights: &[Trace], (before, after): (&Fitted, &Fitted)) -> f64 {
    if after.base.weighed_kg.is_some() {
        return 0.0;
    }
    let missing = |fitted: &Fitted| {
        let rows = Rows::new(flights, &fitted.base).ok()?;
        let all: Vec<usize> = (0..rows.len()).collect();
        mass_by_lift(&rows, &all).map(|of| of.more_kg)
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
