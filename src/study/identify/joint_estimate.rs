//! Mass and inertia by the estimator of `explain`, together with the effects that the flights show.

use crate::diagnose::{
    ExplainError, ExplainSettings, Explanation, GyroscopicShare, TorqueLaw, Verdict, brief, explain,
};
use crate::estimate::{
    Estimated, Finding, MethodResult, Nominal, Recommendation, THETA, moved_by_guessed_curve,
};
use crate::signals::Signals;
use crate::study::explain::BY_CONTROL;
use crate::vehicle::Vehicle;

/// The recommended estimate, and what was estimated beside mass and inertia.
#[derive(Debug)]
pub(super) struct EstimateWithEffects {
    pub(super) best: Recommendation,
    /// identifiers of effects
    pub(super) effects: Vec<&'static str>,
    /// hardly anything but the controller turned the vehicle
    pub(super) turned_by_control: bool,
    /// where a simulator leaves the gyroscopic torque out
    pub(super) gyroscopic: Option<GyroscopicShare>,
    /// where the rotors' torque certainly does not go with their thrust
    pub(super) torque_law: Option<TorqueLaw>,
}

/// Takes the moments of inertia out of a result that rests on the controller's answer to noise.
pub(super) fn without_inertia(result: &mut MethodResult) {
    for index in 1..THETA {
        result.parameters[index].finding = Finding::NotDetermined { reason: BY_CONTROL.to_owned() };
    }
}

/// Searches the flights for effects and takes mass and inertia from the final fit. `alone` is the estimate of the rigid body alone,
/// with what a wider window says of it.
///
/// # Errors
/// [`ExplainError`] where the flights are too short, or lack what a search needs.
pub(super) fn joint_estimate(
    flights: &[Signals],
    vehicle: &Vehicle,
    alone: &Estimated,
) -> Result<EstimateWithEffects, ExplainError> {
    let found = explain(flights, vehicle, &ExplainSettings::default())?;
    let unexplained = found.verdict == Verdict::Unexplained;
    // what serves as no explanation is not in the model
    let fitted = if unexplained { &found.search.before } else { &found.search.after };
    let mut estimated = fitted.with_stated_thrust(&vehicle.propulsion);
    estimated.by_wider_window = alone.by_wider_window;
    if !fitted.base.estimates_bend() {
        let moved = moved_by_guessed_curve(flights, vehicle).map(|by| by.on(&estimated.theta));
        estimated = estimated.with_guessed_curve(moved);
    }
    if let Some(law) = found.torque_law {
        estimated = law.in_errors_of(estimated);
    }
    let effects: Vec<&'static str> = found.named.iter().map(|named| named.id).collect();
    let best = Recommendation::joint(&estimated, &Nominal::of(vehicle), why(&found, vehicle));
    let (turned_by_control, torque_law) = (found.turned_by_control, found.torque_law);
    Ok(EstimateWithEffects { best, effects, turned_by_control, gyroscopic: fitted.gyroscopic(), torque_law })
}

/// The reason for the user.
fn why(found: &Explanation, vehicle: &Vehicle) -> String {
    let names: Vec<String> = found.named.iter().map(|named| brief(named, vehicle, false)).collect();
    match (found.verdict, names.join(", ")) {
        (Verdict::Unexplained, _) => {
            "mass and inertia alone: something acts in these flights that no known effect explains, and `mavid explain` \
             shows where"
                .to_owned()
        }
        (_, names) if names.is_empty() => "these flights show no effect beside mass and inertia".to_owned(),
        (_, names) => format!(
            "mass and inertia are estimated together with the other effects in these flights: {names} (`mavid explain` gives \
             their sizes)"
        ),
    }
}
