//! Named effects identified together with the rigid body.
//!
//! The base is the rigid body with the named effects present; Gauss-Newton on the weak-form rows fits mass,
//! inertia, latency, nuisances and every free parameter of the effects at once, and the standard errors are those of
//! the evidence. What is not smooth (which rotor, when, how long a cord, which law) is profiled: each form is fitted
//! and the likeliest is taken. A lag or delay is held as the kind that was named and goes through the latency.

mod choose;
mod finding;
mod held;
mod latency;
mod scale;
mod swing;
mod wanted;

pub use finding::{EffectFound, Found, ParameterFound};
pub use wanted::Wanted;

use super::base::Base;
use super::channels::CHANNELS;
use super::deviate::normal_deviate;
use super::evidence::LEAST_ROWS;
use super::fit::{Fitted, Newton, fit};
use super::latency::{LatencyFinding, finding_of};
use super::trace::{Trace, TraceError};
use crate::estimate::{
    Estimated, Finding, Method, MethodResult, THETA, Theta, ThetaCovariance, ThrustScale, identified_vehicle,
    is_physical, nearest_physical, rescaled, theta_of, thrust_scale,
};
use crate::physics::{ActiveEffect, Airframe, PhysicsError};
use crate::signals::Signals;
use crate::vehicle::{Anchor, Vehicle};
use held::Settled;
use scale::Kept;

/// Why effects cannot be identified.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TogetherError {
    /// no effect of this name
    #[error("no effect `{id}`; expected one or more of {}", wanted::names())]
    Unknown {
        /// what came
        id: String,
    },
    /// twice the same
    #[error("effect {id} is named twice; expected each name once")]
    Twice {
        /// which
        id: &'static str,
    },
    /// no effect beside the rigid body
    #[error(
        "{id} is identified with mass and inertia in any case; name the effects beside them: {}",
        wanted::names()
    )]
    Always {
        /// which
        id: String,
    },
    /// irregular by nature
    #[error(
        "gust cannot be identified as parameters: a gust is one course of the wind, not the same way twice, and force and torque \
         are not a function of its strength and correlation time; `mavid explain` gives both, from what is left of the residual"
    )]
    Gust,
    /// wind has no force of its own
    #[error(
        "steady_wind shows only through forces of the air; expected it together with linear_drag, quadratic_drag, blade_flapping, \
         translational_lift, inflow or vortex_ring, by name or in the vehicle file, got none of them"
    )]
    WindAlone,
    /// a stream is missing
    #[error("effect {id} needs {what}: {why}; the recording does not hold that")]
    Stream {
        /// which effect
        id: &'static str,
        /// what it needs
        what: &'static str,
        /// what for
        why: &'static str,
    },
    /// its time belongs to one flight
    #[error("effect {id} happens at a time of one flight; expected one recording, got {flights}")]
    SeveralFlights {
        /// which effect
        id: &'static str,
        /// how many came
        flights: usize,
    },
    /// too little flight
    #[error(
        "{seconds:.1} s of flight can be used, at least {needed_s:.0} s are needed to tell effects from noise"
    )]
    TooShort {
        /// s that can be used
        seconds: f64,
        /// s needed
        needed_s: f64,
    },
    /// streams are missing
    #[error(transparent)]
    Trace(#[from] TraceError),
    /// the vehicle is not physical, or lacks what an effect needs
    #[error(transparent)]
    Physics(#[from] PhysicsError),
}

/// An inertia that a body can have: no principal moment exceeds the sum of the others.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Physical {
    /// it is one
    AsEstimated,
    /// it was moved to the nearest that is, within its error
    Moved,
    /// it is not, by more than its error: left as estimated
    No,
}

/// Rigid body and effects, identified together.
#[derive(Debug, Clone)]
pub struct Together {
    /// the rigid body alone, on the same rows; where a lag or delay was named, without any latency
    pub before: Fitted,
    /// rigid body and effects; forces on the scale of the stated thrust
    pub after: Fitted,
    /// mass and inertia with the effects
    pub body: MethodResult,
    /// and without
    pub body_before: MethodResult,
    /// how much stronger the rotors are than stated, where the mass was weighed
    pub scale: Option<ThrustScale>,
    /// the vehicle with what was determined
    pub vehicle: Vehicle,
    /// in the order in which they were asked for
    pub effects: Vec<EffectFound>,
    /// for simulations: those, and what the vehicle's file had beside them
    pub acting: Vec<ActiveEffect>,
    /// between command and rotor
    pub latency: LatencyFinding,
    /// it is among the named effects
    pub latency_named: bool,
    /// whether the inertia is one that a body can have
    pub physical: Physical,
}

impl Together {
    /// Root mean square of what is left in each channel, before and with the effects, N and N m; `None` where
    /// the recording does not give the channel.
    #[must_use]
    pub fn misfit(&self) -> [Option<(f64, f64)>; CHANNELS] {
        let factor = self.factor();
        std::array::from_fn(|channel| {
            let of = |fitted: &Fitted| fitted.weighted.sigma[channel] * factor;
            (of(&self.after) > 0.0).then(|| (of(&self.before), of(&self.after)))
        })
    }

    /// What forces are multiplied by for the scale of a weighed mass.
    #[must_use]
    pub fn factor(&self) -> f64 {
        match self.scale.as_ref().map(|scale| &scale.factor) {
            Some(Finding::Determined { value, .. }) => *value,
            _ => 1.0,
        }
    }
}

/// Identifies the wanted effects together with the rigid body. `known` are effects that the vehicle's file has: what is
/// among the wanted is estimated anew, the others act as they are.
///
/// # Errors
/// [`TogetherError`] where the recordings or the vehicle's description lack what an effect needs.
pub fn together(
    flights: &[Signals],
    (vehicle, known): (&Vehicle, &[ActiveEffect]),
    wanted: &Wanted,
    half_width_s: f64,
) -> Result<Together, TogetherError> {
    wanted.check_wind(known)?;
    let traces: Vec<Trace> =
        flights.iter().map(|signals| Trace::new(signals, vehicle, half_width_s)).collect::<Result<_, _>>()?;
    let airframe = Airframe::new(vehicle)?;
    wanted.check_flights(&traces, &airframe)?;
    let rows: usize = traces.iter().map(Trace::rows).sum();
    if rows < LEAST_ROWS {
        let (seconds, needed_s) = (rows as f64 * 0.05, LEAST_ROWS as f64 * 0.05);
        return Err(TogetherError::TooShort { seconds, needed_s });
    }
    let kept: Vec<&ActiveEffect> = known.iter().filter(|of| !wanted.has(of.effect().id())).collect();
    let of_file = Kept { vehicle, effects: &kept };
    let (rigid, plain, first) = of_file.fit_latency(&traces)?;
    let latency_named = wanted.effects().iter().any(|effect| wanted::is_latency(effect.id()));
    let before = if latency_named { fit(&traces, rigid, Newton::Held)? } else { plain.clone() };
    let (start, newton) = latency::held_as(wanted, &traces, (vehicle, known), first, plain.base.latency);
    let base = Base { latency: start, ..plain.base };
    let chosen = choose::choose(&traces, &base, wanted, &airframe)?;
    let (after, mut settled) = of_file.settle(&traces, base, &chosen, newton)?;
    let (mut after, split) = latency::split(&traces, after, wanted)?;
    swing::allow_for_noise(&traces, &mut after, &mut settled)?;
    Ok(put_together(&traces, (vehicle, &kept), wanted, Fits { before, after, settled, split, first }))
}

/// What the fits gave.
struct Fits {
    before: Fitted,
    after: Fitted,
    settled: Vec<Settled>,
    split: latency::Split,
    first: LatencyFinding,
}

fn put_together(
    traces: &[Trace],
    (vehicle, kept): (&Vehicle, &[&ActiveEffect]),
    wanted: &Wanted,
    fits: Fits,
) -> Together {
    let Fits { before, after, settled, split, first } = fits;
    let nominal = theta_of(&vehicle.body);
    let (mut estimated, mut estimated_before) = (estimated(&after), estimated(&before));
    let physical = made_physical(&mut estimated, &nominal);
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
    Together {
        vehicle: identified_vehicle(vehicle, &body, scale.as_ref()),
        latency_named: wanted.effects().iter().any(|effect| wanted::is_latency(effect.id())),
        before,
        after,
        body,
        body_before,
        scale,
        effects,
        acting,
        latency,
        physical,
    }
}

/// Moves an inertia that no body has to the nearest that is one, if that lies within its error.
fn made_physical(estimated: &mut Estimated, nominal: &Theta) -> Physical {
    if is_physical(&estimated.theta) {
        return Physical::AsEstimated;
    }
    let Some(theta) = nearest_physical(&estimated.theta, &estimated.covariance, nominal) else {
        return Physical::No;
    };
    let moved = theta - estimated.theta;
    let factor = estimated.covariance.cholesky();
    let wald = factor.map_or(f64::INFINITY, |factor| moved.dot(&factor.solve(&moved)));
    if normal_deviate(wald, THETA) > WITHIN_ERROR {
        return Physical::No;
    }
    estimated.theta = theta;
    Physical::Moved
}

/// Standard errors by which an inertia may be moved.
const WITHIN_ERROR: f64 = 3.0;

/// Mass and inertia of a fit: the first columns of its nuisances, in the same order.
fn estimated(fitted: &Fitted) -> Estimated {
    let covariance = ThetaCovariance::from_fn(|i, j| fitted.covariance[(i, j)]);
    debug_assert!(fitted.covariance.nrows() >= THETA);
    Estimated { theta: theta_of(&fitted.base.vehicle.body), covariance, explained: None }
}
