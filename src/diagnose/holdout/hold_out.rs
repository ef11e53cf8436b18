//! The explained model and the rigid body on hold-out flights, and on those that were used.

use super::bootstrap::Interval;
use super::carried::{carried_over, pair_on};
use super::error::HoldoutError;
use super::holdout_fit::HoldoutFit;
use super::open_loop::OpenLoop;
use super::rate_law::RateLaw;
use super::ready::{Ready, trace_of};
use super::settings::{Explained, HeldOut, HoldoutSettings};
use super::{closed_loop, open_loop, other_vehicle, weak};
use crate::diagnose::empirical::Empirical;
use crate::note::{About, Note};
use crate::text::significant;
use crate::vehicle::Vehicle;

/// Compares the explained model with the rigid body alone on hold-out flights. `empirical` acts in addition to the
/// better model if no mechanism was found.
///
/// # Errors
/// [`HoldoutError`] where a flight lacks streams or is too short.
pub fn on_holdout(
    explained: Explained,
    flights: &[HeldOut],
    vehicle: &Vehicle,
    settings: &HoldoutSettings,
) -> Result<HoldoutFit, HoldoutError> {
    on_left_out(explained, &vec![explained; flights.len()], flights, (vehicle, settings))
}

/// The same on flights that were explained, each predicted by models `of_others` that rest on the other flights; `all` is the explanation
/// of all of them.
///
/// # Errors
/// As [`on_holdout`].
pub fn on_left_out(
    all: Explained,
    of_others: &[Explained],
    flights: &[HeldOut],
    (vehicle, settings): (&Vehicle, &HoldoutSettings),
) -> Result<HoldoutFit, HoldoutError> {
    let _stage = tracing::info_span!("predict", holdout = true, flights = flights.len()).entered();
    let Explained { explanation, empirical, .. } = all;
    let mut ready = Vec::with_capacity(flights.len());
    for (flight, explained) in flights.iter().zip(of_others) {
        let trace = trace_of(flight, vehicle, settings)?;
        let pair = carried_over(*explained, (flight, &trace), vehicle, settings)?;
        ready.push(Ready { flight, trace, pair });
    }
    if ready.is_empty() {
        return Err(HoldoutError::NoFlight);
    }
    let mut notes: Vec<Note> = ready.iter().flat_map(|ready| ready.pair.notes.clone()).collect();
    // what cannot be played back still has its residuals
    let (open_loop, improvement_percent, blocks, no_open_loop) =
        match open_loop::open_loop(&ready, empirical, settings) {
            Ok((open_loop, improvement, blocks)) => (open_loop, improvement, blocks, None),
            Err(why @ HoldoutError::Compare { .. }) => (Vec::new(), None, 0, Some(why.to_string())),
            Err(other) => return Err(other),
        };
    let weak = weak::residuals(&ready, explanation, empirical, settings)?;
    let (agreement, other_vehicle) =
        other_vehicle::judged(&ready, (explanation, of_others), &weak, settings)?;
    let closed_loop = closed_loop::flown_again(&ready, empirical, vehicle, settings);
    let improvement = improvement_percent.map(|improvement| improvement.value);
    let another = other_vehicle.is_some();
    let other_mass = ready.iter().any(|ready| ready.pair.other_mass);
    let speed_share = other_vehicle::speed_share(&ready, explanation);
    let without_empirical = empirical.map_or_else(Vec::new, |term| without(term, &mut ready, settings));
    let (as_written, note) =
        as_written(&mut ready, empirical.is_some().then_some(&*without_empirical), settings);
    notes.extend(note);
    tracing::info!(improvement_percent = improvement, blocks, other_vehicle = another, "hold-out predicted");
    notes.push(Note::remark(
        About::HoldOut,
        "noise alone (`floor` in JSON) is the error that white noise of the sensors and of the logged commands would cause with the right \
         model; noise that an autopilot's estimator has smoothed is not included",
    ));
    Ok(HoldoutFit {
        open_loop,
        without_empirical,
        as_written,
        no_open_loop,
        improvement_percent,
        weak: weak.compared,
        closed_loop,
        agreement,
        other_vehicle,
        other_mass,
        speed_share,
        notes,
    })
}

/// The errors without an empirical term, which is taken out of the models; none where nothing can be predicted.
fn without(term: &Empirical, ready: &mut [Ready], settings: &HoldoutSettings) -> Vec<OpenLoop> {
    ready.iter_mut().for_each(|ready| ready.pair.take_out(term));
    // what was shown with it stands without this, too
    open_loop::open_loop(ready, None, settings).map_or_else(|_| Vec::new(), |(open_loop, ..)| open_loop)
}

/// The errors by the model as it is written, where a flight was predicted with a load of its own, and what is said of those over 0.5 s
/// where it was predicted with more than that model: a load, or an empirical term, without which they are known.
fn as_written(
    ready: &mut [Ready],
    without_empirical: Option<&[OpenLoop]>,
    settings: &HoldoutSettings,
) -> (Vec<OpenLoop>, Option<Note>) {
    let unload = |ready: &mut Ready| ready.pair.unload(&ready.trace);
    let unloaded: Vec<bool> = ready.iter_mut().map(unload).collect();
    let is_loaded = unloaded.contains(&true);
    let with = match (is_loaded, without_empirical) {
        (false, None) => return (Vec::new(), None),
        (true, None) => "the load of each flight",
        (false, Some(_)) => "the empirical force",
        (true, Some(_)) => "the load of each flight and the empirical force",
    };
    // what was shown above stands without this, too
    let open_loop = match without_empirical.filter(|_| !is_loaded) {
        Some(known) => known.to_vec(),
        None => open_loop::open_loop(ready, None, settings).map_or_else(|_| Vec::new(), |found| found.0),
    };
    let errors = OpenLoop::half_second(&open_loop).map(OpenLoop::quantities);
    let named = errors.into_iter().flatten().zip(["m", "m/s", "rad", "rad/s"]);
    let each: Vec<String> = named
        .filter_map(|(compared, unit)| Some(format!("{} {unit}", significant(compared?.after.value, 3))))
        .collect();
    let text = format!(
        "the errors on flights that were not used are with {with}, which model.toml does not have: with model.toml as it is, they are {} over 0.5 s",
        each.join(", ")
    );
    let note = (!each.is_empty()).then(|| Note::warning(About::HoldOut, text));
    (if is_loaded { open_loop } else { Vec::new() }, note)
}

/// Open-loop prediction on the flights that were used.
#[derive(Debug, Clone)]
pub struct IdentificationFit {
    /// one entry a length of window
    pub open_loop: Vec<OpenLoop>,
    /// mean over the four quantities at 0.5 s of `100 (1 - after/before)`
    pub improvement_percent: Option<Interval>,
    /// the law of the rates that predicts instead of the torques, where these predict worse than no change
    pub rate_law: Option<RateLaw>,
}

impl IdentificationFit {
    /// The number of quantities that a state that does not change predicts better over 0.5 s, and whether rates or attitude are among
    /// them.
    fn worse(&self) -> (usize, bool) {
        let worse = OpenLoop::half_second(&self.open_loop).map_or([false; 4], OpenLoop::worse_than_unchanged);
        (worse.iter().filter(|worse| **worse).count(), worse[2] || worse[3])
    }
}

/// The same open-loop errors on the flights that were used, for comparison. Where a state that does not change predicts rates or
/// attitude better, a law of the rates is fitted, and kept if this then holds for fewer quantities.
///
/// # Errors
/// [`HoldoutError`] where a flight cannot be played back.
pub fn on_identification(
    explained: Explained,
    flights: &[HeldOut],
    vehicle: &Vehicle,
    settings: &HoldoutSettings,
) -> Result<IdentificationFit, HoldoutError> {
    let _stage = tracing::info_span!("predict", holdout = false, flights = flights.len()).entered();
    let mut ready = Vec::with_capacity(flights.len());
    for flight in flights {
        let trace = trace_of(flight, vehicle, settings)?;
        let pair = pair_on(explained, vehicle, &trace);
        ready.push(Ready { flight, trace, pair });
    }
    let shown = |ready: &[Ready], rate_law| {
        let (open_loop, improvement_percent, _) = open_loop::open_loop(ready, explained.empirical, settings)?;
        Ok::<_, HoldoutError>(IdentificationFit { open_loop, improvement_percent, rate_law })
    };
    let plain = shown(&ready, explained.rate_law)?;
    let (worse, rotation_worse) = plain.worse();
    if !rotation_worse || explained.rate_law.is_some() {
        return Ok(plain);
    }
    let Some(law) = open_loop::rate_law(&ready)? else { return Ok(plain) };
    ready.iter_mut().for_each(|ready| ready.pair.rate_law = Some(law));
    let lawful = shown(&ready, Some(law))?;
    Ok(if lawful.worse().0 < worse { lawful } else { plain })
}
