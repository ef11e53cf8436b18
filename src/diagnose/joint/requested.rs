//! Requested effects: names, requirements on the recording, and the forms of each.

use super::error::JointError;
use crate::diagnose::recorded::{Need, Recorded};
use crate::diagnose::signature::{EffectTerm, LatencyKind, Signature};
use crate::diagnose::signatures::{ALL, signature_of};
use crate::physics::{ActiveEffect, Airframe};

/// Names of parameters that are always identified.
const ALWAYS: [&str; 3] = ["thrust_scale", "torque_scale", "inertia_products"];

/// The requested effects, each of them once.
#[derive(Debug, Clone)]
pub struct RequestedEffects {
    signatures: Vec<&'static Signature>,
}

impl RequestedEffects {
    /// The effects of the user's names.
    ///
    /// # Errors
    /// [`JointError`] for a name that is none, is there twice, or cannot be identified as parameters.
    pub fn of(names: &[String]) -> Result<Self, JointError> {
        let mut signatures: Vec<&'static Signature> = Vec::with_capacity(names.len());
        for name in names {
            let name = name.trim();
            if ALWAYS.contains(&name) {
                return Err(JointError::Always { id: name.to_owned() });
            }
            let signature = signature_of(name).ok_or_else(|| JointError::Unknown { id: name.to_owned() })?;
            if signatures.iter().any(|known| known.id() == signature.id()) {
                return Err(JointError::Twice { id: signature.id() });
            }
            if let Some(why) = signature.joint.irregular {
                return Err(JointError::Irregular { id: signature.id(), why });
            }
            signatures.push(signature);
        }
        if signatures.is_empty() {
            return Err(JointError::Unknown { id: String::new() });
        }
        Ok(Self { signatures })
    }

    /// The signatures in the requested order.
    #[must_use]
    pub fn signatures(&self) -> &[&'static Signature] {
        &self.signatures
    }

    /// Whether some of them act between command and rotor speed: commands must then be used, not measured speeds.
    #[must_use]
    pub fn need_commands(&self) -> bool {
        self.signatures.iter().any(|signature| signature.effect.is_before_speed())
    }

    /// Whether an effect was requested.
    #[must_use]
    pub fn has(&self, id: &str) -> bool {
        self.signatures.iter().any(|signature| signature.id() == id)
    }

    /// Whether a lag or a delay was requested.
    #[must_use]
    pub fn has_latency(&self, kind: LatencyKind) -> bool {
        self.signatures.iter().any(|signature| signature.role.latency == Some(kind))
    }

    /// Whether the thrust law's curvature is among them: it takes the place of a guessed one.
    pub(super) fn bend_thrust(&self) -> bool {
        self.signatures.iter().any(|signature| signature.role.bends_thrust.is_some())
    }

    /// Whether some of them rotate the inertial unit against the body.
    #[must_use]
    pub fn turns_inertial_unit(&self) -> bool {
        self.signatures.iter().any(|signature| signature.role.turns_inertial_unit)
    }

    /// Effects with columns of their own.
    pub(super) fn with_columns(&self) -> impl Iterator<Item = &'static Signature> + '_ {
        self.signatures.iter().copied().filter(|signature| signature.role.latency.is_none())
    }

    /// Checks that wind has an aerodynamic force through which it acts; `known` are the effects of the vehicle file.
    ///
    /// # Errors
    /// [`JointError::WindAlone`].
    pub fn check_wind(&self, known: &[ActiveEffect]) -> Result<(), JointError> {
        let known = known.iter().filter_map(|of| signature_of(of.effect().id()));
        let of_air = self.signatures.iter().copied().chain(known).any(|signature| signature.role.of_air);
        let wind = self.signatures.iter().find(|signature| signature.role.wind.is_some());
        wind.filter(|_| !of_air).map_or(Ok(()), |wind| Err(JointError::WindAlone { id: wind.id() }))
    }

    /// Checks the requirements on the flights and on the vehicle file.
    pub(super) fn check_flights(&self, recorded: &Recorded, airframe: &Airframe) -> Result<(), JointError> {
        let flights = recorded.flights;
        for signature in self.signatures.iter().copied() {
            let (id, effect) = (signature.id(), signature.effect);
            let lacks = |what: &'static str, why: &'static str| JointError::Stream { id, what, why };
            if let Some(what) = effect.missing(airframe) {
                return Err(crate::physics::PhysicsError::Missing { id, what }.into());
            }
            if effect.is_before_speed() && flights.iter().any(|trace| trace.measured_speeds) {
                return Err(lacks(
                    "actuator commands",
                    "it acts between the command and the rotor's speed, and only measured speeds are recorded",
                ));
            }
            match recorded.lacks(signature.needs) {
                Some((Need::OneFlight, ..)) => {
                    return Err(JointError::SeveralFlights { id, flights: flights.len() });
                }
                Some((_, what, why)) => return Err(lacks(what, why)),
                None => {}
            }
        }
        Ok(())
    }

    /// The forms of an effect: start values, and which of them are estimated.
    pub(super) fn forms(&self, signature: &'static Signature, recorded: &Recorded) -> Vec<EffectTerm> {
        match signature.joint.forms {
            Some(forms) => forms(recorded, &self.signatures),
            None => vec![signature.whole()],
        }
    }
}

/// All names, for messages.
pub(super) fn names() -> String {
    crate::physics::effects::ALL.iter().map(|effect| effect.id()).collect::<Vec<_>>().join(", ")
}

/// The names of the forces of the air, for messages.
pub(super) fn names_of_air() -> String {
    let of_air: Vec<&str> =
        ALL.iter().filter(|signature| signature.role.of_air).map(|signature| signature.id()).collect();
    match of_air.split_last() {
        Some((last, others)) if !others.is_empty() => format!("{} or {last}", others.join(", ")),
        _ => of_air.concat(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::effects::{ALL, LinearDrag};

    #[test]
    fn every_effect_is_taken_or_refused_with_a_reason() {
        for effect in ALL {
            match RequestedEffects::of(&[format!(" {} ", effect.id())]) {
                Ok(wanted) => assert!(wanted.has(effect.id()) && wanted.signatures().len() == 1),
                Err(error) => {
                    assert!(matches!(error, JointError::Irregular { id: "gust", .. }), "{error}");
                    assert_eq!(effect.id(), "gust");
                }
            }
        }
        assert!(RequestedEffects::of(&["motor_lag".to_owned()]).is_ok_and(|wanted| wanted.need_commands()));
        assert!(RequestedEffects::of(&["com_offset".to_owned()]).is_ok_and(|wanted| !wanted.need_commands()));
    }

    #[test]
    fn wind_that_the_files_drag_carries_is_not_alone() {
        let wind = RequestedEffects::of(&["steady_wind".to_owned()]);
        let drag = ActiveEffect::new(&LinearDrag, &[0.1, 0.1, 0.0]);
        let (wind, drag) = (wind.unwrap(), drag.unwrap());
        assert_eq!(wind.check_wind(&[]), Err(JointError::WindAlone { id: "steady_wind" }));
        assert_eq!(wind.check_wind(&[drag]), Ok(()));
    }
}
