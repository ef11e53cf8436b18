//! The expected standard error of each quantity before a search: by the columns of its signature, at its usual size, with the
//! residual of the rigid body as noise.

use super::base::Base;
use super::candidates::Candidate;
use super::evidence::{Evidence, LEAST_FLIGHT_S, LEAST_ROWS, ROW_S, Weighted};
use super::explain::ExplainError;
use super::fit::Fitted;
use super::floors::FORM;
use super::gates::NAME_Z;
use super::latency::with_any_latency;
use super::recorded::Recorded;
use super::rows::Rows;
use super::score::columns_of;
use super::signature::{Carried, EffectTerm, Signature};
use super::signatures::{EFFECT_QUANTITIES, EffectQuantity};
use super::trace::Trace;
use crate::physics::Parameter;
use crate::signals::{Signals, WEAK_HALF_WIDTH_S};
use crate::vehicle::Vehicle;
use rayon::prelude::*;

/// How well a quantity is determined.
#[derive(Debug, Clone, PartialEq)]
pub struct ExpectedError {
    /// of which quantity
    pub quantity: &'static str,
    /// the standard error, or why there is none
    pub of: Expected,
}

/// A standard error, or why there is none.
#[derive(Debug, Clone, PartialEq)]
pub enum Expected {
    /// it is determined, however badly
    Known {
        /// the worst of its parameters
        parameter: &'static str,
        /// in the parameter's unit
        std: f64,
        /// the same over the size on ordinary vehicles
        of_usual: f64,
        /// of the parameter
        unit: &'static str,
        /// what the flights hold of it already, however badly an effect of usual size is determined
        shown: Option<SignificantAmount>,
    },
    /// a quantity that it needs is not recorded
    Lacks {
        /// which
        what: &'static str,
        /// what for
        why: &'static str,
    },
    /// measured rotor speeds contain it
    Measured,
    /// in these flights it acts as mass, inertia or the latency do
    Confused,
}

/// A parameter that stands out of the flights' own residual.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SignificantAmount {
    /// its name
    pub parameter: &'static str,
    /// standard error, in its unit
    pub std: f64,
    /// standard errors from nothing
    pub deviates: f64,
}

impl ExpectedError {
    /// Something stands out of the flights that may be this quantity.
    #[must_use]
    pub fn stands_out(&self) -> bool {
        matches!(self.of, Expected::Known { shown: Some(_), .. })
    }
}

/// How well flights determine each of [`EFFECT_QUANTITIES`].
///
/// # Errors
/// [`ExplainError`] where streams are missing or too little was flown.
pub fn expected_errors(flights: &[Signals], vehicle: &Vehicle) -> Result<Vec<ExpectedError>, ExplainError> {
    let traces: Result<Vec<Trace>, _> =
        flights.iter().map(|signals| Trace::new(signals, vehicle, WEAK_HALF_WIDTH_S)).collect();
    let traces = traces?;
    let rows: usize = traces.iter().map(Trace::rows).sum();
    if rows < LEAST_ROWS {
        let (seconds, needed_s) = (rows as f64 * ROW_S, LEAST_FLIGHT_S);
        return Err(ExplainError::TooShort { seconds, needed_s });
    }
    let (fitted, latency_std_s) = with_any_latency(&traces, Base::rigid(vehicle))?;
    let flights = Flights { traces: &traces, fitted: &fitted, vehicle };
    let of = |wanted: &EffectQuantity| ExpectedError {
        quantity: wanted.name,
        of: match wanted.signature.role.latency {
            // what is measured is behind the motors
            Some(_) if traces.iter().all(|trace| trace.measured_speeds) => Expected::Measured,
            Some(_) => {
                let lag = wanted.signature.effect.parameters().first().map(|lag| (lag, latency_std_s));
                flights.known(wanted, lag, None)
            }
            None => flights.expected(wanted),
        },
    };
    Ok(EFFECT_QUANTITIES.par_iter().map(of).collect())
}

/// Flights with the rigid body fitted to them.
struct Flights<'a> {
    traces: &'a [Trace],
    fitted: &'a Fitted,
    vehicle: &'a Vehicle,
}

impl Flights<'_> {
    fn expected(&self, wanted: &EffectQuantity) -> Expected {
        let signature = wanted.signature;
        let recorded = Recorded::new(&self.fitted.base.vehicle, self.traces);
        if let Some((_, what, why)) = recorded.lacks(signature.needs) {
            return Expected::Lacks { what, why };
        }
        let tested: Vec<(EffectTerm, Evidence, usize)> = match signature.role.wind {
            Some(carried) => carried().iter().filter_map(|carried| self.carried(carried)).collect(),
            None => {
                let forms = (signature.forms)(&recorded);
                if forms.is_empty() && recorded.all(|trace| trace.measured_speeds) {
                    return Expected::Measured;
                }
                forms.into_iter().filter_map(|form| self.alone(form.term)).collect()
            }
        };
        // a wind is seen through a drag of usual size, which these flights need not have
        let shown = signature.role.wind.is_none().then(|| significant_amount(signature, &tested)).flatten();
        self.known(wanted, worst(signature, &tested), shown)
    }

    fn known(
        &self,
        wanted: &EffectQuantity,
        worst: Option<(&'static Parameter, f64)>,
        shown: Option<SignificantAmount>,
    ) -> Expected {
        match worst {
            Some((parameter, std)) if std.is_finite() && std > 0.0 => {
                let naming = &wanted.signature.naming;
                let usual = (wanted.usual)(self.vehicle).max(f64::MIN_POSITIVE);
                let std = std.max(naming.least_std).max(naming.least).hypot(FORM * usual);
                let of_usual = std / usual;
                Expected::Known { parameter: parameter.name, std, of_usual, unit: parameter.unit, shown }
            }
            _ => Expected::Confused,
        }
    }

    /// A term by itself, with the place of its first parameter among the columns. A force of the air is tested beside the slow
    /// error of the velocity that acts through it at its usual size, as in a fit that has it.
    fn alone(&self, term: EffectTerm) -> Option<(EffectTerm, Evidence, usize)> {
        if term.signature.role.of_air {
            let mut through = term.clone();
            self.make_usual(&mut through, &term.free)?;
            let (rows, weighted) = self.beside(&through)?;
            let columns = rows.columns_of(self.traces, &self.with(&through), &term).ok()?;
            return Some((term, weighted.test(&columns)?, 0));
        }
        let columns = columns_of(self.traces, self.fitted, &Candidate::alone(term.clone()))?;
        Some((term, self.fitted.weighted.test(&columns)?, 0))
    }

    /// A term together with the one through which it acts, at the usual size of that.
    fn carried(&self, carried: &Carried) -> Option<(EffectTerm, Evidence, usize)> {
        let Carried { carrier, unit, term } = carried;
        let mut through = unit.clone();
        self.make_usual(&mut through, &carrier.free)?;
        let (rows, weighted) = self.beside(&through)?;
        let base = self.with(&through);
        let mut columns = rows.columns_of(self.traces, &base, carrier).ok()?;
        columns.extend(rows.columns_through(self.traces, &base, term).ok()?);
        Some((term.clone(), weighted.test(&columns)?, carrier.free.len()))
    }

    /// Sets these values of a term to their usual size; those without one stay. `None` where no value has one.
    fn make_usual(&self, term: &mut EffectTerm, slots: &[usize]) -> Option<()> {
        let usual = term.signature.naming.usual;
        let of = |slot: &usize| Some((*slot, usual(term.parameter(*slot)?.name, &self.fitted.base.vehicle)?));
        let known: Vec<(usize, f64)> = slots.iter().filter_map(of).collect();
        known.iter().for_each(|(slot, value)| term.values[*slot] = *value);
        (!known.is_empty()).then_some(())
    }

    /// The base with a term that is not estimated.
    fn with(&self, term: &EffectTerm) -> Base {
        let mut base = self.fitted.base.clone();
        base.effects.push(EffectTerm { free: Vec::new(), ..term.clone() });
        base
    }

    /// Rows about the base with a term, weighted as those without it.
    fn beside(&self, term: &EffectTerm) -> Option<(Rows, Weighted)> {
        let rows = Rows::new(self.traces, &self.with(term)).ok()?;
        let weighted = Weighted::like(&rows, &self.fitted.weighted);
        Some((rows, weighted))
    }
}

/// The amount that is the most standard errors from nothing, where that is enough of them.
fn significant_amount(
    signature: &Signature,
    tested: &[(EffectTerm, Evidence, usize)],
) -> Option<SignificantAmount> {
    let of = |(term, evidence, first): &(EffectTerm, Evidence, usize)| {
        let amounts = term.free.iter().enumerate().filter(|(_, slot)| signature.amounts.contains(slot));
        let amounts = amounts.filter_map(|(place, slot)| {
            let (parameter, std) = (term.parameter(*slot)?, evidence.std(first + place));
            let deviates = evidence.theta.get(first + place)?.abs() / std;
            Some(SignificantAmount { parameter: parameter.name, std, deviates })
        });
        amounts.collect::<Vec<_>>()
    };
    let all = tested.iter().flat_map(of).filter(|shown| shown.deviates.is_finite());
    all.filter(|shown| shown.deviates >= NAME_Z).max_by(|a, b| a.deviates.total_cmp(&b.deviates))
}

/// The parameter that is determined worst, and its standard error: of each parameter that of the best form, and of each
/// instance its own.
fn worst(
    signature: &Signature,
    tested: &[(EffectTerm, Evidence, usize)],
) -> Option<(&'static Parameter, f64)> {
    let mut best: Vec<(usize, Option<u64>, &'static Parameter, f64)> = Vec::new();
    for (term, evidence, first) in tested {
        let instance = signature.role.which.map(|slot| term.values[slot].to_bits());
        for (place, slot) in term.free.iter().enumerate() {
            let Some(parameter) = term.parameter(*slot) else { continue };
            let std = evidence.std(first + place);
            match best.iter_mut().find(|(known, of, ..)| (known, of) == (slot, &instance)) {
                Some((.., least)) => *least = least.min(std),
                None => best.push((*slot, instance, parameter, std)),
            }
        }
    }
    let of = |slot: usize| best.iter().filter(move |(known, ..)| *known == slot);
    // what only some of the forms have is a refinement
    let amounts =
        signature.amounts.iter().filter(|slot| tested.iter().all(|(term, ..)| term.free.contains(slot)));
    let amounts = amounts.flat_map(|slot| of(*slot));
    amounts.map(|(_, _, parameter, std)| (*parameter, *std)).max_by(|a, b| a.1.total_cmp(&b.1))
}
