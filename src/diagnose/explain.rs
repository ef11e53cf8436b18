//! The whole method: search, lack of fit, verdict.

use super::base::Base;
use super::channels::{AXES, CHANNELS};
use super::confusable::confusable_with;
use super::evidence::{LEAST_FLIGHT_S, LEAST_ROWS, ROW_S};
use super::explanation::{Explanation, Verdict};
use super::feedback_noise::is_fed_back;
use super::fit::Fitted;
use super::gates::Gates;
use super::harmonics::{LackOfFit, flown_period_s, lack_of_fit};
use super::latency_name::latency_name;
use super::limits::{limits, too_little_excitation};
use super::locate::{Aperiodic, FieldTest, GustFound, Localisation, aperiodic_of_each, field_test, localise};
use super::materiality::UNNAMED_TORQUE;
use super::named::{Confusable, Named, NamedParameter, Strength};
use super::pace::Pace;
use super::refinement::{fitted_strength, refine};
use super::rotor_axes::by_balance_alone;
use super::search::search;
use super::signature::{EffectTerm, Signature};
use super::signatures::ALL;
use super::slight::{FoundEffect, Slight, named_and_slight, stated, untold};
use super::tested::{Search, Step, Tested};
use super::torque_law::torque_law;
use super::trace::Trace;
use super::trace_error::TraceError;
use crate::physics::PhysicsError;
use crate::signals::{Signals, WEAK_HALF_WIDTH_S};
use crate::vehicle::Vehicle;

/// Settings of an explanation.
#[derive(Debug, Clone)]
pub struct ExplainSettings {
    /// s, half width of the weak form's test function
    pub half_width_s: f64,
    /// conditions of a name
    pub gates: Gates,
    /// effects that are tested; effects from outside of this library may be added to [`ALL`]
    pub signatures: &'static [&'static Signature],
    /// effects that are tested and never taken, because other flights speak against them
    pub refused: Vec<&'static str>,
}

impl Default for ExplainSettings {
    fn default() -> Self {
        Self {
            half_width_s: WEAK_HALF_WIDTH_S,
            gates: Gates::default(),
            signatures: ALL,
            refused: Vec::new(),
        }
    }
}

/// Why nothing can be explained.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ExplainError {
    /// streams are missing
    #[error(transparent)]
    Trace(#[from] TraceError),
    /// the vehicle is not physical
    #[error(transparent)]
    Physics(#[from] PhysicsError),
    /// too little flight
    #[error(
        "{:.1} s of flight can be used, at least {needed_s:.0} s are needed to tell physics from noise",
        (10.0 * .seconds).floor() / 10.0
    )]
    TooShort {
        /// s that can be used
        seconds: f64,
        /// s needed
        needed_s: f64,
    },
}

/// p-value below which power is left at the harmonics. With all conditions together, 300 of 300 clean flights came
/// out as `nothing_missing`: `cargo bench --bench explain -- --clean 300 --each 12 --pairs 12 --seed 2026112501`.
const LACK_P: f64 = 1e-6;
/// Least force that is left at the harmonics, as a share of the weight. Set by judgement; measured only together with
/// all conditions of a finding (see `Gates`).
const LACK_FORCE_G: f64 = 0.002;
/// Least torque that is left at the harmonics, as a share of the rms of the torque. On eleven flights of ArduCopter's simulator with vehicles
/// that were drafted from their parameters, 0.10 to 0.18 was left of torques whose arms and curves are guesses.
const LACK_TORQUE: f64 = UNNAMED_TORQUE;
/// Channel of the torque about body z: the last of the axes.
const TORQUE_Z: usize = AXES - 1;
/// Least share of the energy of the accepted effect that a rival must explain. Set by judgement; measured only
/// together with all conditions of a finding (see `Gates`).
const RIVAL: f64 = 0.93;

/// Explains one or more flights of a vehicle: names the physical effects that the rigid body lacks.
///
/// ```
/// # use mavid::config::load_vehicle;
/// # use mavid::log::{self, OpenOptions};
/// # use mavid::signals::{ConditionSettings, condition};
/// use mavid::diagnose::{ExplainSettings, clause, explain};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// # let fixtures = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures");
/// # let log = log::open(&fixtures.join("p04_identify_10_22s.tlog"), &OpenOptions::default())?;
/// # let vehicle = load_vehicle(&fixtures.join("p04_vehicle.toml"))?;
/// let signals = condition(&log.recording, &vehicle, &ConditionSettings::default())?;
/// let explanation = explain(&[signals], &vehicle, &ExplainSettings::default())?;
/// // the rotors of this flight follow their commands with a lag of 60 ms
/// let named: Vec<_> = explanation.named.iter().map(|named| named.id).collect();
/// assert_eq!(named, ["motor_lag"]);
/// println!("{}.", clause(&explanation.named[0], &vehicle));
/// # Ok(())
/// # }
/// ```
///
/// # Errors
/// [`ExplainError`] where streams are missing or too little was flown.
pub fn explain(
    flights: &[Signals],
    vehicle: &Vehicle,
    settings: &ExplainSettings,
) -> Result<Explanation, ExplainError> {
    explain_watched(flights, vehicle, settings, &|_, _| {})
}

/// The same, and `tell` is told the rounds of the search that are done, and how many there may be: their number is not known
/// beforehand.
///
/// # Errors
/// Those of [`explain`].
pub fn explain_watched(
    flights: &[Signals],
    vehicle: &Vehicle,
    settings: &ExplainSettings,
    tell: &dyn Fn(u64, u64),
) -> Result<Explanation, ExplainError> {
    let _stage = tracing::info_span!("explain", flights = flights.len()).entered();
    let trace = |signals| Trace::new(signals, vehicle, settings.half_width_s);
    let traces: Vec<Trace> = flights.iter().map(trace).collect::<Result<_, _>>()?;
    let rows: usize = traces.iter().map(Trace::rows).sum();
    if rows < LEAST_ROWS {
        let (seconds, needed_s) = (rows as f64 * ROW_S, LEAST_FLIGHT_S);
        return Err(ExplainError::TooShort { seconds, needed_s });
    }
    let mut pace = Pace::new(tell);
    let mut refused = settings.refused.clone();
    let found = loop {
        let mut found =
            search(&traces, vehicle, &settings.gates, (settings.signatures, &refused, &mut pace))?;
        refine((flights, &traces), vehicle, (&mut found, &refused, &mut pace))?;
        // what its size does not tell from nothing stood in the place of another one, and what only the torques show as well
        let untold = untold(&found.after, &found.by_other_law).into_iter();
        let misplaced = found.misplaced.iter().copied().chain(by_balance_alone(&traces, vehicle, &found));
        match untold.chain(misplaced).find(|id| !refused.contains(id)) {
            Some(id) => {
                tracing::debug!(effect = id, "explained again without it");
                refused.push(id);
            }
            None => break found,
        }
    };
    let beyond = tracing::info_span!("locate").in_scope(|| beyond(&traces, &found));
    let explanation = judge(&traces, vehicle, found, beyond);
    explanation.emit();
    Ok(explanation)
}

/// The residual after all names, with its localisation.
struct Beyond {
    lack: Option<LackOfFit>,
    located_before: Option<Localisation>,
    located_after: Option<Localisation>,
    field: Option<FieldTest>,
    aperiodic: Aperiodic,
}

fn beyond(traces: &[Trace], found: &Search) -> Beyond {
    let (located_before, located_after) =
        rayon::join(|| localise(traces, &found.before), || localise(traces, &found.after));
    let aperiodic = located_after
        .as_ref()
        .map_or_else(Aperiodic::default, |located| aperiodic_of_each(traces, &found.after, located));
    Beyond {
        lack: lacks(traces, &found.after),
        field: field_test(
            traces,
            (&found.before, &found.after),
            (explained_energy(found), &aperiodic.redness),
        ),
        aperiodic,
        located_before,
        located_after,
    }
}

/// The harmonic test on each periodic flight: the most significant result, with the excess energy of all flights.
fn lacks(traces: &[Trace], fitted: &Fitted) -> Option<LackOfFit> {
    let (rows, left) = (fitted.rows.len(), fitted.weighted.left.as_slice());
    let mut from = 0;
    let mut worst: Option<LackOfFit> = None;
    let mut excess = 0.0;
    for trace in traces {
        let to = from + trace.rows();
        let time_s = &fitted.rows.time_s[from..to];
        if let Some(period_s) = flown_period_s(trace, time_s) {
            let residual: [&[f64]; CHANNELS] =
                std::array::from_fn(|channel| &left[channel * rows + from..channel * rows + to]);
            let found = lack_of_fit(time_s, residual, period_s);
            excess += found.as_ref().map_or(0.0, |found| found.excess_energy);
            if let Some(found) = found
                && worst.as_ref().is_none_or(|worst| found.p_least() < worst.p_least())
            {
                worst = Some(found);
            }
        }
        from = to;
    }
    worst.map(|worst| LackOfFit { excess_energy: excess, ..worst })
}

/// Whether the power at the harmonics of these axes is significant and large enough to matter.
fn is_lacking(lack: &LackOfFit, fitted: &Fitted, mut axes: impl Iterator<Item = usize>) -> bool {
    axes.any(|channel| {
        let size = lack.excess_rms[channel] * fitted.weighted.sigma[channel];
        let least = if channel < 3 {
            LACK_FORCE_G * fitted.weight_n()
        } else {
            LACK_TORQUE * fitted.rows.torque_rms[channel - 3]
        };
        lack.p_value[channel] * (AXES as f64) < LACK_P && size > least
    })
}

/// Verdict and names.
fn judge(traces: &[Trace], vehicle: &Vehicle, found: Search, beyond: Beyond) -> Explanation {
    let Beyond { lack, located_before, located_after, field, aperiodic } = beyond;
    let (mut named, mut slight) = names(traces, &found);
    let limits = limits(traces, &found.last, &found.after);
    let too_little_excitation = too_little_excitation(&found.after, &limits);
    let turned_by_control = too_little_excitation && is_fed_back(traces);
    named.extend(latency_name(traces, vehicle, &found).filter(|_| !turned_by_control));
    match aperiodic.gust.as_ref().and_then(|gust| Some((gust_name(gust)?, gust.is_slight()))) {
        Some((effect, true)) => slight.push(Slight { effect, materiality: None }),
        Some((effect, false)) => named.push(effect),
        None => {}
    }
    let a_field = field.as_ref().is_some_and(|field| field.certain);
    // what is large only of a torque that hardly anything took, or that commands too far apart give, is noise
    let by_forces = too_little_excitation || traces.iter().any(|trace| !trace.torques);
    let (axes, aperiodic) = if by_forces { (0..3, aperiodic.of_forces()) } else { (0..AXES, aperiodic) };
    let torque_law_after = torque_law(traces, &found.after);
    // that the torque does not go with the thrust is a finding of its own, and what it leaves about z has its cause
    let has_cause = |channel: &usize| *channel == TORQUE_Z && torque_law_after.is_some();
    let axes = axes.filter(|channel| !has_cause(channel));
    let lacking = lack.as_ref().is_some_and(|lack| is_lacking(lack, &found.after, axes))
        || a_field
        || aperiodic.is_lacking();
    let excess = lack.as_ref().map_or(0.0, |lack| lack.excess_energy);
    let explained = explained_energy(&found);
    // a field of the room that alone explains more leaves the names nothing
    let beaten = field.as_ref().is_some_and(|field| field.beats_named);
    let verdict = match (named.is_empty(), lacking) {
        (true, false) => Verdict::NothingMissing,
        (true, true) => Verdict::Unexplained,
        (false, _) if beaten => Verdict::Unexplained,
        (false, false) => Verdict::Explained,
        (false, true) if excess > explained => Verdict::Unexplained,
        (false, true) => Verdict::PartlyExplained,
    };
    let closest = if verdict == Verdict::Unexplained { std::mem::take(&mut named) } else { Vec::new() };
    let torque_law_alone = torque_law(traces, &found.before);
    // what serves as no explanation is not in the model
    let torque_law = if verdict == Verdict::Unexplained { torque_law_alone } else { torque_law_after };
    Explanation {
        verdict,
        named,
        slight,
        closest,
        limits,
        too_little_excitation,
        turned_by_control,
        lack_of_fit: lack,
        located_before,
        located_after,
        field,
        aperiodic,
        airspeed_m_s: mean_airspeed_m_s(traces, &found.after.base),
        torque_law,
        torque_law_alone,
        search: found,
    }
}

/// Mean airspeed over the rows of all flights, m/s.
fn mean_airspeed_m_s(traces: &[Trace], base: &Base) -> f64 {
    let wind_m_s = base.wind_m_s();
    let rows =
        || traces.iter().flat_map(|trace| trace.centers.iter().map(move |&center| &trace.states[center]));
    rows().map(|state| (state.velocity_m_s - wind_m_s).norm()).sum::<f64>() / rows().count().max(1) as f64
}

/// The name of a gust. The search does not test gusts; their size and correlation time come from the residual.
fn gust_name(gust: &GustFound) -> Option<Named> {
    let effect = ALL.iter().find(|signature| signature.joint.irregular.is_some())?.effect;
    let values = [(gust.sigma_m_s, gust.sigma_std_m_s), (gust.correlation_s, gust.correlation_std_s)];
    let parameters = effect.parameters().iter().zip(values);
    let parameters = parameters
        .map(|(parameter, (value, std))| NamedParameter {
            name: parameter.name,
            value,
            std,
            unit: parameter.unit,
        })
        .collect();
    let z = gust.statistic.max(0.0).sqrt();
    let strength = Strength { z, gain: 0.0, energy: gust.statistic, count: 2 };
    Some(Named {
        id: effect.id(),
        sentence: effect.sentence(),
        parameters,
        strength,
        confusable_with: Vec::new(),
    })
}

/// Energy that the accepted effects explain, in sigma squared of the final residual.
fn explained_energy(found: &Search) -> f64 {
    let (before, after) = (&found.before.weighted, &found.after.weighted);
    let scale = found.after.base.scale_over(&found.before.base);
    let rows = |channel: usize| found.after.rows.count_of(channel) as f64;
    let ratio = |channel: usize| scale * before.sigma[channel] / after.sigma[channel];
    (0..AXES)
        .filter(|&channel| after.sigma[channel] > 0.0)
        .map(|channel| rows(channel) * (ratio(channel).powi(2) - 1.0))
        .sum()
}

/// A name for each accepted effect that matters, and the others.
fn names(traces: &[Trace], found: &Search) -> (Vec<Named>, Vec<Slight>) {
    let fitted = &found.after;
    let mut index = fitted.rows.nuisances.len();
    let mut found_effects = Vec::new();
    for (place, present) in fitted.base.effects.iter().enumerate() {
        let (first, parameters) = (index, stated(fitted, present, index));
        index += present.free.len();
        let step = found
            .steps
            .iter()
            .find(|step| step.taken.candidate.parts.iter().any(|part| part.is(present.signature)));
        let effect = Named {
            id: present.id(),
            sentence: present.effect().sentence(),
            parameters,
            strength: step.map_or_else(|| fitted_strength(fitted, present, first), strength),
            confusable_with: step.map_or_else(Vec::new, |step| confusable(traces, found, place, step)),
        };
        found_effects.push(FoundEffect { effect, place, columns: first..index });
    }
    named_and_slight((fitted, &found.by_other_law), found_effects, found.laws_by_path)
}

fn strength(step: &Step) -> Strength {
    let evidence = &step.taken.evidence;
    Strength { z: evidence.z, gain: evidence.gain, energy: evidence.energy, count: evidence.theta.len() }
}

/// Effects that explain as much, or that this flight cannot distinguish from it.
fn confusable(traces: &[Trace], found: &Search, place: usize, step: &Step) -> Vec<Confusable> {
    let close = |rival: &&Tested| rival.evidence.energy > RIVAL * step.taken.evidence.energy;
    let rivals: Vec<&Tested> = step.rivals.iter().filter(close).collect();
    let mut all = confusable_with(traces, &found.after, place, (&found.last, &rivals));
    let terms = &found.after.base.effects;
    // along the rotor axis it is the same term as that of another effect, which the model has along the others only, or not at all
    let has_axis = |of: &EffectTerm| of.signature.role.axial.is_some_and(|slot| of.free.contains(&slot));
    let is_new = |id: &str| all.iter().all(|of| of.id != id);
    if let Some(whole) = terms[place].signature.role.axial_part_of
        && !terms.iter().any(|of| of.id() == whole.id() && has_axis(of))
        && is_new(whole.id())
    {
        all.insert(0, Confusable { id: whole.id(), distinguishability: Some(0.0) });
    }
    all
}
