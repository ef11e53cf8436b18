//! The result of identifying: what went in, the estimates, and what is to be known of them.

use super::joint_estimate::{
    Found, joint_estimate, with_kept_about_z, without_inertia, without_undetermined,
};
use crate::diagnose::joint::JointEstimate;
use crate::diagnose::signature::Signature;
use crate::diagnose::signatures::signature_of;
use crate::diagnose::{CHANNEL_NAMES, GyroscopicShare, TorqueLaw};
use crate::estimate::{
    Contradiction, EstimateError, Identification, IdentifySettings, Method, MethodResult, Nominal,
    ThrustScale, apply_anchor, contradictions, identify, rests_on_guessed_curve,
};
use crate::note::{About, Note};
use crate::signals::{Quality, Signals};
use crate::study::doubts::{TWO_VEHICLES, doubts};
use crate::study::{Correlation, InputFile};
use crate::vehicle::Vehicle;

/// The whole answer.
#[derive(Debug)]
pub struct IdentifyStudy {
    /// nominal
    pub vehicle: Vehicle,
    /// as they were identified from
    pub flights: Vec<Signals>,
    /// their files
    pub inputs: Vec<InputFile>,
    /// by each method; the recommended one has what the flights show beside mass and inertia in its model
    pub identification: Identification,
    /// identifiers of the effects that the recommended method has in its model
    pub beside: Vec<&'static str>,
    /// where a simulator leaves the gyroscopic torque out
    pub gyroscopic: Option<GyroscopicShare>,
    /// where the rotors' torque certainly does not go with their thrust
    pub torque_law: Option<TorqueLaw>,
    /// kg m^2, of the model, where it has izz from the vehicle file because flights tell only its ratio to the torque per thrust; that
    /// follows it, in `vehicle`
    pub about_z_kg_m2: Option<f64>,
    /// where the mass was weighed
    pub scale: Option<ThrustScale>,
    /// effects that were identified together with the rigid body
    pub with: Option<WithEffects>,
    /// what is to be known of the vehicle's file
    pub notes: Vec<Note>,
    /// flights that cannot be of one vehicle with one load
    pub disagree: bool,
}

/// Effects that were identified together with the rigid body.
#[derive(Debug, Clone)]
pub struct WithEffects {
    /// what was found
    pub joint: JointEstimate,
    /// where the signals come from, flight by flight
    pub quality: Vec<Quality>,
}

/// What the equations of one channel leave, root mean square.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Misfit {
    /// as in [`CHANNEL_NAMES`]
    pub name: &'static str,
    /// N or N m
    pub unit: &'static str,
    /// of the rigid body alone
    pub without: f64,
    /// with the effects
    pub with: f64,
}

impl WithEffects {
    /// What is left of each channel that was used.
    #[must_use]
    pub fn misfits(&self) -> Vec<Misfit> {
        let channels = CHANNEL_NAMES.into_iter().zip(self.joint.misfit());
        let known = channels.filter_map(|(name, misfit)| {
            let (without, with) = misfit?;
            let unit = if name.starts_with("torque") { "N m" } else { "N" };
            Some(Misfit { name, unit, without, with })
        });
        known.collect()
    }
}

/// Widens the errors of a rigid body alone, where no effects could be searched beside it, and says why.
fn rigid_body_alone(identification: &mut Identification, vehicle: &Vehicle, why: &str) {
    let Identification { methods, best, notes, .. } = identification;
    best.widen(&Nominal::of(vehicle));
    let of_best = methods.iter_mut().filter(|result| result.method == best.method);
    of_best.for_each(|result| result.clone_from(&best.result));
    let text =
        format!("mass and inertia of a rigid body alone, without a search of effects beside them: {why}");
    notes.push(Note::remark(About::Estimate, text));
}

impl IdentifyStudy {
    /// Mass and inertia from signals and the files that they came from. `explained` are the same flights as `explain` conditions them:
    /// no part of them is held back.
    ///
    /// # Errors
    /// [`EstimateError`] where no method can run.
    pub fn of_signals(
        flights: Vec<Signals>,
        inputs: Vec<InputFile>,
        vehicle: Vehicle,
        settings: &IdentifySettings,
        explained: &[Signals],
    ) -> Result<Self, EstimateError> {
        let found = Found::in_whole(explained, &vehicle);
        Self::of_found(flights, inputs, vehicle, settings, &found)
    }

    /// The same with what `explain` finds in the flights, or why it finds nothing.
    pub(super) fn of_found(
        flights: Vec<Signals>,
        inputs: Vec<InputFile>,
        mut vehicle: Vehicle,
        settings: &IdentifySettings,
        found: &Result<Found, String>,
    ) -> Result<Self, EstimateError> {
        let mut identification = identify(&flights, &vehicle, settings)?;
        let (mut effects, mut turned_by_control) = (Vec::new(), false);
        let (mut gyroscopic, mut torque_law, mut undetermined) = (None, None, Vec::new());
        let (mut about_z, mut about_z_kg_m2) = (None, None);
        match found.as_ref().map(|found| joint_estimate(found, &vehicle)) {
            Ok(found) => {
                identification.methods.push(found.best.result.clone());
                identification.best = found.best;
                (effects, turned_by_control) = (found.effects, found.turned_by_control);
                (gyroscopic, torque_law) = (found.gyroscopic, found.torque_law);
                undetermined = found.undetermined;
                (about_z, about_z_kg_m2) = (found.about_z, found.about_z_kg_m2);
                vehicle.propulsion.torque_per_thrust_m = found.torque_per_thrust_m;
                identification.notes.extend(torque_law.iter().map(TorqueLaw::note));
                identification.notes.extend(gyroscopic.iter().map(GyroscopicShare::note));
                identification.notes.extend(found.notes);
            }
            Err(why) => rigid_body_alone(&mut identification, &vehicle, why),
        }
        let disagree = tell_flights_apart(&mut identification, &effects);
        identification.best.result.emit();
        let scale = apply_anchor(&mut identification, &vehicle);
        let joint = |result: &&mut MethodResult| result.method == Method::Joint;
        let kept = |result: &mut MethodResult| {
            without_undetermined(result, &undetermined);
            about_z.iter().for_each(|kept| with_kept_about_z(result, kept));
        };
        identification.methods.iter_mut().filter(joint).for_each(kept);
        kept(&mut identification.best.result);
        if turned_by_control {
            identification.methods.iter_mut().filter(joint).for_each(without_inertia);
            without_inertia(&mut identification.best.result);
        }
        let contradictions = contradictions(&identification.best.result, &vehicle, scale.as_ref());
        identification.notes.extend(contradictions.iter().map(Contradiction::note));
        identification.notes.extend(rests_on_guessed_curve(&identification.best.result.estimated));
        Ok(Self {
            vehicle,
            flights,
            inputs,
            identification,
            beside: effects,
            gyroscopic,
            torque_law,
            about_z_kg_m2,
            scale,
            with: None,
            notes: Vec::new(),
            disagree,
        })
    }

    /// The same with the law of the rotors' torque that the model with the effects asked for shows.
    #[must_use]
    pub(super) fn with_law_of(mut self, law: Option<TorqueLaw>) -> Self {
        let of_search = self.torque_law.as_ref().map(TorqueLaw::note);
        self.identification.notes.retain(|note| of_search.as_ref() != Some(note));
        self.identification.notes.extend(law.iter().map(TorqueLaw::note));
        self.torque_law = law;
        self
    }

    /// The rigid body of the answer: with the effects where some were asked for, by the recommended method elsewhere.
    #[must_use]
    pub fn body(&self) -> &MethodResult {
        self.with.as_ref().map_or(&self.identification.best.result, |with| &with.joint.body)
    }

    /// How the errors of what was estimated go together.
    #[must_use]
    pub fn correlation(&self) -> Correlation {
        match &self.with {
            Some(with) => Correlation::of_fit(&with.joint.after),
            None => self.method_correlation(),
        }
    }

    /// The same of the rigid body alone by the recommended method.
    #[must_use]
    pub fn method_correlation(&self) -> Correlation {
        Correlation::of_method(&self.identification.best.result)
    }

    /// Why the answer is doubtful, clause by clause; none where nothing speaks against it.
    #[must_use]
    pub fn doubts(&self) -> Vec<String> {
        let scale = self.with.as_ref().map_or(self.scale.as_ref(), |with| with.joint.scale.as_ref());
        let contradictions = contradictions(self.body(), &self.vehicle, scale);
        let flights = self.flights.iter().map(|flight| &flight.quality);
        let mut doubts = doubts(&self.vehicle, flights, &contradictions);
        doubts.extend(self.disagree.then(|| TWO_VEHICLES.to_owned()));
        doubts
    }
}

/// Notes the flights whose mass or moments contradict those of the first one, with these effects in the model. Returns whether one may be of another
/// vehicle.
fn tell_flights_apart(identification: &mut Identification, effects: &[&'static str]) -> bool {
    let thrust_differs = effects.iter().any(|id| signature_of(id).is_some_and(Signature::alters_thrust));
    let apart = || identification.apart.iter().filter(|flight| !flight.is_about_z_alone());
    let disagree = apart().any(|flight| flight.is_other_vehicle(thrust_differs));
    let told: Vec<Note> = apart().map(|flight| flight.note(thrust_differs)).collect();
    identification.notes.extend(told);
    disagree
}
