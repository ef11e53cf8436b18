//! The scale of an estimate: a flight determines only force per mass.

use super::identify::Identification;
use super::nominal::Nominal;
use super::result::{Estimated, Finding, MethodResult, finding};
use super::theta::{THETA, Theta, ThetaCovariance, theta_of};
use super::thrust_scale::ThrustScale;
use crate::vehicle::{Anchor, Guessed, Vehicle};
use nalgebra::SMatrix;

/// Brings every method's result to the scale of the vehicle's anchor.
///
/// [`Anchor::Thrust`] changes nothing. With [`Anchor::Mass`] the estimates, made with the stated thrust, are multiplied
/// by `m_weighed / m_estimated`: the mass is the weighed one, and the thrust coefficient is identified. The scale of
/// Izz is only as good as the stated torque per thrust.
pub fn apply_anchor(identification: &mut Identification, vehicle: &Vehicle) -> Option<ThrustScale> {
    if vehicle.anchor == Anchor::Thrust {
        return None;
    }
    let weighed = vehicle.body.mass_kg;
    let nominal = Nominal::of(vehicle);
    let scale = thrust_scale(&identification.best.result, vehicle);
    if let Finding::Determined { value: factor, .. } = scale.factor {
        identification.trim_torque_nm.iter_mut().for_each(|torque| *torque *= factor);
        identification.residual.iter_mut().for_each(|residual| *residual *= factor);
    }
    for result in identification.methods.iter_mut().chain([&mut identification.best.result]) {
        // the curve's scale goes out with the mass, and its slope stays
        let flown = finding(&result.estimated.clone().with_guessed_curve(None), &nominal, 0);
        if matches!(flown, Finding::Determined { .. }) {
            *result = MethodResult::new(result.method, &rescaled(&result.estimated, weighed), &nominal);
        } else {
            for index in 1..THETA {
                result.parameters[index].finding = Finding::NotDetermined {
                    reason: "the thrust scale is not determined: no vertical motion".into(),
                };
            }
        }
        result.parameters[0].finding = Finding::Given { value: weighed };
    }
    for (_, history) in &mut identification.histories {
        for theta in &mut history.theta {
            *theta *= weighed / theta[0];
        }
    }
    Some(scale)
}

/// Estimate on the scale of a weighed mass: `Theta' = Theta m_w / m`, with its covariance by the chain rule.
#[must_use]
pub fn rescaled(estimated: &Estimated, weighed_kg: f64) -> Estimated {
    let factor = weighed_kg / estimated.theta[0];
    let theta: Theta = estimated.theta * factor;
    let mut jacobian = SMatrix::<f64, THETA, THETA>::identity() * factor;
    for row in 0..THETA {
        jacobian[(row, 0)] -= theta[row] / estimated.theta[0];
    }
    let covariance: ThetaCovariance = jacobian * estimated.covariance * jacobian.transpose();
    let by_guessed_curve = estimated.by_guessed_curve.map(|moved| jacobian * moved);
    Estimated { theta, covariance, by_guessed_curve, ..estimated.clone() }
}

/// The mass that a flight shows with the stated thrust, whose factor it is. A guessed curve adds to its error, and never hides
/// it: inertia has its scale from it.
#[must_use]
pub fn scaling_mass(estimated: &Estimated, nominal: &Nominal) -> Finding {
    match finding(&estimated.clone().with_guessed_curve(None), nominal, 0) {
        Finding::Determined { value, std } => {
            Finding::Determined { value, std: std.hypot(estimated.moved_by_curve(0)) }
        }
        other => other,
    }
}

/// Factor of the rotors' thrust over the stated one, with the vehicle's weighed mass.
#[must_use]
pub fn thrust_scale(best: &MethodResult, vehicle: &Vehicle) -> ThrustScale {
    let mass = scaling_mass(&best.estimated, &Nominal::of(vehicle));
    ThrustScale::of(mass, vehicle.body.mass_kg, &vehicle.propulsion)
}

/// The vehicle with the determined parameters; others keep their nominal values.
#[must_use]
pub fn identified_vehicle(vehicle: &Vehicle, best: &MethodResult, scale: Option<&ThrustScale>) -> Vehicle {
    let mut theta = theta_of(&vehicle.body);
    for (index, parameter) in best.parameters.iter().enumerate() {
        match parameter.finding {
            Finding::Determined { .. } => theta[index] = best.estimated.theta[index],
            Finding::Given { value } => theta[index] = value,
            Finding::NotDetermined { .. } => {}
        }
    }
    let mut out = vehicle.clone();
    out.body.mass_kg = theta[0];
    out.body.inertia_kg_m2 = super::inertia_of(&theta);
    if let Some(Finding::Determined { value: factor, .. }) = scale.map(|scale| &scale.factor) {
        out.propulsion = out.propulsion.scaled(*factor);
        out.guesses.retain(|guess| guess.of != Guessed::ThrustMax);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::SVector;

    #[test]
    fn rescaling_keeps_ratios_and_moves_the_mass_error_into_the_inertia() {
        let theta = SVector::from([2.0, 0.02, 0.0, 0.0, 0.03, 0.0, 0.05]);
        let mut covariance = ThetaCovariance::zeros();
        covariance[(0, 0)] = 0.02_f64.powi(2); // 1 % of the mass
        let out = rescaled(
            &Estimated {
                theta,
                covariance,
                explained: None,
                by_wider_window: None,
                by_guessed_curve: None,
                torque_exponent: None,
            },
            2.2,
        );
        assert!((out.theta[0] - 2.2).abs() < 1e-12);
        assert!((out.theta[1] - 0.022).abs() < 1e-12);
        assert!(out.covariance[(0, 0)].abs() < 1e-15); // weighed: no error left
        assert!((out.covariance[(1, 1)].sqrt() / 0.022 - 0.01).abs() < 1e-9);
    }
}
