//! Result for each effect.

use super::held::{FittedForm, Held};
use super::latency::{LEAST_LAG_S, Split};
use super::requested::RequestedEffects;
use crate::diagnose::base::follows_force;
use crate::diagnose::fit::Fitted;
use crate::diagnose::gates::Gates;
use crate::diagnose::latency::FAST_MOTOR_S;
use crate::diagnose::latency::{LatencyFinding, NO_LATENCY};
use crate::diagnose::latency_parts::{held_s, stated_lag_s};
use crate::diagnose::signature::{EffectTerm, LatencyKind, Signature, Whence};
use crate::diagnose::signatures::signature_of;
use crate::diagnose::trace::Trace;
use crate::physics::{ActiveEffect, Effect, RotorLag};
use crate::stats::normal_deviate;
use crate::vehicle::Vehicle;
use nalgebra::{DMatrix, DVector};

/// Result for a parameter.
#[derive(Debug, Clone, PartialEq)]
pub enum Found {
    /// estimated
    Determined {
        /// in the parameter's unit
        value: f64,
        /// standard error, same unit
        std: f64,
    },
    /// the estimate is beyond the bound: the parameter is held at the bound
    AtBound {
        /// the bound, in the parameter's unit
        value: f64,
        /// the estimate without the bound
        unbounded: f64,
        /// its standard error
        std: f64,
    },
    /// set, not estimated
    Given {
        /// in the parameter's unit
        value: f64,
        /// origin of the value
        why: String,
    },
    /// not determined by the flight
    NotDetermined {
        /// its value in the model
        held: f64,
        /// why
        reason: String,
    },
}

impl Found {
    /// Value in the model, in the parameter's unit.
    #[must_use]
    pub fn value(&self) -> f64 {
        match self {
            Self::Determined { value, .. } | Self::AtBound { value, .. } | Self::Given { value, .. } => {
                *value
            }
            Self::NotDetermined { held, .. } => *held,
        }
    }

    /// The same multiplied by `share`.
    fn times(&self, share: f64) -> Self {
        match self.clone() {
            Self::Determined { value, std } => Self::Determined { value: share * value, std: share * std },
            Self::AtBound { value, unbounded, std } => {
                Self::AtBound { value: share * value, unbounded: share * unbounded, std: share * std }
            }
            other => other,
        }
    }
}

/// A parameter of an effect.
#[derive(Debug, Clone, PartialEq)]
pub struct ParameterFound {
    /// as in files
    pub name: &'static str,
    /// SI
    pub unit: &'static str,
    /// least and greatest plausible value
    pub plausible: (f64, f64),
    /// the result
    pub found: Found,
}

/// A requested effect.
#[derive(Debug, Clone)]
pub struct EffectFound {
    /// which
    pub effect: &'static dyn Effect,
    /// in the order of its values
    pub parameters: Vec<ParameterFound>,
    /// normal deviate of the amounts from zero, with an allowance for the number of tried forms; for a lag or delay,
    /// from that of a fast motor
    pub z: f64,
    /// forms that were tried: rotors, moments, lengths, laws
    pub tried: usize,
}

impl EffectFound {
    /// Whether it is as significant as a name requires.
    #[must_use]
    pub fn is_significant(&self) -> bool {
        signature_of(self.effect.id()).is_some_and(|signature| self.z > Gates::default().deviate(signature))
    }

    /// Emits it as a tracing event.
    pub(super) fn emit(&self) {
        let (effect, z, tried) = (self.effect.id(), self.z, self.tried);
        let significant = self.is_significant();
        tracing::info!(effect, z, tried, significant, "effect estimated");
        for ParameterFound { name, unit, found, .. } in &self.parameters {
            tracing::debug!(effect, name, unit, value = found.value(), ?found, "parameter of the effect");
        }
    }

    /// The effect for a simulation; `None` if the flight determines none of its parameters.
    #[must_use]
    pub fn acting(&self) -> Option<ActiveEffect> {
        let known = |p: &ParameterFound| matches!(p.found, Found::Determined { .. } | Found::AtBound { .. });
        let values: Vec<f64> = self.parameters.iter().map(|p| p.found.value()).collect();
        self.parameters.iter().any(known).then(|| ActiveEffect::new(self.effect, &values).ok())?
    }
}

/// All effects in the requested order. `by_mass`: factor that brings forces to the scale of a weighed mass.
pub(super) fn effects(
    (flights, vehicle): (&[Trace], &Vehicle),
    wanted: &RequestedEffects,
    (fitted, settled): (&Fitted, &[FittedForm]),
    (latency, split): (&LatencyFinding, Split),
    by_mass: Option<f64>,
) -> Vec<EffectFound> {
    let first = fitted.base.effects.len() - settled.len();
    wanted
        .signatures()
        .iter()
        .map(|&signature| {
            let place = settled.iter().position(|of| of.chosen.form.is(signature));
            match place {
                Some(place) => of_columns(fitted, first + place, &settled[place], (vehicle, wanted, by_mass)),
                None => of_latency(signature, flights, (latency, split), vehicle),
            }
        })
        .collect()
}

/// Result for an effect with columns of its own, at `place` of the base.
fn of_columns(
    fitted: &Fitted,
    place: usize,
    settled: &FittedForm,
    (vehicle, wanted, by_mass): (&Vehicle, &RequestedEffects, Option<f64>),
) -> EffectFound {
    let present = &fitted.base.effects[place];
    let before: usize = fitted.base.effects[..place].iter().map(|of| of.free.len()).sum();
    let column = |nth: usize| fitted.rows.nuisances.len() + before + nth;
    let scale = Scale { fitted, by_mass };
    let mut parameters = Vec::new();
    for (slot, &value) in present.values.iter().enumerate() {
        let Some(parameter) = present.parameter(slot) else { continue };
        let held = settled.held.iter().find(|(of, _)| *of == slot).map(|(_, held)| held.clone());
        let scaled = scale.is_scaled(parameter.unit);
        let times = if scaled { by_mass.unwrap_or(1.0) } else { 1.0 };
        let found = match (present.free.iter().position(|free| *free == slot), held) {
            (_, Some(Held::NotDetermined(reason))) => Found::NotDetermined { held: value * times, reason },
            (Some(nth), _) => {
                let std =
                    if scaled { scale.std(column(nth), value) } else { fitted_std(fitted, column(nth)) };
                Found::Determined { value: value * times, std }
            }
            (None, Some(Held::AtBound { unbounded, std })) => {
                Found::AtBound { value: value * times, unbounded: unbounded * times, std: std * times }
            }
            (None, None) => match settled.chosen.tried_std {
                Some((of, std)) if of == slot => Found::Determined { value, std },
                _ => set(present, slot, value, (vehicle, wanted)),
            },
        };
        let plausible = parameter.bounds.at(&fitted.base.size);
        parameters.push(ParameterFound { name: parameter.name, unit: parameter.unit, plausible, found });
    }
    let amounts: Vec<(usize, f64)> = present
        .free
        .iter()
        .enumerate()
        .filter(|(_, slot)| present.is_amount(**slot))
        .map(|(nth, &slot)| (column(nth), present.away_from_nothing(slot, 1.0)))
        .collect();
    let at_bound =
        |(slot, held): &&(usize, Held)| matches!(held, Held::AtBound { .. }) && present.is_amount(*slot);
    let (bounded, tried) = (settled.held.iter().filter(at_bound).count(), settled.chosen.tried);
    // held where the effect is strongest, not where it is nothing
    let strongest = settled.held.iter().filter_map(|(slot, held)| match held {
        Held::AtBound { std, .. } if present.is_amount(*slot) => {
            Some(present.away_from_nothing(*slot, *std).abs())
        }
        _ => None,
    });
    let strongest = allowed_for(strongest.fold(0.0, f64::max), tried);
    let z = deviate(fitted, &amounts, (bounded, tried)).max(strongest);
    EffectFound { effect: present.effect(), parameters, z, tried }
}

/// Result for a parameter that was neither estimated nor held, with the reason.
fn set(
    term: &EffectTerm,
    slot: usize,
    value: f64,
    (vehicle, wanted): (&Vehicle, &RequestedEffects),
) -> Found {
    match (term.signature.joint.whence)(term, slot, vehicle, wanted.signatures()) {
        Some(Whence::Given(why)) => Found::Given { value, why },
        Some(Whence::NotDetermined(reason)) => {
            Found::NotDetermined { held: value, reason: reason.to_owned() }
        }
        None => Found::Given { value, why: "as it was set".to_owned() },
    }
}

/// Result for a lag or delay, from the latency.
fn of_latency(
    signature: &'static Signature,
    flights: &[Trace],
    (latency, split): (&LatencyFinding, Split),
    vehicle: &Vehicle,
) -> EffectFound {
    let effect = signature.effect;
    let (stated_s, size) = (stated_lag_s(vehicle), &vehicle.size());
    let is_lag = signature.role.latency == Some(LatencyKind::Lag);
    let (value, least, ordinary_s) = if is_lag {
        (latency.parts.lag_s, LEAST_LAG_S, FAST_MOTOR_S)
    } else {
        // the sampled command's hold is not the vehicle's
        let fast_s = if stated_s > 0.0 || split.is_some() { 0.0 } else { FAST_MOTOR_S };
        (latency.parts.delay_s - held_s(flights), 0.0, fast_s)
    };
    let std = split.map_or(latency.std_s, |(lag, delay)| if is_lag { lag } else { delay });
    let found = if !latency.is_determined() {
        Found::NotDetermined { held: value.max(0.0), reason: NO_LATENCY.to_owned() }
    } else if value > least {
        Found::Determined { value, std }
    } else {
        Found::AtBound { value: least, unbounded: value, std }
    };
    let uneven = is_lag && latency.parts.uneven != 0.0;
    let RotorLag { rising_s, falling_s } = latency.parts.rotor_lag();
    let shares = [rising_s / latency.parts.lag_s, falling_s / latency.parts.lag_s];
    let all = effect.parameters().iter().chain(effect.finer_parameters().iter().filter(|_| uneven));
    let parameters = all
        .enumerate()
        .map(|(slot, of)| ParameterFound {
            name: of.name,
            unit: of.unit,
            plausible: of.bounds.at(size),
            found: if uneven { found.times(shares[slot]) } else { found.clone() },
        })
        .collect();
    let z = if latency.is_determined() { ((value - ordinary_s) / std).max(0.0) } else { 0.0 };
    EffectFound { effect, parameters, z, tried: 1 }
}

fn fitted_std(fitted: &Fitted, column: usize) -> f64 {
    fitted.covariance[(column, column)].max(0.0).sqrt()
}

/// Scale of forces by a weighed mass.
struct Scale<'a> {
    fitted: &'a Fitted,
    by_mass: Option<f64>,
}

impl Scale<'_> {
    fn is_scaled(&self, unit: &str) -> bool {
        self.by_mass.is_some() && follows_force(unit)
    }

    /// Standard error of `value m_w / m`.
    fn std(&self, column: usize, value: f64) -> f64 {
        self.by_mass.unwrap_or(1.0) * self.fitted.std_by_mass(column, value)
    }
}

/// Normal deviate of the amounts, given as column and distance from zero, if `bounded` further ones and `tried` forms
/// were possible: the p-value of the most likely one is at most this many times that of a single one (Bonferroni).
fn deviate(fitted: &Fitted, amounts: &[(usize, f64)], (bounded, tried): (usize, usize)) -> f64 {
    let size = amounts.len();
    let away = DVector::from_iterator(size, amounts.iter().map(|(_, away)| *away));
    let covariance = DMatrix::from_fn(size, size, |i, j| fitted.covariance[(amounts[i].0, amounts[j].0)]);
    let wald = covariance.cholesky().map_or(0.0, |factor| away.dot(&factor.solve(&away)));
    let z = if size == 0 { 0.0 } else { normal_deviate(wald, size + bounded) };
    allowed_for(z, tried)
}

/// A normal deviate with an allowance for the number of tried forms.
fn allowed_for(z: f64, tried: usize) -> f64 {
    (z * z - 2.0 * (tried.max(1) as f64).ln()).max(0.0).sqrt()
}
