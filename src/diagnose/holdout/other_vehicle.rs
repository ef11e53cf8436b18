//! Test whether the held-out flights can be of the identified vehicle.

use super::agreement::{Agreement, INERTIA_SHARE, MASS_SHARE, Relevance};
use super::difference::{Difference, OtherVehicle};
use super::error::HoldoutError;
use super::ready::{Ready, trace_of};
use super::settings::{Explained, HeldOut, HoldoutSettings};
use super::weak::Weak;
use super::what_is_left::{by_what_is_left, shows_air_of};
use crate::diagnose::channels::{CHANNEL_NAMES, Nuisance};
use crate::diagnose::common_values::mass_after;
use crate::diagnose::explanation::Explanation;
use crate::diagnose::fit::{Fitted, evaluate};
use crate::diagnose::signature::EffectTerm;
use crate::diagnose::tested::Search;
use crate::estimate::{INERTIA_ENTRIES, MOMENTS, NAMES, UNITS, depends_on_band, inertia_by_wider_window};
use crate::physics::PhysicsError;
use crate::text::with_error;
use crate::vehicle::Vehicle;

/// Least ratio of a channel's residual to the residual of the held-out flight's own fit. Set by judgement: a
/// difference of parameters counts only if the flight is predicted worse by it.
const RESIDUAL_RATIO: f64 = 1.3;

/// Compares the models with the held-out flights' own values, which come from one linear step at the transferred model. `of_each` is the
/// model that a flight was predicted by; flights of one model are compared together, those of models of their own one by one.
pub(super) fn judged(
    ready: &[Ready],
    (explanation, of_each): (&Explanation, &[Explained]),
    weak: &Weak,
    settings: &HoldoutSettings,
) -> Result<(Vec<Agreement>, Option<OtherVehicle>), PhysicsError> {
    let identified = &explanation.search.after;
    let is_one_model = of_each.iter().all(|of| std::ptr::eq(of.explanation, explanation));
    let mut all: Vec<Agreement> = Vec::new();
    for ((own, of), ready) in weak.own.iter().zip(of_each).zip(ready) {
        let found = of_flight(ready, own, &of.explanation.search);
        if is_one_model {
            let (pairs, alone) = matched(found, all);
            all = pairs.into_iter().map(|(one, all)| pooled(all, &one)).chain(alone).collect();
        } else {
            all.extend(found);
        }
    }
    let jumps: Vec<(usize, f64)> = weak
        .compared
        .iter()
        .enumerate()
        .filter_map(|(channel, compared)| {
            let compared = compared.as_ref()?;
            let ratio = compared.after.value / weak.own_rms[channel];
            (ratio > RESIDUAL_RATIO).then_some((channel, ratio))
        })
        .collect();
    // of flights that are explained together, and of those that were given their own, the load is each one's own
    let loaded = |agreement: &Agreement| (settings.own_mass || !is_one_model) && agreement.is_by_a_load();
    // in the air a body keeps its moments of inertia unless its mass changes
    let drops = all.iter().any(|agreement| agreement.name == NAMES[0] && agreement.differs());
    let kept = |agreement: &Agreement| settings.same_flight && !drops && agreement.is_of_inertia();
    let differs = |agreement: &&Agreement| agreement.differs() && !loaded(agreement) && !kept(agreement);
    let different: Vec<&Agreement> = all.iter().filter(differs).collect();
    let worst = jumps.iter().max_by(|a, b| a.1.total_cmp(&b.1));
    let whose = if settings.same_flight {
        "something changed in the part of the flight that was held back"
    } else if !is_one_model {
        "the flights are not of one vehicle"
    } else if ready.len() == 1 {
        "the hold-out is not of the vehicle that was identified"
    } else {
        "the hold-outs are not of the vehicle that was identified"
    };
    let by_parameters = worst.filter(|_| !different.is_empty()).map(|(channel, ratio)| {
        let parameters: Vec<String> = different.iter().map(|agreement| described(agreement)).collect();
        let parameters = parameters.join(", ");
        let channel = CHANNEL_NAMES[*channel];
        let reason = format!(
            "{whose}: {parameters}; the residual of {channel} is {ratio:.1} times that of its own fit"
        );
        OtherVehicle { by: Difference::Parameter(different[0].clone()), reason }
    });
    // averaged torques leave less than those of each row
    let alike = ready.iter().all(|ready| ready.trace.torques == identified.rows.compares_torques);
    let faster = speed_share(ready, explanation);
    let shows_air = settings.same_flight || shows_air_of(faster, explanation.airspeed_m_s);
    let left = || by_what_is_left(identified, (weak, alike), (faster, shows_air), whose);
    Ok((all, by_parameters.or_else(left)))
}

/// A held-out flight's own fit against the model of a search.
fn of_flight(ready: &Ready, own: &Fitted, model: &Search) -> Vec<Agreement> {
    let mut found = agreements(own, &model.after);
    keep_of_all_bands(&mut found, || [by_wider_window(ready.flight, own), model.by_wider_window]);
    found
}

/// Ixx, Iyy, Izz of a flight's rigid body by a window of twice the width, as shares of those by the usual one.
fn by_wider_window(flight: &HeldOut, own: &Fitted) -> [f64; 3] {
    inertia_by_wider_window(std::slice::from_ref(flight.signals), &own.base.vehicle)
}

/// Reason why flights should not have been explained together: the own linear step of each at the common model,
/// compared with that of the first. `None` if there is no reason.
///
/// # Errors
/// [`HoldoutError`] where a flight lacks streams or is too short.
pub fn differing(
    explanation: &Explanation,
    flights: &[HeldOut],
    vehicle: &Vehicle,
    settings: &HoldoutSettings,
) -> Result<Option<String>, HoldoutError> {
    let shared = &explanation.search.after;
    let mut first: Option<Vec<Agreement>> = None;
    for flight in flights {
        let trace = trace_of(flight, vehicle, settings)?;
        let own = agreements(&evaluate(std::slice::from_ref(&trace), shared.base.clone())?, shared);
        let Some(first) = &first else {
            first = Some(own);
            continue;
        };
        let (pairs, _) = matched(own, first.clone());
        let pairs = pairs.into_iter().map(|(own, first)| Agreement {
            identified: first.held_out,
            identified_std: first.held_out_std,
            ..own
        });
        let mut pairs: Vec<Agreement> = pairs.collect();
        keep_of_all_bands(&mut pairs, || [&flights[0], flight].map(|of| by_wider_window(of, shared)));
        let differs = |pair: &&Agreement| pair.differs() && !pair.is_by_a_load();
        let different: Vec<String> = pairs.iter().filter(differs).map(described).collect();
        if !different.is_empty() {
            return Ok(Some(format!(
                "{} and {} differ by more than flights of one vehicle do (another vehicle or battery), so the \
                 explanation may be valid for neither: {}",
                flights[0].name,
                flight.name,
                different.join(", ")
            )));
        }
    }
    Ok(None)
}

/// Moments of inertia that depend on the band of frequencies in either of both sides, by their ratios from a window of twice the width
/// (Ixx, Iyy, Izz), are not compared. The ratios are asked for where a moment differs.
fn keep_of_all_bands(found: &mut [Agreement], ratios: impl FnOnce() -> [[f64; 3]; 2]) {
    if !found.iter().any(|of| of.is_of_inertia() && of.differs()) {
        return;
    }
    let ratios = ratios();
    for (axis, moment) in MOMENTS.into_iter().enumerate() {
        if ratios.iter().any(|of| depends_on_band(of[axis])) {
            let same = |of: &&mut Agreement| of.name == NAMES[moment];
            found.iter_mut().filter(same).for_each(|of| of.relevance = None);
        }
    }
}

/// Mean speed over the rows of the held-out flights, as a share of the mean airspeed of the flights explained.
pub(super) fn speed_share(ready: &[Ready], explanation: &Explanation) -> f64 {
    let rows = || ready.iter().flat_map(|of| of.trace.centers.iter().map(|&center| &of.trace.states[center]));
    let mean_m_s = rows().map(|state| state.velocity_m_s.norm()).sum::<f64>() / rows().count().max(1) as f64;
    mean_m_s / explanation.airspeed_m_s.max(f64::MIN_POSITIVE)
}

fn described(agreement: &Agreement) -> String {
    format!(
        "{} {}{} there, {} here ({:+.0} %, {:.0} sigma)",
        agreement.name,
        with_error(agreement.held_out, agreement.held_out_std),
        if agreement.unit.is_empty() { String::new() } else { format!(" {}", agreement.unit) },
        with_error(agreement.identified, agreement.identified_std),
        100.0 * agreement.share(),
        agreement.sigmas().abs()
    )
}

/// What each value is on flights of their own: the model's, moved by what the linear steps of both differ. Where the autopilot's
/// noise is fed back the linear step is biased, and the model has its torques from instruments: the bias is the same in both.
fn agreements(own: &Fitted, identified: &Fitted) -> Vec<Agreement> {
    let (step, _) = identified.weighted.coefficients(&identified.rows);
    let moved =
        |index: usize, known: Option<usize>| own.coefficients[index] - known.map_or(0.0, |known| step[known]);
    let (body, own_body) = (&own.base.vehicle.body, own.rigid_body());
    let std = |fitted: &Fitted, index: usize| fitted.covariance[(index, index)].max(0.0).sqrt();
    let first_s = own.rows.time_s.first().copied();
    let mut out = Vec::new();
    for (index, column) in own.rows.nuisances.iter().enumerate() {
        let (name, unit, value, relevance) = match column.nuisance {
            // before a change that these rows do not hold
            Nuisance::Mass if own.base.effects.iter().any(|of| of.is_before(first_s)) => continue,
            Nuisance::Mass => (NAMES[0], UNITS[0], body.mass_kg, Relevance::share(MASS_SHARE)),
            Nuisance::Inertia(entry) => {
                let (row, column) = INERTIA_ENTRIES[entry];
                // a flight whose torque the rigid body does not explain has none of its own
                let known = !identified.undetermined.contains(&(1 + entry));
                let tells = row == column && known && own_body.explains(1 + entry);
                let principal = tells.then_some(INERTIA_SHARE).and_then(Relevance::share);
                (NAMES[1 + entry], UNITS[1 + entry], body.inertia_kg_m2[(row, column)], principal)
            }
            _ => continue,
        };
        // one of them says nothing of it: torques were not compared
        let known = identified.rows.nuisances.iter().position(|known| known.nuisance == column.nuisance);
        let Some(known) = known.filter(|&known| std(identified, known) > 0.0 && std(own, index) > 0.0) else {
            continue;
        };
        let step = moved(index, Some(known));
        let (held_out, factor) = match column.nuisance {
            Nuisance::Mass => mass_after(value, step).unwrap_or((value + step, 1.0)),
            _ => (value + step, 1.0),
        };
        out.push(Agreement {
            name: name.to_owned(),
            unit,
            identified: value,
            identified_std: std(identified, known),
            held_out,
            held_out_std: factor * std(own, index),
            relevance,
        });
    }
    let mut index = own.rows.nuisances.len();
    for (place, present) in own.base.effects.iter().enumerate() {
        for &free in &present.free {
            let Some(parameter) = present.parameter(free) else { continue };
            let known = column_of((place, present), free, identified);
            out.push(Agreement {
                name: format!("{}.{}", present.id(), parameter.name),
                unit: parameter.unit,
                identified: present.values[free],
                identified_std: known.map_or(0.0, |index| std(identified, index)),
                held_out: present.values[free] + moved(index, known),
                held_out_std: std(own, index),
                relevance: Relevance::of(present, free),
            });
            index += 1;
        }
    }
    out
}

/// Place of a parameter among the coefficients of a fit that estimates it; the effect stands at the same place in both models.
fn column_of((place, present): (usize, &EffectTerm), slot: usize, fitted: &Fitted) -> Option<usize> {
    let terms = &fitted.base.effects;
    let own = terms.get(place).filter(|term| term.id() == present.id())?;
    let before: usize = terms[..place].iter().map(|term| term.free.len()).sum();
    let index = own.free.iter().position(|free| *free == slot)?;
    Some(fitted.rows.nuisances.len() + before + index)
}

/// The parameters that two flights have in common, in pairs, and those that only one of them has: a flight whose torques are not
/// compared has no inertia. A parameter that occurs several times is paired in its order.
fn matched(
    ones: Vec<Agreement>,
    mut others: Vec<Agreement>,
) -> (Vec<(Agreement, Agreement)>, Vec<Agreement>) {
    let (mut pairs, mut alone) = (Vec::new(), Vec::new());
    for one in ones {
        match others.iter().position(|other| other.name == one.name) {
            Some(at) => pairs.push((one, others.remove(at))),
            None => alone.push(one),
        }
    }
    alone.append(&mut others);
    (pairs, alone)
}

/// Two flights' values weighted by their variances.
fn pooled(all: Agreement, one: &Agreement) -> Agreement {
    let (a, b) = (all.held_out_std.powi(-2), one.held_out_std.powi(-2));
    if !(a.is_finite() && b.is_finite() && a + b > 0.0) {
        return all;
    }
    let held_out = (all.held_out * a + one.held_out * b) / (a + b);
    Agreement { held_out, held_out_std: (a + b).powf(-0.5), ..all }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn agreement(name: &str, held_out: f64) -> Agreement {
        Agreement {
            name: name.to_owned(),
            unit: "",
            identified: 1.0,
            identified_std: 0.1,
            held_out,
            held_out_std: 0.1,
            relevance: Relevance::share(MASS_SHARE),
        }
    }

    /// A flight whose torques are not compared has no inertia between its mass and its drag.
    #[test]
    fn flights_are_compared_by_the_names_of_their_parameters() {
        let whole = vec![
            agreement("mass", 1.0),
            agreement("ixx", 2.0),
            agreement("drag", 3.0),
            agreement("drag", 4.0),
        ];
        let forces = vec![agreement("mass", 1.0), agreement("drag", 3.0), agreement("drag", 4.0)];
        let (pairs, alone) = matched(forces, whole);
        assert_eq!(pairs.len(), 3);
        assert!(pairs.iter().all(|(one, other)| one.name == other.name && one.held_out == other.held_out));
        assert_eq!(alone, [agreement("ixx", 2.0)]);
    }

    #[test]
    fn a_mean_is_weighted_by_variances() {
        let mean = pooled(agreement("mass", 1.0), &Agreement { held_out_std: 0.2, ..agreement("mass", 2.0) });
        assert!(
            (mean.held_out - 1.2).abs() < 1e-12 && (mean.held_out_std - 0.2 / 5.0_f64.sqrt()).abs() < 1e-12
        );
    }
}
