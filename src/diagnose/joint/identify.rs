//! Rigid body and named effects in one fit.

use super::error::JointError;
use super::finding::{self, EffectFound};
use super::held::FittedForm;
use super::requested::RequestedEffects;
use super::result::{JointEstimate, Physical};
use super::scale::Kept;
use super::{choose, latency, swing};
use crate::diagnose::base::Base;
use crate::diagnose::evidence::{LEAST_FLIGHT_S, LEAST_ROWS, ROW_S};
use crate::diagnose::fit::{Fitted, Newton, fit};
use crate::diagnose::floors::add_slope;
use crate::diagnose::latency::{LatencyFinding, finding_of};
use crate::diagnose::latency_error::by_latency;
use crate::diagnose::left_over::add_left_over;
use crate::diagnose::physical::{WITHIN_ERROR, with_guesses};
use crate::diagnose::recorded::Recorded;
use crate::diagnose::torque_law::{ABOUT_Z, TorqueLaw, torque_law};
use crate::diagnose::trace::Trace;
use crate::estimate::{
    Estimated, Finding, Method, MethodResult, MovedByCurve, Nominal, THETA, identified_vehicle, is_physical,
    moved_by_guessed_curve, nearest_physical, rescaled, thrust_scale,
};
use crate::physics::{ActiveEffect, Airframe};
use crate::signals::Signals;
use crate::stats::normal_deviate;
use crate::text::significant;
use crate::vehicle::{Anchor, Vehicle};

/// Identifies the requested effects together with the rigid body. `known` are the effects of the vehicle file:
/// requested ones are estimated again, the others act as stated.
///
/// # Errors
/// [`JointError`] where the recordings or the vehicle's description lack what an effect needs.
pub fn identify_jointly(
    flights: &[Signals],
    (vehicle, known): (&Vehicle, &[ActiveEffect]),
    wanted: &RequestedEffects,
    half_width_s: f64,
) -> Result<JointEstimate, JointError> {
    let _stage = tracing::info_span!("identify_jointly", flights = flights.len()).entered();
    wanted.check_wind(known)?;
    let traces: Vec<Trace> =
        flights.iter().map(|signals| Trace::new(signals, vehicle, half_width_s)).collect::<Result<_, _>>()?;
    let airframe = Airframe::new(vehicle)?;
    let recorded = Recorded::new(vehicle, &traces);
    wanted.check_flights(&recorded, &airframe)?;
    let rows: usize = traces.iter().map(Trace::rows).sum();
    if rows < LEAST_ROWS {
        let (seconds, needed_s) = (rows as f64 * ROW_S, LEAST_FLIGHT_S);
        return Err(JointError::TooShort { seconds, needed_s });
    }
    let kept: Vec<&ActiveEffect> = known.iter().filter(|of| !wanted.has(of.effect().id())).collect();
    let of_file = Kept { vehicle, effects: &kept };
    let (rigid, plain, first) = of_file.fit_latency(&traces)?;
    let latency_named = wanted.signatures().iter().any(|signature| signature.role.latency.is_some());
    let before = if latency_named { fit(&traces, rigid, Newton::Held)? } else { plain.clone() };
    let (start, newton) = latency::held_as(wanted, &traces, (vehicle, known), first, plain.base.latency);
    let base = Base { latency: start, ..plain.base };
    let chosen = choose::choose(&traces, &base, wanted, &recorded)?;
    let (after, mut settled) = of_file.estimate_forms(&traces, base, &chosen, newton)?;
    let (mut after, split) = latency::split(&traces, after, wanted)?;
    swing::allow_for_noise(&traces, &mut after, &mut settled)?;
    let mut before = before;
    add_left_over(&mut before, &[]);
    add_left_over(&mut after, &[]);
    after.covariance += by_latency(&traces, &after, (first.told_std_s(), &[]))?;
    add_slope(&mut after);
    let laws = [&before, &after].map(|fitted| torque_law(&traces, fitted));
    let fits = Fits { before, after, settled, split, first, laws };
    let by_curve = moved_by_guessed_curve(flights, vehicle);
    let estimate = put_together(&traces, (vehicle, &kept), (wanted, by_curve), fits);
    estimate.effects.iter().for_each(EffectFound::emit);
    Ok(estimate)
}

/// Results of the fits.
struct Fits {
    before: Fitted,
    after: Fitted,
    settled: Vec<FittedForm>,
    split: latency::Split,
    first: LatencyFinding,
    /// of the rotors' torque, where it is certain that it is another than stated: of the rigid body alone, and with the effects
    laws: [Option<TorqueLaw>; 2],
}

fn put_together(
    traces: &[Trace],
    (vehicle, kept): (&Vehicle, &[&ActiveEffect]),
    (wanted, by_curve): (&RequestedEffects, Option<MovedByCurve>),
    fits: Fits,
) -> JointEstimate {
    let Fits { before, after, settled, split, first, laws: [law_before, torque_law] } = fits;
    let nominal = Nominal::of(vehicle);
    // a curve that the flight tells is no guess any more
    let left = by_curve.filter(|_| !wanted.bend_thrust());
    let (mut estimated, mut estimated_before) =
        (estimate_of(&after, left, torque_law), estimate_of(&before, by_curve, law_before));
    let as_flown = estimated.theta[ABOUT_Z];
    let physical = made_physical(&mut estimated, &nominal);
    let as_flown_share = as_flown / estimated.theta[ABOUT_Z];
    let result = |estimated: &Estimated| MethodResult::new(Method::Weak, estimated, &nominal);
    let (mut body, mut body_before) = (result(&estimated), result(&estimated_before));
    let mut scale = None;
    if vehicle.anchor == Anchor::Mass {
        scale = Some(thrust_scale(&body, vehicle));
        let weighed = vehicle.body.mass_kg;
        estimated = rescaled(&estimated, weighed);
        estimated_before = rescaled(&estimated_before, weighed);
        (body, body_before) = (result(&estimated), result(&estimated_before));
        body.parameters[0].finding = Finding::Given { value: weighed };
        body_before.parameters[0].finding = Finding::Given { value: weighed };
    }
    let latency = LatencyFinding {
        against_lag: first.against_lag,
        against_delay: first.against_delay,
        uneven_std: first.uneven_std,
        ..finding_of(&after)
    };
    let by_mass = scale.is_some().then(|| vehicle.body.mass_kg / after.base.vehicle.body.mass_kg);
    let effects = finding::effects((traces, vehicle), wanted, (&after, &settled), (&latency, split), by_mass);
    let mut acting: Vec<ActiveEffect> = kept.iter().map(|of| (*of).clone()).collect();
    acting.extend(effects.iter().filter_map(EffectFound::acting));
    let mut identified = identified_vehicle(vehicle, &body, scale.as_ref());
    identified.body.gyroscopic = after.base.vehicle.body.gyroscopic;
    if torque_law.is_some() && estimated.theta[ABOUT_Z].is_finite() {
        // what turns the vehicle about z with the stated torque per thrust, as the flight does
        let about_z = estimated.theta[ABOUT_Z];
        identified.body.inertia_kg_m2[(2, 2)] = about_z;
        if let Finding::NotDetermined { reason } = &mut body.parameters[ABOUT_Z].finding {
            reason.push_str(&told_about_z(about_z, as_flown_share, physical));
        }
    }
    JointEstimate {
        vehicle: identified,
        latency_named: wanted.signatures().iter().any(|signature| signature.role.latency.is_some()),
        before,
        after,
        body,
        body_before,
        scale,
        effects,
        acting,
        latency,
        physical,
        torque_law,
    }
}

/// Mass and inertia of a fit, with the errors of a guessed thrust curve and of a torque that does not go with the thrust.
fn estimate_of(fitted: &Fitted, by_curve: Option<MovedByCurve>, law: Option<TorqueLaw>) -> Estimated {
    let estimated = fitted.rigid_body();
    let moved = by_curve.map(|by| by.on(&estimated.theta));
    let estimated = estimated.with_guessed_curve(moved);
    match law {
        Some(law) => law.in_errors_of(estimated),
        None => estimated,
    }
}

/// What izz (kg m^2) the model has, of a flight that tells only its ratio to the torque per thrust: a clause. `as_flown` is that by the stated torque
/// per thrust over it.
fn told_about_z(about_z: f64, as_flown: f64, physical: Physical) -> String {
    let words = significant(about_z, 3);
    if physical == Physical::Moved {
        let flown = significant(as_flown * about_z, 3);
        format!(
            "; in the model izz is {words} kg m^2, the nearest that a body can have. With the stated torque per thrust the vehicle turned as with \
             {flown} kg m^2"
        )
    } else {
        format!(
            "; in the model izz is {words} kg m^2, which turns the vehicle as it flew with the stated torque per thrust"
        )
    }
}

/// Replaces a physically impossible inertia by the nearest possible one, if that lies within its error, that of what the description guesses
/// included.
fn made_physical(estimated: &mut Estimated, nominal: &Nominal) -> Physical {
    // an inertia that is not determined needs no repair
    if is_physical(&estimated.theta) || estimated.theta.iter().any(|value| value.is_nan()) {
        return Physical::AsEstimated;
    }
    let covariance = with_guesses(&estimated.covariance, &estimated.theta, nominal);
    let Some(theta) = nearest_physical(&estimated.theta, &covariance, &nominal.theta) else {
        return Physical::No;
    };
    let moved = theta - estimated.theta;
    let factor = covariance.cholesky();
    let wald = factor.map_or(f64::INFINITY, |factor| moved.dot(&factor.solve(&moved)));
    if normal_deviate(wald, THETA) > WITHIN_ERROR {
        return Physical::No;
    }
    estimated.theta = theta;
    Physical::Moved
}
