//! Wind of each flight, and the flight in the frame of the moving air.
//!
//! The equations of motion are the same for an observer who moves at a constant velocity. Seen with the air, flights of days with
//! different winds have the vehicle's parameters in common and no wind.

use super::acceptance::started;
use super::base::Base;
use super::explain::{ExplainSettings, explain};
use super::explanation::Verdict;
use super::fit::{Fitted, Newton, fit};
use super::latency::finding_of;
use super::reconstructed::{Forms, column, reconstruct};
use super::score::test_winds;
use super::signature::EffectTerm;
use super::signatures::{ALL, CALM_M_S};
use super::tested::Search;
use super::trace::Trace;
use crate::recording::Stream;
use crate::signals::Signals;
use crate::vehicle::Vehicle;
use nalgebra::Vector3;
use std::sync::Arc;

/// A wind and its drag are believed from so many standard errors on. Set by judgement: a wind that is believed moves
/// the frame of the whole flight, so that more is asked than of a name.
const CERTAIN: f64 = 5.0;
/// Standard deviations of the flown velocity from which on a wind is far from anything that was flown, and a drag alone no sufficient
/// model of it: what the flight shows with all its effects is asked. Set by judgement.
const FAR: f64 = 3.0;

/// The steady wind along the ground, world, m/s, that a flight shows with a drag that it acts through; `None` where it shows none.
#[must_use]
pub fn own_wind(signals: &Signals, vehicle: &Vehicle, settings: &ExplainSettings) -> Option<Vector3<f64>> {
    let trace = Trace::new(signals, vehicle, settings.half_width_s).ok()?;
    if !(trace.known.velocity && trace.known.attitude && moves(&trace)) {
        return None;
    }
    let traces = [trace];
    let calm = fit(&traces, Base::anchored(vehicle), Newton::Free).ok()?;
    // by a drag of one unit both are linear: a start from no wind leads to a weak drag in a storm
    let tested = test_winds(&traces, &calm, ALL);
    let best = tested.into_iter().max_by(|a, b| a.evidence.energy.total_cmp(&b.evidence.energy))?;
    let mut base = calm.base.clone();
    base.effects = started(&best, &base.size);
    let fitted = fit(&traces, base, Newton::Free).ok().filter(|windy| windy.misfit() < calm.misfit())?;
    let by_motion = Shown::by(&fitted);
    // the autopilot's velocity wanders: a drag comes out too small by that, and the wind too large
    let mut found = Search::of(fitted, finding_of(&calm));
    let is_path = reconstruct(std::slice::from_ref(signals), &traces, (Forms::Chosen, &mut found), None);
    let by_path = is_path.unwrap_or(false).then(|| Shown::by(&found.after));
    tracing::debug!(?by_motion, ?by_path, "wind of a flight");
    let wind_m_s = by_path.unwrap_or(by_motion).wind_m_s()?;
    let is_near = wind_m_s.norm() < FAR * spread_m_s(&traces[0]);
    if is_near { Some(wind_m_s) } else { told_alone(signals, vehicle, settings) }
}

/// The same, and zero where the flight explained alone has a drag and no wind; `None` where it does not tell.
#[must_use]
pub fn own_air(signals: &Signals, vehicle: &Vehicle, settings: &ExplainSettings) -> Option<Vector3<f64>> {
    own_wind(signals, vehicle, settings).or_else(|| {
        let alone = explain(std::slice::from_ref(signals), vehicle, settings).ok()?;
        let terms = &alone.search.after.base.effects;
        let is_dragged = terms.iter().any(|term| term.signature.role.of_air);
        let is_told = is_dragged && alone.verdict != Verdict::Unexplained;
        is_told.then(|| alone.search.after.base.wind_m_s())
    })
}

/// A wind and the drag that it acts through, as a fit shows them.
#[derive(Debug)]
struct Shown {
    /// north and west, m/s
    wind_m_s: [f64; 2],
    /// one of both is certain
    blows: bool,
    /// all of it is there and certain
    is_dragged: bool,
}

impl Shown {
    /// Of a fit to a drag and a wind, in this order.
    fn by(fitted: &Fitted) -> Self {
        let sizes = |(place, present): (usize, &EffectTerm)| -> Vec<(f64, f64)> {
            let of = |&slot: &usize| {
                let index = column(fitted, place, slot)?;
                Some((present.values[slot], fitted.covariance[(index, index)].max(0.0).sqrt()))
            };
            present.free.iter().filter_map(of).collect()
        };
        let sizes: Vec<Vec<(f64, f64)>> = fitted.base.effects.iter().enumerate().map(sizes).collect();
        let is_certain = |(value, std): &(f64, f64)| value.abs() > CERTAIN * std;
        let [drag, wind] = &sizes[..] else {
            return Self { wind_m_s: [0.0; 2], blows: false, is_dragged: false };
        };
        let along = |axis: usize| wind.get(axis).map_or(0.0, |(value, _)| *value);
        Self {
            wind_m_s: [along(0), along(1)],
            blows: wind.iter().any(is_certain),
            is_dragged: drag.iter().all(|of| is_certain(of) && of.0 > 0.0),
        }
    }

    /// World, m/s, where it is certain and more than none.
    fn wind_m_s(&self) -> Option<Vector3<f64>> {
        let wind_m_s = Vector3::new(self.wind_m_s[0], self.wind_m_s[1], 0.0);
        (self.blows && self.is_dragged && wind_m_s.norm() > CALM_M_S).then_some(wind_m_s)
    }
}

/// The wind that a flight names by itself, with all else that it lacks beside it.
fn told_alone(signals: &Signals, vehicle: &Vehicle, settings: &ExplainSettings) -> Option<Vector3<f64>> {
    let alone = explain(std::slice::from_ref(signals), vehicle, settings).ok()?;
    let is_named = |term: &&EffectTerm| alone.named.iter().any(|named| named.id == term.id());
    let mut terms = alone.search.after.base.effects.iter().filter(is_named);
    let wind = terms.find(|term| term.signature.role.wind.is_some())?;
    (alone.verdict != Verdict::Unexplained).then(|| Vector3::new(wind.values[0], wind.values[1], 0.0))
}

/// Whether the flight moves by more than the error of a velocity estimate: by less, the slope of a force on the airspeed comes out too
/// small, with a standard error that is too small as well, and a wind, which is a force divided by that slope, too strong.
pub(super) fn moves(trace: &Trace) -> bool {
    spread_m_s(trace) > CALM_M_S
}

/// Standard deviation of the velocity, m/s.
fn spread_m_s(trace: &Trace) -> f64 {
    let count = trace.centers.len().max(1) as f64;
    let along = || trace.centers.iter().map(|&center| trace.states[center].velocity_m_s);
    let mean = along().sum::<Vector3<f64>>() / count;
    let spread = along().map(|velocity| (velocity - mean).norm_squared()).sum::<f64>() / count;
    spread.sqrt()
}

/// How far air that moves at `wind` (world, m/s) is after `count` steps of `step_s`, m.
#[must_use]
pub fn drift_m(wind: &Vector3<f64>, step_s: f64, count: usize) -> Vector3<f64> {
    wind * (step_s * count as f64)
}

/// The flight as seen with air that moves at `wind` (world, m/s).
#[must_use]
pub fn relative_to_air(signals: &Signals, wind: &Vector3<f64>) -> Signals {
    let mut seen = signals.clone();
    seen.air_m_s += wind;
    let moving =
        |velocity: &Arc<Vec<Vector3<f64>>>| Arc::new(velocity.iter().map(|v| v - wind).collect::<Vec<_>>());
    seen.velocity = seen.velocity.as_ref().map(moving);
    seen.position = seen.position.as_ref().map(|position| {
        let drifted =
            position.iter().enumerate().map(|(index, at)| at - drift_m(wind, signals.grid.step_s, index));
        Arc::new(drifted.collect::<Vec<_>>())
    });
    let recorded = |stream: &Arc<Stream>| {
        let values = stream.values.iter().enumerate().map(|(place, value)| value - wind[place % 3]);
        Arc::new(Stream { values: values.collect(), ..Stream::clone(stream) })
    };
    seen.as_recorded.velocity = seen.as_recorded.velocity.as_ref().map(recorded);
    seen.as_recorded.gps_velocity = seen.as_recorded.gps_velocity.as_ref().map(recorded);
    seen
}
