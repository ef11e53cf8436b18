//! Looks at one window of flight after the other and keeps numbers only.

use super::airborne::{Before, airborne, normalized_commands};
use super::excitation::ExcitationTally;
use super::flown::{FlightSummary, Segment};
use super::flown_rates::FlownRates;
use super::forecast::Learnt;
use super::inspection::{Excitation, OffsetSummary};
use super::motion::Motion;
use super::off_mixer::OffMixerTally;
use crate::estimate::{Estimated, FlightApart, flights_apart};
use crate::note::Note;
use crate::recording::{Quantity, Recording};
use crate::signals::{ConditionSettings, OffMixer, Quality, Signals, SignalsError, Usable, condition};
use crate::vehicle::Vehicle;
use std::borrow::Cow;

/// Segments kept; a log with more is counted.
const KEPT_SEGMENTS: usize = 1000;
/// Flights behind one another in one log that are compared.
const KEPT_FLIGHTS: usize = 64;
/// Largest pause between two spans of one flight that the border of a window divides, s. Spans of two flights are
/// seconds apart.
const SAME_FLIGHT_S: f64 = 0.5;

/// Collects what windows of flight say.
#[derive(Debug, Default)]
pub(super) struct Assessor<'a> {
    vehicle: Option<&'a Vehicle>,
    flight: FlightSummary,
    excitation: ExcitationTally,
    rates: FlownRates,
    before: Before,
    flown: bool,
    /// the vehicle's clock restarted since the last segment
    restarted: bool,
    learnt: Option<Learnt>,
    /// of the flights between two restarts of the vehicle's clock
    of_each: Vec<Learnt>,
    anew: bool,
    offsets: Vec<OffsetSum>,
    notes: Vec<Note>,
    refusal: Option<SignalsError>,
    off_mixer: OffMixerTally,
    /// the window with the most seconds that can be used, until an output left the mixer, and these
    liveliest: Option<(f64, Recording)>,
}

/// Offsets of one quantity weighted by their precision.
#[derive(Debug)]
struct OffsetSum {
    quantity: Quantity,
    weight: f64,
    weighted_s: f64,
}

/// What all windows say.
#[derive(Debug)]
pub(super) struct Assessment {
    pub flight: FlightSummary,
    pub excitation: Option<Excitation>,
    /// of the streams in the air
    pub rates: FlownRates,
    /// estimate and covariance to expect; `None` without a vehicle or a usable window
    pub expected: Option<Estimated>,
    /// why its flights cannot be of one vehicle with one load, in words
    pub apart: Vec<String>,
    pub offsets: Vec<OffsetSummary>,
    /// what the conditioning remarked, each once
    pub notes: Vec<Note>,
    /// why the vehicle file and the log do not go together, where no window could be conditioned
    pub refusal: Option<SignalsError>,
    /// outputs that left the mixer in the air, each once
    pub off_mixer: Vec<OffMixer>,
    /// the window with the most seconds that can be used, until an output left the mixer, and these
    pub liveliest: Option<(f64, Recording)>,
}

impl Assessment {
    /// Says nothing of outputs that left the mixer: a VTOL plane's rotors stand still by design once its wings carry it.
    pub(super) fn leave_outputs_untold(&mut self) {
        self.off_mixer.clear();
        self.flight.off_mixer_s = 0.0;
    }
}

/// Refusals of one window that say nothing of the others, nor of the vehicle file.
fn is_of_the_window(refusal: &SignalsError) -> bool {
    matches!(refusal, SignalsError::NothingUsable { .. } | SignalsError::TooFewSamples { .. })
}

/// What is used of a window: until `left_s`, at which an output left the mixer; `None` where that was before it.
fn followed(recording: &Recording, left_s: Option<f64>) -> Option<Cow<'_, Recording>> {
    match left_s {
        None => Some(Cow::Borrowed(recording)),
        Some(left_s) if left_s.is_finite() => {
            let mut kept = recording.clone();
            kept.end_at(left_s);
            Some(Cow::Owned(kept))
        }
        Some(_) => None,
    }
}

impl<'a> Assessor<'a> {
    /// Nothing seen yet.
    pub(super) fn new(vehicle: Option<&'a Vehicle>) -> Self {
        Self { vehicle, ..Self::default() }
    }

    /// Looks at a window. Nothing is learnt of what comes after an output left the mixer: the command of that motor is known, and nothing
    /// is balanced any more.
    pub(super) fn window(&mut self, recording: &Recording) {
        self.restarted |= !recording.clock_resets_s.is_empty();
        self.anew |= !recording.clock_resets_s.is_empty();
        let commands = normalized_commands(recording);
        let mut airborne = airborne(recording, commands.as_ref(), &mut self.before);
        let left_s = self.off_mixer.add(recording);
        if let Some(left_s) = left_s {
            self.off_mixer.flown(recording, &mut airborne, left_s);
        }
        self.flight.airborne_from = airborne.from;
        self.rates.add(recording, &airborne.flown_s);
        if let Some(left_s) = left_s {
            self.flight.add_off_mixer(&airborne.flown_s, left_s);
        }
        let known = followed(recording, left_s);
        let motion = known.as_deref().and_then(|known| {
            let until_s = left_s.unwrap_or(f64::INFINITY);
            let before = |(start_s, end_s): &(f64, f64)| {
                (*start_s < until_s).then_some((*start_s, end_s.min(until_s)))
            };
            let free_s: Vec<(f64, f64)> = airborne.free_s.iter().filter_map(before).collect();
            self.motion(known, &free_s)
        });
        let usable_before_s = self.flight.usable_s;
        match motion {
            Some((motion, used)) => {
                self.flight.add(&used);
                self.segments(&airborne.flown_s, &motion.usable, |i| motion.grid.time_s(i));
                self.excitation.add(&motion);
            }
            None => self.segments(&airborne.flown_s, &[], |_| f64::NAN),
        }
        let usable_s = self.flight.usable_s - usable_before_s;
        if let Some(known) = known
            && usable_s > self.liveliest.as_ref().map_or(0.0, |(most_s, _)| *most_s)
        {
            self.liveliest = Some((usable_s, known.into_owned()));
        }
        self.flown |= !airborne.flown_s.is_empty();
    }

    /// How the body moved in what is used of a window, which is in the air without taking off and landing in these spans, s.
    fn motion(&mut self, recording: &Recording, free_s: &[(f64, f64)]) -> Option<(Motion, Usable)> {
        // only the first flight begins with the take-off's transient
        let transient_s = self.flown.then_some(0.0);
        let settings = ConditionSettings { transient_s, ..ConditionSettings::default() };
        let conditioned = self.vehicle.map(|vehicle| (condition(recording, vehicle, &settings), vehicle));
        match conditioned {
            Some((Ok(signals), vehicle)) => {
                self.inform(&signals, vehicle);
                let used = signals.quality.usable;
                Some((Motion::from(signals), used))
            }
            refused => {
                if let Some((Err(refusal), _)) = refused
                    && (self.refusal.is_none() || !is_of_the_window(&refusal))
                {
                    self.refusal = Some(refusal);
                }
                Motion::of_recording(recording, free_s, transient_s)
            }
        }
    }

    /// What identification would learn from the window: its own weak form, solved.
    fn inform(&mut self, signals: &Signals, vehicle: &Vehicle) {
        if let Some(learnt) = Learnt::of(signals, vehicle) {
            match &mut self.learnt {
                Some(all) => all.add(&learnt),
                None => self.learnt = Some(learnt.clone()),
            }
            let has_room = self.of_each.len() < KEPT_FLIGHTS;
            match self.of_each.last_mut().filter(|_| !std::mem::take(&mut self.anew)) {
                Some(flight) => flight.add(&learnt),
                None if has_room => self.of_each.push(learnt),
                None => {}
            }
        }
        self.note(&signals.quality);
    }

    fn note(&mut self, quality: &Quality) {
        for note in &quality.notes {
            if !self.notes.contains(note) {
                self.notes.push(note.clone());
            }
        }
        for (quantity, offset) in &quality.offsets {
            let weight = offset.std_s.powi(-2);
            if !weight.is_finite() {
                continue;
            }
            match self.offsets.iter_mut().find(|sum| sum.quantity == *quantity) {
                Some(sum) => {
                    sum.weight += weight;
                    sum.weighted_s += weight * offset.late_s;
                }
                None => self.offsets.push(OffsetSum {
                    quantity: *quantity,
                    weight,
                    weighted_s: weight * offset.late_s,
                }),
            }
        }
    }

    fn segments(&mut self, spans: &[(f64, f64)], usable: &[bool], time_s: impl Fn(usize) -> f64) {
        let step_s = if usable.len() > 1 { time_s(1) - time_s(0) } else { 0.0 };
        for &(start_s, end_s) in spans {
            let inside = |i: &usize| usable[*i] && (start_s..=end_s).contains(&time_s(*i));
            // a grid may reach half a step beyond the span
            let usable_s = ((0..usable.len()).filter(inside).count() as f64 * step_s).min(end_s - start_s);
            self.flight.airborne_s += end_s - start_s;
            self.flight.usable_s += usable_s;
            let same_flight = !std::mem::take(&mut self.restarted);
            let segments = &mut self.flight.segments;
            let kept = segments.len() < KEPT_SEGMENTS;
            match segments.last_mut() {
                Some(last) if same_flight && start_s - last.end_s < SAME_FLIGHT_S => {
                    last.end_s = end_s;
                    last.usable_s += usable_s;
                }
                _ if kept => segments.push(Segment { start_s, end_s, usable_s }),
                _ => self.flight.segments_dropped += 1,
            }
        }
    }

    /// What was collected.
    pub(super) fn finish(self) -> Assessment {
        let expected = self.learnt.as_ref().map(Learnt::combined);
        let each: Vec<Option<Estimated>> =
            self.of_each.iter().map(|learnt| Some(learnt.combined())).collect();
        let offset = |sum: &OffsetSum| OffsetSummary {
            quantity: sum.quantity.name(),
            late_s: sum.weighted_s / sum.weight,
            std_s: sum.weight.powf(-0.5),
        };
        Assessment {
            flight: self.flight,
            excitation: self.excitation.summary(),
            rates: self.rates,
            refusal: self.refusal.filter(|_| expected.is_none()),
            expected,
            apart: flights_apart(&each).iter().map(FlightApart::told).collect(),
            offsets: self.offsets.iter().map(offset).collect(),
            notes: self.notes,
            off_mixer: self.off_mixer.found(),
            liveliest: self.liveliest,
        }
    }
}
