//! The scale of force where the stated thrust curve does not hold.
//!
//! A flight tells ratios of forces to the mass. The stated thrust sets their scale; where its curve is bent, it says less of the thrust at
//! hover, and the stated mass sets the scale as well.

use super::base::{Base, follows_force};
use super::channels::Nuisance;
use super::fit::Fitted;
use super::scale_error::{of_curve, share_of_mass, stated_mass_differs};
use super::trace::Trace;
use crate::physics::PhysicsError;
use crate::vehicle::Vehicle;

/// Standard errors by which the stated mass and the stated thrust may differ. Beyond, one of both is of another vehicle, and a mean of both is of
/// none.
pub const CONTRADICTED: f64 = 3.0;

/// Brings a model with a bent thrust curve to the scale that the stated mass and the stated thrust have together; ratios of forces and mass
/// stay. A vehicle that was weighed has its scale, a guessed thrust says no less for a bend, a load of one flight alone is known on the
/// scale of the stated thrust, and that scale stays where both contradict each other. `by_other_law` are variances of the effects' free values, which go with them.
///
/// # Errors
/// [`PhysicsError`] where the model is not physical.
pub(super) fn settle_scale(
    traces: &[Trace],
    stated: &Vehicle,
    (fitted, by_other_law): (&mut Fitted, &mut [f64]),
) -> Result<(), PhysicsError> {
    let base = &fitted.base;
    let is_loaded = traces.iter().any(|trace| trace.own.payload_kg != 0.0);
    let Some(differs) = stated_mass_differs(base, stated) else { return Ok(()) };
    if is_loaded || differs.abs() > CONTRADICTED {
        return Ok(());
    }
    let (by_curve, apart) = (of_curve(base), stated.body.mass_kg / base.vehicle.body.mass_kg);
    let mass_kg = base.vehicle.body.mass_kg * apart.powf(share_of_mass(by_curve));
    let mut settled = Base { stated_mass_differs: Some(differs), ..base.clone() };
    let factor = scale_to(&mut settled, mass_kg, fitted.rows.compares_torques);
    let mut after = fitted.moved_to(traces, settled)?;
    for column in following(fitted) {
        after.covariance.row_mut(column).scale_mut(factor);
        after.covariance.column_mut(column).scale_mut(factor);
        let effect = column.checked_sub(fitted.rows.nuisances.len());
        if let Some(variance) = effect.and_then(|effect| by_other_law.get_mut(effect)) {
            *variance *= factor.powi(2);
        }
    }
    tracing::info!(mass_kg, factor, "the thrust curve is bent: the stated mass sets the scale as well");
    *fitted = after;
    Ok(())
}

/// Brings a model back to the scale of the stated thrust alone. Flights that are explained each alone are compared there: each has its own mass,
/// and the stated one would hide by how much they differ.
pub(super) fn by_stated_thrust(base: &mut Base, stated: &Vehicle, compares_torques: bool) {
    if base.stated_mass_differs.is_some() {
        let factor = stated.propulsion.full_thrust_n() / base.vehicle.propulsion.full_thrust_n();
        scale_to(base, factor * base.vehicle.body.mass_kg, compares_torques);
        base.stated_mass_differs = None;
    }
}

/// Scales a model to a mass; ratios of forces and mass stay. Returns the factor.
fn scale_to(base: &mut Base, mass_kg: f64, compares_torques: bool) -> f64 {
    base.weighed_kg = Some(mass_kg);
    let factor = base.bring_to_scale(compares_torques);
    base.weighed_kg = None;
    factor
}

/// The columns whose parameters follow the scale of force.
fn following(fitted: &Fitted) -> Vec<usize> {
    let is_of_body = |nuisance: Nuisance| matches!(nuisance, Nuisance::Mass | Nuisance::Inertia(_));
    let nuisances = fitted.rows.nuisances.iter().map(|column| is_of_body(column.nuisance));
    let effects = fitted.base.effects.iter().flat_map(|term| {
        term.free.iter().map(|&slot| term.parameter(slot).is_some_and(|of| follows_force(of.unit)))
    });
    nuisances.chain(effects).enumerate().filter(|(_, follows)| *follows).map(|(column, _)| column).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test ends where it fails")]
    use super::*;
    use crate::diagnose::ExplainSettings;
    use crate::diagnose::fit::{Newton, fit};
    use crate::diagnose::latency::fit_latency;
    use crate::diagnose::made_flights::{conceal, flown};
    use crate::diagnose::scale_error::{STATED_MASS, of_scale};
    use crate::diagnose::signatures::signature_of;
    use crate::simulate::RandomTrajectory;

    /// A fit with a drag and a bend of this curvature, and what it was fitted to.
    fn fitted(curvature: f64) -> (Vec<Trace>, Vehicle, Fitted) {
        let (signals, vehicle) = flown(29, &RandomTrajectory::default(), |truth, weight_n| {
            let drag = [0.04 * weight_n; 2];
            conceal(truth, [("linear_drag", &drag as &[f64]), ("thrust_curve", &[curvature])]);
        });
        let traces = vec![Trace::new(&signals, &vehicle, ExplainSettings::default().half_width_s).unwrap()];
        let (before, _) = fit_latency(&traces, Base::anchored(&vehicle)).unwrap();
        let mut base = before.base;
        base.effects = ["linear_drag", "thrust_curve"].map(|id| signature_of(id).unwrap().whole()).to_vec();
        base.effects[0].free = vec![0, 1];
        base.effects[1].free = vec![0];
        let after = fit(&traces, base, Newton::Held).unwrap();
        (traces, vehicle, after)
    }

    fn near(found: f64, expected: f64) -> bool {
        (found / expected - 1.0).abs() < 1e-6
    }

    #[test]
    fn a_bent_curve_leaves_the_scale_to_the_stated_mass_as_well() {
        let (traces, mut stated, before) = fitted(0.25);
        // the file states a mass that is a fifth more than the stated thrust lifts
        stated.body.mass_kg = 1.2 * before.base.vehicle.body.mass_kg;
        let mut after = before.clone();
        settle_scale(&traces, &stated, (&mut after, &mut [])).unwrap();
        let factor = after.base.vehicle.body.mass_kg / before.base.vehicle.body.mass_kg;
        let by_curve = of_scale(&before.base);
        assert!(by_curve > 0.25, "{by_curve}");
        assert!(near(factor.ln() / 1.2_f64.ln(), share_of_mass(by_curve)));
        assert!(factor > 1.15 && of_scale(&after.base) < STATED_MASS);
        // ratios of forces and mass stay, and so does what is left
        for (of, settled) in before.base.effects.iter().zip(&after.base.effects) {
            let by = if of.id() == "linear_drag" { factor } else { 1.0 };
            assert!(near(settled.values[0], by * of.values[0]));
        }
        let [moment, settled] = [&before, &after].map(|of| of.base.vehicle.body.inertia_kg_m2[(0, 0)]);
        assert!(near(settled, factor * moment));
        let left = |of: &Fitted| of.rows.residual[0].iter().map(|left| left * left).sum::<f64>().sqrt();
        assert!(near(left(&after), factor * left(&before)));
        let columns = [0, after.rows.nuisances.len()];
        for column in columns {
            let ratio = after.covariance[(column, column)] / before.covariance[(column, column)];
            assert!(near(ratio, factor * factor));
        }
        let mut back = after.base.clone();
        by_stated_thrust(&mut back, &stated, true);
        let masses = [&back, &before.base].map(|of| of.vehicle.body.mass_kg);
        assert!(near(masses[0], masses[1]));
        assert!(near(of_scale(&back), by_curve));
    }

    #[test]
    fn a_mass_that_contradicts_the_stated_thrust_sets_no_scale() {
        let (traces, mut stated, before) = fitted(0.25);
        let by_curve = of_scale(&before.base);
        for (deviates, sets) in [(2.9, true), (3.1, false), (-2.9, true), (-3.1, false)] {
            let apart = f64::exp(deviates * by_curve.hypot(STATED_MASS));
            stated.body.mass_kg = apart * before.base.vehicle.body.mass_kg;
            let mut after = before.clone();
            settle_scale(&traces, &stated, (&mut after, &mut [])).unwrap();
            assert_eq!(after.base.stated_mass_differs.is_some(), sets, "{deviates}");
            // the error of their mean is as large as they differ
            let as_alike = by_curve * (1.0 - share_of_mass(by_curve)).sqrt();
            let expected = if sets { 2.9 * as_alike } else { by_curve };
            assert!(near(of_scale(&after.base), expected));
            assert_eq!(near(after.base.vehicle.body.mass_kg, before.base.vehicle.body.mass_kg), !sets);
        }
    }

    #[test]
    fn a_vehicle_that_was_weighed_and_a_curve_that_holds_keep_their_scale() {
        let (traces, stated, mut bent) = fitted(0.25);
        bent.base.weighed_kg = Some(bent.base.vehicle.body.mass_kg);
        let (_, _, mut straight) = fitted(0.0);
        straight.base.effects[1].values[0] = 0.0;
        for fitted in [bent, straight] {
            let mut after = fitted.clone();
            settle_scale(&traces, &stated, (&mut after, &mut [])).unwrap();
            assert!(near(after.base.vehicle.body.mass_kg, fitted.base.vehicle.body.mass_kg));
            assert!(after.base.stated_mass_differs.is_none() && of_scale(&after.base) == 0.0);
        }
    }
}
