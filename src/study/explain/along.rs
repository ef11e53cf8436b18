//! Several flights: what they have in common, what is each one's own, and which flights carry a name.

use super::along_flights::{AlongFlights, is_of_one_flight};
use super::readers::for_readers;
use super::result::ExplainStudy;
use super::traces::traces_of;
use crate::diagnose::signature::Signature;
use crate::diagnose::signatures::{is_irregular, signature_of};
use crate::diagnose::{
    Apart, ExplainSettings, Explanation, NAME_Z, Named, Owner, Verdict, apart, called,
    each_with_model_of_all, explain, own_air, own_wind, relative_to_air,
};
use crate::note::{About, Note};
use crate::recording::{Quantity, Recording};
use crate::signals::Signals;
use crate::study::Track;
use crate::study::compare::are_apart;
use crate::study::flights::Prepared;
use crate::study::input::InputFile;
use crate::study::track::OF_LOG;
use crate::text::significant;
use crate::vehicle::Vehicle;
use nalgebra::Vector3;
use rayon::prelude::*;

/// Each flight as seen with its own wind, and these winds.
pub(super) fn with_own_winds(flights: &mut Prepared, vehicle: &Vehicle) -> Vec<Option<[f64; 2]>> {
    let settings = ExplainSettings::default();
    let found: Vec<Option<Vector3<f64>>> =
        flights.signals.par_iter().map(|signals| own_wind(signals, vehicle, &settings)).collect();
    for (signals, wind) in flights.signals.iter_mut().zip(&found) {
        if let Some(wind) = wind {
            *signals = relative_to_air(signals, wind);
        }
    }
    flights.drift = found.iter().map(Option::is_some).collect();
    found.into_iter().map(|wind| wind.map(|wind| [wind.x, wind.y])).collect()
}

/// The wind that each flight shows, world, m/s: none at all where its drag tells that the air stands. `None` unless every one tells it.
pub(super) fn airs(flights: &Prepared, vehicle: &Vehicle) -> Option<Vec<Vector3<f64>>> {
    let settings = ExplainSettings::default();
    flights.signals.par_iter().map(|signals| own_air(signals, vehicle, &settings)).collect()
}

/// Flights as they are seen with the difference of their winds from that of a model, world, m/s: with the model's wind, each then has its
/// own.
pub(super) fn beside_wind(flights: &Prepared, airs: &[Vector3<f64>], model_m_s: &Vector3<f64>) -> Prepared {
    let each = flights.signals.iter().zip(airs);
    Prepared {
        recordings: vec![Recording::default(); flights.signals.len()],
        signals: each.map(|(signals, air)| relative_to_air(signals, &(air - model_m_s))).collect(),
        inputs: flights.inputs.clone(),
        drift: vec![true; flights.signals.len()],
    }
}

/// Each flight with what it has its own: payload, and what one of them alone has or lacks. Returns what each shows alone, where the flights
/// are not alike.
pub(super) fn with_own(flights: &mut Prepared, vehicle: &Vehicle) -> Vec<Vec<Named>> {
    let Apart { own, alone } = apart(&flights.signals, vehicle, &ExplainSettings::default());
    flights.signals.iter_mut().zip(own).for_each(|(signals, own)| signals.own = own);
    alone
}

/// Wind that changes irregularly is each flight's own. Where no flight shows it alone, what the flights leave together is that their common
/// values do not fit, and no gust. `alone` is what each shows alone, where that is known.
pub(super) fn without_gust_of_none(
    found: Explanation,
    flights: &[Signals],
    alone: &[Vec<Named>],
    (vehicle, settings): (&Vehicle, &ExplainSettings),
) -> Explanation {
    let has_gust = |named: &[Named]| named.iter().any(|named| is_irregular(named.id));
    if flights.len() < 2 || !has_gust(&found.named) {
        return found;
    }
    let shows = |signals: &Signals| {
        let alone = explain(std::slice::from_ref(signals), vehicle, settings);
        alone.is_ok_and(|alone| has_gust(&alone.named))
    };
    let is_shown = if alone.is_empty() {
        flights.par_iter().any(shows)
    } else {
        alone.iter().any(|names| has_gust(names))
    };
    if is_shown { found } else { found.without_gust() }
}

impl ExplainStudy {
    /// Fits each flight alone to the model of all.
    pub(super) fn tell_along(
        &mut self,
        flights: &[Signals],
        mut winds_m_s: Vec<Option<[f64; 2]>>,
        alone: &[Vec<Named>],
    ) {
        let (vehicle, settings) = (&self.given.vehicle, &self.given.settings);
        let drifts: Vec<bool> = winds_m_s.iter().map(Option::is_some).collect();
        let each = each_with_model_of_all(flights, (&drifts, alone), &self.explanation, (vehicle, settings));
        let mut tracks = Track::all(each.into_iter().enumerate().collect(), flights.len(), vehicle);
        if drifts.iter().any(|drifts| *drifts) {
            // what was left of a wind belongs to it
            for (track, axis) in tracks.iter().filter_map(|track| Some((track, track.wind_axis?))) {
                for (wind, left) in winds_m_s.iter_mut().zip(&track.values) {
                    if let (Some(part), Some((left, _))) =
                        (wind.as_mut().and_then(|wind| wind.get_mut(axis)), left)
                    {
                        *part += left;
                    }
                }
            }
            tracks.retain(|track| track.wind_axis.is_none());
        }
        let of = |id: &'static str| {
            let own: Vec<&Track> = tracks.iter().filter(|track| track.effect == Some(id)).collect();
            let shows = |flight: &usize| own.iter().any(|track| track.is_shown_by(*flight));
            (id, (!own.is_empty()).then(|| (0..flights.len()).filter(shows).collect()))
        };
        let carried_by: Vec<(&'static str, Option<Vec<usize>>)> =
            self.explanation.named.iter().map(|named| of(named.id)).collect();
        let sized_by: Vec<(&'static str, Vec<usize>)> = carried_by
            .iter()
            .filter_map(|(id, carriers)| Some((*id, sized_by(id, carriers.as_deref()?, &tracks)?)))
            .collect();
        if logged_apart(flights) {
            tracks.iter_mut().for_each(|track| track.move_spread_into_errors(OF_LOG));
        }
        let mut along = AlongFlights {
            tracks,
            winds_m_s,
            carried_by,
            sized_by,
            of_one_flight: Vec::new(),
            alone: alone.to_vec(),
        };
        // one value of a parameter: in the names and in the model that of the flights together
        let each = along.tracks.iter();
        let common: Vec<(&str, (f64, f64))> =
            each.filter_map(|track| Some((track.name.as_str(), along.together(track)?))).collect();
        let traces = traces_of(flights, vehicle, settings);
        let together = self.explanation.with_common(&traces, &common);
        self.as_found = Some(Box::new(std::mem::replace(&mut self.explanation, together)));
        self.effects = for_readers(&self.explanation.named, self.explanation.airspeed_m_s);
        self.tell_payloads(flights);
        along.of_one_flight = self.names_of_one_flight(flights, alone, !along.sized_by.is_empty());
        self.tell_alone(&along);
        self.along = Some(along);
    }

    /// A remark on each name that one flight has alone.
    fn tell_alone(&mut self, along: &AlongFlights) {
        let told = self.explanation.named.iter().filter_map(|named| {
            let path = self.given.inputs[along.flight_with_alone(named.id)?].path.clone();
            let text = format!(
                "{} is this flight's alone: the model of the vehicle is without it",
                called(named.id)
            );
            Some(Note::remark(About::File(path), text))
        });
        self.notes.extend(told);
    }

    /// A remark on each held-out flight that is seen with a wind of its own.
    pub(super) fn tell_winds(&mut self, inputs: &[InputFile], winds_m_s: &[Option<[f64; 2]>]) {
        let told = inputs.iter().zip(winds_m_s).filter_map(|(input, wind)| {
            let [north, west] = (*wind)?;
            let text = format!(
                "it is predicted with its own wind, {north:.1} m/s to the north and {west:.1} m/s to the west, which is from the whole flight"
            );
            Some(Note::warning(About::File(input.path.clone()), text))
        });
        self.notes.extend(told);
    }

    /// A remark on each flight that flew with another load than the others, and a warning where it is no load that one vehicle carries.
    fn tell_payloads(&mut self, flights: &[Signals]) {
        let mass_kg = self.explanation.search.after.base.vehicle.body.mass_kg;
        for (signals, input) in flights.iter().zip(&self.given.inputs) {
            let kg = signals.own.payload_kg;
            if are_apart((mass_kg, (mass_kg + kg).max(f64::MIN_POSITIVE))) {
                let text = format!(
                    "it flew with {} kg where the others have {} kg: that is hardly a load, and it may be another vehicle",
                    significant((mass_kg + kg).max(0.0), 3),
                    significant(mass_kg, 3)
                );
                self.differing.get_or_insert_with(|| text.clone());
                self.notes.push(Note::warning(About::File(input.path.clone()), text));
            } else if kg != 0.0 {
                let text = format!(
                    "its rotors carry {} kg {} than in the others: a load, another battery, or rotors that give another thrust. That is the \
                     flight's own, and the model has the mass without it",
                    significant(kg.abs(), 2),
                    if kg > 0.0 { "more" } else { "less" }
                );
                self.notes.push(Note::remark(About::File(input.path.clone()), text));
            }
        }
    }

    /// What flights have alone where something tells that they are not alike: a part of them only carries a name, or a force is left that
    /// wanders. Where all of them together show nothing, each is asked: what one has is diluted by the others.
    fn names_of_one_flight(
        &self,
        flights: &[Signals],
        alone: &[Vec<Named>],
        differ: bool,
    ) -> Vec<(usize, Named)> {
        let wanders = || self.explanation.aperiodic.wandering().next().is_some();
        let shows_nothing = self.explanation.verdict == Verdict::NothingMissing;
        if alone.is_empty() && !differ && !shows_nothing && !wanders() {
            return Vec::new();
        }
        let (vehicle, settings) = (&self.given.vehicle, &self.given.settings);
        let explained = |signals: &Signals| {
            let alone = explain(std::slice::from_ref(signals), vehicle, settings).ok();
            let found = alone.filter(|alone| alone.verdict != Verdict::Unexplained);
            found.map_or_else(Vec::new, |found| found.named)
        };
        let each: Vec<Vec<Named>> =
            if alone.is_empty() { flights.par_iter().map(explained).collect() } else { alone.to_vec() };
        let is_new = |named: &Named| {
            let known = self.explanation.named.iter().any(|known| known.id == named.id);
            let is_of_one =
                || signature_of(named.id).is_some_and(|of| is_of_one_flight(of) && is_told_by_one(named, of));
            !known && !settings.refused.contains(&named.id) && is_of_one()
        };
        let of = |(place, names): (usize, Vec<Named>)| {
            names.into_iter().filter(is_new).map(move |named| (place, named)).collect::<Vec<_>>()
        };
        each.into_iter().enumerate().flat_map(of).collect()
    }
}

/// Standard errors by which what one flight has alone must differ from nothing: each of the flights is asked, none of them is held back
/// from it, and the others speak against it. Twice those of a name.
const ALONE_Z: f64 = 2.0 * NAME_Z;

fn is_told_by_one(named: &Named, of: &Signature) -> bool {
    let mut amounts = of.amounts.iter().filter_map(|&slot| named.get(of.effect.parameters().get(slot)?.name));
    // what is stated without an error was given, not found
    amounts.any(|amount| amount.std > 0.0 && (amount.value - of.nothing).abs() > ALONE_Z * amount.std)
}

/// Ratio of the periods of commands from which on flights are logged in different ways.
const APART: f64 = 1.5;

/// Whether flights are logged in different ways: their commands come at other rates.
fn logged_apart(flights: &[Signals]) -> bool {
    let period_s =
        |signals: &Signals| signals.grid.step_s * signals.samples_apart(Quantity::ActuatorCommand) as f64;
    let (least, most) = flights
        .iter()
        .map(period_s)
        .fold((f64::INFINITY, 0.0_f64), |(least, most), period_s| (least.min(period_s), most.max(period_s)));
    most > APART * least
}

/// The flights that tell the size of a name that differs between the flights: of what is each flight's own the one that shows it the
/// most, of what the vehicle has those that show it where the others show that they have it not. `None`: all of them.
fn sized_by(id: &str, carriers: &[usize], tracks: &[Track]) -> Option<Vec<usize>> {
    let own: Vec<&Track> = tracks.iter().filter(|track| track.effect == Some(id)).collect();
    if own.iter().all(|track| track.owner == Owner::Flight) {
        let most = |flight: usize| own.iter().map(|track| track.strength(flight)).fold(0.0, f64::max);
        return carriers
            .iter()
            .copied()
            .max_by(|a, b| most(*a).total_cmp(&most(*b)))
            .map(|flight| vec![flight]);
    }
    own.iter().any(|track| track.differs_from_others(carriers)).then(|| carriers.to_vec())
}
