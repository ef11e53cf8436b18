//! Mass and inertia of an answer.

use super::not_determined::{BY_CONTROL, KEPT, kept_about_z, no_body};
use super::result::ExplainStudy;
use crate::diagnose::Fitted;
use crate::estimate::{
    Estimated, Finding, NAMES, Nominal, THETA, ThrustScale, UNITS, finding, rescaled, scaling_mass, theta_of,
};
use crate::vehicle::Guessed;

/// A parameter with its standard error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// in the parameter's unit
    pub value: f64,
    /// standard error; NaN where there is none
    pub std: f64,
    /// the part of it that guesses of the vehicle's description make, which is common to all estimates of these flights
    pub of_guesses: f64,
}

impl Estimate {
    /// Standard error without the part of guesses.
    #[must_use]
    pub fn own_std(&self) -> f64 {
        (self.std.powi(2) - self.of_guesses.powi(2)).max(0.0).sqrt()
    }
}

/// Mass or an entry of the inertia.
#[derive(Debug, Clone, PartialEq)]
pub struct BodyParameter {
    /// as in JSON
    pub name: &'static str,
    /// SI
    pub unit: &'static str,
    /// as the vehicle file states it
    pub nominal: f64,
    /// of the rigid body alone
    pub before: Estimate,
    /// why that is no estimate
    pub before_not_determined: Option<String>,
    /// of the final model
    pub after: Estimate,
    /// known beforehand: the vehicle was weighed
    pub weighed: bool,
    /// why the final value is no estimate: these flights do not determine it, and the model keeps a value for
    /// simulations
    pub not_determined: Option<String>,
}

/// Place of izz in mass and inertia.
const ABOUT_Z: usize = 6;

impl ExplainStudy {
    /// Mass and inertia, nominal, alone and with the effects.
    #[must_use]
    pub fn body(&self) -> Vec<BodyParameter> {
        let search = &self.explanation.search;
        let alone = &search.before;
        let (before, after) = (self.estimates(alone), self.estimates(self.fitted()));
        let open = [alone, self.fitted()].map(|fitted| self.open_in(fitted));
        let nominal = Nominal::of(&self.given.vehicle);
        (0..NAMES.len())
            .map(|index| BodyParameter {
                name: NAMES[index],
                unit: UNITS[index],
                nominal: nominal.theta[index],
                before: before[index],
                before_not_determined: open[0][index].clone(),
                after: after[index],
                weighed: index == 0 && self.fitted().base.weighed_kg.is_some(),
                not_determined: open[1][index].clone(),
            })
            .collect()
    }

    /// Why a fit does not determine mass and entries of the inertia, in their order; `None` where it does.
    fn open_in(&self, fitted: &Fitted) -> [Option<String>; THETA] {
        let nominal = Nominal::of(&self.given.vehicle);
        let estimated = self.on_scale(fitted).with_wider_window(self.explanation.search.by_wider_window);
        let is_kept = |index: usize| index == ABOUT_Z && self.explanation.torque_law.is_some();
        std::array::from_fn(|index| match finding(&estimated, &nominal, index) {
            _ if index > 0 && self.explanation.turned_by_control => Some(BY_CONTROL.to_owned()),
            _ if index > 0 && fitted.beyond_bodies.is_some() => fitted.beyond_bodies.map(no_body),
            Finding::NotDetermined { reason } if is_kept(index) => {
                Some(format!("{reason}; {}", kept_about_z(&fitted.base.vehicle, &self.given.vehicle)))
            }
            Finding::NotDetermined { reason } if index > 0 || fitted.base.weighed_kg.is_none() => {
                Some(reason)
            }
            _ if fitted.undetermined.contains(&index) => Some(KEPT.to_owned()),
            _ => None,
        })
    }

    /// The rotors' thrust against the vehicle file's, where the mass was weighed.
    #[must_use]
    pub fn scale(&self) -> Option<ThrustScale> {
        let fitted = self.fitted();
        let weighed_kg = fitted.base.weighed_kg?;
        // with the stated thrust the flight would show this mass
        let stated = &self.given.vehicle.propulsion;
        let estimated = fitted.with_stated_thrust(stated);
        let mass = scaling_mass(&self.guessing(estimated, fitted), &Nominal::of(&self.given.vehicle));
        Some(ThrustScale::of(mass, weighed_kg, stated))
    }

    /// Relative standard error of the stated thrust (-) that is in those of masses and forces, where it alone sets their scale: that of a guess, and
    /// that of a bent thrust curve.
    #[must_use]
    pub fn std_of_stated_thrust(&self) -> Option<f64> {
        let base = &self.fitted().base;
        let alone = base.weighed_kg.is_none() && base.stated_mass_differs.is_none();
        alone.then(|| self.given.vehicle.guessed(Guessed::ThrustMax).hypot(self.fitted().std_of_scale()))
    }

    /// Mass and inertia of a fit, with the covariance that a weighed mass leaves.
    fn on_scale(&self, fitted: &Fitted) -> Estimated {
        let estimated = self.guessing(fitted.rigid_body(), fitted);
        fitted.base.weighed_kg.map_or(estimated.clone(), |weighed_kg| rescaled(&estimated, weighed_kg))
    }

    /// An estimate with what a guessed thrust curve does to it, unless the fit has a curve of its own.
    fn guessing(&self, estimated: Estimated, fitted: &Fitted) -> Estimated {
        let told = fitted.base.estimates_bend();
        let moved = self.given.by_guessed_curve.filter(|_| !told).map(|by| by.on(&estimated.theta));
        let estimated = estimated.with_guessed_curve(moved);
        self.explanation.torque_law.iter().fold(estimated, |estimated, law| law.in_errors_of(estimated))
    }

    /// Mass and inertia of a fit with their standard errors.
    fn estimates(&self, fitted: &Fitted) -> [Estimate; THETA] {
        let (values, of) = (theta_of(&fitted.base.vehicle.body), self.on_scale(fitted));
        let nominal = Nominal::of(&self.given.vehicle);
        std::array::from_fn(|index| {
            let of_guesses = (nominal.guessed(index) * values[index]).hypot(of.moved_by_curve(index));
            let std = of.covariance[(index, index)].max(0.0).sqrt().hypot(of_guesses);
            Estimate { value: values[index], std, of_guesses }
        })
    }

    /// Reasons why mass or entries of the inertia are not determined, each with the names that it holds for.
    #[must_use]
    pub fn body_not_determined(&self) -> Vec<(String, Vec<&'static str>)> {
        let mut reasons: Vec<(String, Vec<&'static str>)> = Vec::new();
        for BodyParameter { name, not_determined, .. } in self.body() {
            let Some(reason) = not_determined else { continue };
            match reasons.iter_mut().find(|(of, _)| *of == reason) {
                Some((_, names)) => names.push(name),
                None => reasons.push((reason, vec![name])),
            }
        }
        reasons
    }
}
