//! Why an explanation is doubtful.

use super::body::BodyParameter;
use super::limited::FlightLimit;
use super::result::ExplainStudy;
use super::short::Short;
use crate::diagnose::locate::{Quantity, Redness};
use crate::diagnose::signature::Signature;
use crate::diagnose::signatures::signature_of;
use crate::diagnose::{CONTRADICTED, Fitted, Named, STATED_MASS, Verdict, stated_mass_differs};
use crate::estimate::{Contradiction, Finding, FlightApart, MOMENTS, NAMES, ThrustScale, stated};
use crate::note::{About, Note};
use crate::study::doubts::{Moment, TWO_VEHICLES, doubts, of_mass, of_shape, of_thrust};
use crate::text::significant;
use crate::vehicle::{Guessed, Vehicle};

/// Share of the weight from which on what is left is not called noise. Set by judgement: simulated flights as noisy as real ones leave 5 %.
const MUCH_LEFT: f64 = 0.15;
/// Share from which on nothing that the model says holds. Set by judgement: of 66 explanations of real and simulated flights 64 leave 28 %
/// at most, and two of one vehicle, one of them of a log that is cut off, 83 and 104 %.
const MOST_LEFT: f64 = 0.5;

impl ExplainStudy {
    /// Mass, thrust and moments of inertia that are far from what the vehicle file states.
    pub(super) fn contradictions(&self) -> Vec<Contradiction> {
        let vehicle = &self.given.vehicle;
        let guess = vehicle.guessed(Guessed::ThrustMax);
        let of_thrust = |ThrustScale { name, factor, .. }: ThrustScale| match factor {
            Finding::Determined { value, std } => Contradiction::of(name, (value, std), (1.0, guess)),
            _ => None,
        };
        let of_body = |(index, of): (usize, BodyParameter)| {
            let moment = matches!(index, 0 | 1 | 4 | 6) && !of.weighed && of.not_determined.is_none();
            // the guess of the thrust is the mass's own
            let std = if index == 0 { of.after.own_std() } else { of.after.std };
            let estimate = (of.after.value, std);
            moment.then(|| Contradiction::of(NAMES[index], estimate, stated(vehicle, index)))?
        };
        let body = self.body().into_iter().enumerate().filter_map(of_body);
        self.scale().and_then(of_thrust).into_iter().chain(body).collect()
    }

    /// A note on a mass, or of a weighed vehicle on a thrust, that differs from the vehicle file's by more than files do, and on what hangs on
    /// it. Further apart it is a contradiction.
    pub(super) fn tell_mass(&mut self) {
        let body = self.body();
        let Some(mass) = body.first() else { return };
        let told = self.contradictions().iter().any(|of| of.name == mass.name);
        if !mass.weighed && !told && mass.not_determined.is_none() {
            self.notes.extend(of_mass((mass.after.value, mass.after.std), mass.nominal));
        }
        let scale =
            self.scale().filter(|scale| !self.contradictions().iter().any(|of| of.name == scale.name));
        if let Some(ThrustScale { name, factor: Finding::Determined { value, std }, .. }) = scale {
            self.notes.extend(of_thrust(name, (value, std)));
        }
    }

    /// Whether an effect is named that alters the thrust of a command: the masses and moments of inertia of single flights by the
    /// rigid body alone then contain it.
    fn names_thrust(&self) -> bool {
        self.effects.iter().any(|named| signature_of(named.id).is_some_and(Signature::alters_thrust))
    }

    /// Words for the flights that were explained.
    #[must_use]
    pub fn these_flights(&self) -> &'static str {
        if self.given.inputs.len() > 1 { "these flights" } else { "this flight" }
    }

    /// Notes on flights that the rigid body alone tells from the first one.
    pub(super) fn tell_flights_apart(&mut self) {
        let along = self.along.as_ref();
        let alike = |flight: usize| along.is_some_and(|along| along.has_inertia_of_first(flight));
        self.given.contradicting.retain(|apart| !(apart.is_by_moments() && alike(apart.flight)));
        let thrust_differs = self.names_thrust();
        let apart = self.given.contradicting.iter().map(|flight| flight.note(thrust_differs));
        self.notes.extend(apart);
    }

    /// A remark on forces and torques that wander by themselves.
    pub(super) fn tell_wandering(&mut self) {
        let aperiodic = &self.explanation.aperiodic;
        let mut told: Vec<String> = aperiodic.wandering().map(Redness::words).collect();
        told.extend(aperiodic.drifting().map(|trend| {
            let what = match trend.of {
                Quantity::Lift => "a thrust that becomes less by",
                _ => "a horizontal force that changes by",
            };
            format!("{what} {:.1} % of the weight over the flight", 100.0 * trend.relative)
        }));
        if !told.is_empty() {
            let text = format!(
                "something is left that does not repeat: {}. Wind, a battery that empties and real rotors make as much, so it does not \
                 count as missing",
                told.join(", ")
            );
            self.notes.push(Note::remark(About::Estimate, text));
        }
    }

    /// Force that the model leaves, N rms over all axes and as a share of the weight, where that is much.
    #[must_use]
    pub fn much_left(&self) -> Option<(f64, f64)> {
        let forces = self.residual().into_iter().filter(|of| of.unit == "N");
        let left = forces.map(|of| of.after.powi(2)).sum::<f64>().sqrt();
        let share = left / (self.vehicle().body.mass_kg * self.vehicle().gravity_m_s2);
        (share > MUCH_LEFT).then_some((left, share))
    }

    /// A note on a moment of inertia about z that is smaller than one across.
    pub(super) fn tell_shape(&mut self) {
        // the model then keeps the stated izz
        if self.explanation.torque_law.is_some() {
            return;
        }
        let body = self.body();
        let guess = self.given.vehicle.guessed(Guessed::Inertia);
        // what is not determined is as uncertain as its guess
        let moment = |index: usize| {
            let of = body.get(index)?;
            let is_determined = of.not_determined.is_none();
            let std = if is_determined { of.after.std } else { guess * of.after.value };
            Some(Moment { value: of.after.value, std, is_determined })
        };
        let [about_x, about_y, about_z] = MOMENTS.map(moment);
        let all = about_x.zip(about_y).zip(about_z);
        self.notes.extend(all.and_then(|((xx, yy), zz)| of_shape([xx, yy], zz)));
    }

    /// Why the answer is doubtful, clause by clause; none where nothing speaks against it.
    #[must_use]
    pub fn doubts(&self) -> Vec<String> {
        let mut doubts = doubts(&self.given.vehicle, &self.given.quality, &self.contradictions());
        let thrust_differs = self.names_thrust();
        let other = |flight: &FlightApart| flight.is_other_vehicle(thrust_differs);
        if self.differing.is_some() || self.given.contradicting.iter().any(other) {
            doubts.push(TWO_VEHICLES.to_owned());
        }
        doubts.extend(self.short.iter().map(Short::doubt));
        doubts.extend(self.much_left().filter(|(_, share)| *share > MOST_LEFT).map(|(_, share)| {
            format!(
                "the model leaves forces of {:.0} % of the weight, as strong vibration, a damaged log, wrong units or another vehicle's file do",
                100.0 * share
            )
        }));
        doubts
    }

    /// Whether something speaks against names and sizes.
    #[must_use]
    pub fn is_doubtful(&self) -> bool {
        !self.doubts().is_empty() && !self.doubts_torques_alone()
    }

    /// Only moments of inertia are doubtful, against a rule of thumb, and every named effect is a force: its size does not rest on
    /// them, because the mass sets the scale of forces.
    #[must_use]
    pub fn doubts_torques_alone(&self) -> bool {
        let all = self.contradictions();
        let is_force = |effect: &Named| {
            let mut units =
                effect.parameters.iter().map(|parameter| parameter.unit).filter(|unit| *unit != "-");
            units.clone().next().is_some() && units.all(|unit| unit.starts_with("N/"))
        };
        !all.is_empty()
            && all.iter().all(|of| of.guessed && of.name.starts_with('i'))
            && self.doubts().len() == 1
            && !self.effects.is_empty()
            && self.effects.iter().all(is_force)
    }

    /// Why the flights that were explained tell little; none where they tell what flights tell.
    #[must_use]
    pub fn limited(&self) -> Vec<FlightLimit> {
        let hardly_moves = self.explanation.too_little_excitation;
        if hardly_moves && self.verdict() == Verdict::NothingMissing {
            // that is the answer itself
            return Vec::new();
        }
        let is_hover = self.given.limited.contains(&FlightLimit::Hover);
        let why = if self.given.has_velocity { FlightLimit::LittleMotion } else { FlightLimit::NoVelocity };
        let more = (hardly_moves && !is_hover).then_some(why);
        // that a flight is short as a whole is said as a doubt
        let is_told =
            |limit: &FlightLimit| self.short.is_some() && matches!(limit, FlightLimit::FewPeriods { .. });
        self.given.limited.iter().copied().filter(|limit| !is_told(limit)).chain(more).collect()
    }
}

/// The voltage at which the stated thrust is taken to hold, where the thrust falls with the battery.
pub(in crate::study) fn of_voltage(named: &Named) -> Option<Note> {
    let full_v = named.get("full_voltage")?.value;
    let text = format!(
        "the thrust falls with the battery. The mass rests on the stated thrust at {} V, the highest voltage that was used. If the stated thrust \
         is that of another voltage, the mass is wrong by the same factor as the thrust",
        significant(full_v, 3)
    );
    Some(Note::remark(About::Estimate, text))
}

/// What the mass and all forces rest on, where the model has a bent thrust curve and nothing was weighed.
pub(super) fn of_bent_scale(fitted: &Fitted, stated: &Vehicle) -> Option<Note> {
    let stated_kg = stated.body.mass_kg;
    if fitted.base.stated_mass_differs.is_some() {
        let text = format!(
            "the thrust curve is bent, so the stated thrust tells less about the thrust at hover. The mass, the moments of inertia and all forces \
             rest on the stated mass as well, {} kg (+- {:.0} %). The error of this scale is in all of their errors. If the vehicle was weighed as \
             it flew, write anchor = \"mass\" under [identify] into the vehicle file",
            significant(stated_kg, 3),
            100.0 * STATED_MASS
        );
        return Some(Note::remark(About::Estimate, text));
    }
    let differs = stated_mass_differs(&fitted.base, stated)?.abs();
    let text = format!(
        "the stated mass, {} kg, and the mass by the stated thrust, {} kg, differ by {differs:.1} standard errors, although the thrust curve is bent: \
         one of both is of another vehicle, or the vehicle carried a load. All forces rest on the stated thrust. Weigh the vehicle as it flew, and \
         write its mass and anchor = \"mass\" under [identify] into the vehicle file",
        significant(stated_kg, 3),
        significant(fitted.base.vehicle.body.mass_kg, 3)
    );
    (differs > CONTRADICTED).then(|| Note::warning(About::Contradiction, text))
}
